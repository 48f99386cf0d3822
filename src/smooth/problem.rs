//! The mesh as the smoother sees it: its cells by number, their straight positions, what each costs.

use glam::DVec3;
use rayon::prelude::*;

use super::Settings;
use super::kernel::{Element, Kernel};
use super::survey::Scratch;
use super::view::View;
use crate::element::{Cell, Order};
use crate::mesh::{ElementId, Elements, Mesh, NodeId};
use crate::quality::{Cut, element_c_wcn};

/// By how much elements of a plane mesh are to be above the threshold: sweeps cost next to nothing there, and elements just above it hold
/// back those just below. NACA's reflex airfoil at P2 ended with C_JAC 0.797, and ends with 0.824; at P4 with C_WCN 0.845, and 0.890.
const ABOVE_IN_PLANE: f64 = 0.05;

/// The cells of an elevated mesh and their unperturbed positions.
pub struct Problem<'a> {
    pub(super) order: Order,
    cells: Elements<'a>,
    /// The unperturbed position of every node.
    pub(super) straight: &'a [DVec3],
    /// Number of cells around each node.
    valence: Vec<u32>,
    /// Where its cells are looked at from.
    pub(super) view: View,
}

/// The two components of an element's cost, equations (3) and (6): its worst sub-element and its worst survey point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementCost {
    /// Worst `C_WCN` of the sub-elements.
    pub c_wcn: f64,
    /// Mean `C_WCN` of the sub-elements.
    pub mean_c_wcn: f64,
    /// Worst `C_JAC` of the survey.
    pub c_jac: f64,
    /// How the element is best cut into sub-elements.
    pub cut: Cut,
}

impl ElementCost {
    /// The smaller component.
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.c_wcn.min(self.c_jac)
    }
}

impl<'a> Problem<'a> {
    /// The cells of `mesh`; `straight` are the unperturbed positions of its nodes.
    #[must_use]
    pub fn new(mesh: &'a Mesh, straight: &'a [DVec3]) -> Problem<'a> {
        let cells = mesh.cells();
        let mut valence = vec![0; straight.len()];
        for node in cells.blocks().iter().flat_map(|block| &block.nodes) {
            valence[node.index()] += 1;
        }
        Problem { order: mesh.order(), cells, straight, valence, view: View::of(mesh, straight) }
    }

    /// The costs that elements are to have.
    pub(super) fn threshold(&self, settings: &Settings) -> f64 {
        settings.threshold + if self.view.normal.is_some() { ABOVE_IN_PLANE } else { 0.0 }
    }

    pub(super) fn cells(&self) -> &Elements<'a> {
        &self.cells
    }

    pub(super) fn node_count(&self) -> usize {
        self.straight.len()
    }

    /// The cell of an element.
    #[must_use]
    pub fn cell(&self, element: ElementId) -> Cell {
        self.cells.cell(element)
    }

    /// The nodes of an element, in internal order.
    #[must_use]
    pub fn nodes(&self, element: ElementId) -> &'a [NodeId] {
        self.cells.nodes(element)
    }

    pub(super) fn valence(&self, node: NodeId) -> usize {
        self.valence[node.index()] as usize
    }

    /// The kinds of cells that occur.
    pub(super) fn kinds(&self) -> Vec<Cell> {
        let mut cells: Vec<Cell> = self.cells.blocks().iter().map(|b| b.cell).collect();
        cells.sort_unstable();
        cells.dedup();
        cells
    }

    /// The numbers of all elements, rising.
    pub(super) fn ids(&self) -> impl ExactSizeIterator<Item = ElementId> + Clone + use<> {
        self.cells.ids()
    }

    /// The numbers of all elements, rising, in parallel.
    pub(super) fn elements(&self) -> impl IndexedParallelIterator<Item = ElementId> + Clone + use<> {
        self.cells.par_ids()
    }

    /// Costs of all elements at the positions `x` of all nodes, surveyed at `factor` divisions of an edge in multiples of the order.
    #[must_use]
    pub fn survey(&self, x: &[DVec3], factor: usize) -> Vec<ElementCost> {
        self.costs(&Kernels::new(self, self.order.get() * factor), x, self.elements())
    }

    /// Costs of the given elements at the positions `x` of all nodes.
    pub(super) fn costs(
        &self,
        kernels: &Kernels,
        x: &[DVec3],
        elements: impl IndexedParallelIterator<Item = ElementId>,
    ) -> Vec<ElementCost> {
        let cost = |(scratch, points, targets): &mut (Scratch, Vec<DVec3>, Vec<DVec3>), e: ElementId| {
            let nodes = self.nodes(e);
            let origin = self.straight[nodes[0].index()];
            points.clear();
            points.extend(nodes.iter().map(|n| x[n.index()] - origin));
            targets.clear();
            targets.extend(nodes.iter().map(|n| self.straight[n.index()] - origin));
            if points == targets {
                return ElementCost { c_wcn: 1.0, mean_c_wcn: 1.0, c_jac: 1.0, cut: 0 };
            }
            let view = self.view.of_element(&targets[..self.cell(e).corner_count()]);
            view.turn(points);
            view.turn(targets);
            let (c_wcn, mean_c_wcn, cut) = element_c_wcn(self.cell(e), self.order, points, targets);
            let element = Element { points, targets, cut };
            let c_jac = kernels.of(self.cell(e)).c_jac(&element, scratch);
            ElementCost { c_wcn, mean_c_wcn, c_jac, cut }
        };
        elements.with_min_len(64).map_init(Default::default, cost).collect()
    }
}

/// One kernel a cell, all of the same survey density.
pub(super) struct Kernels(Vec<(Cell, Kernel)>);

impl Kernels {
    pub(super) fn new(problem: &Problem, divisions: usize) -> Kernels {
        let kernel = |cell| (cell, Kernel::new(cell, problem.order, divisions));
        Kernels(problem.kinds().into_iter().map(kernel).collect())
    }

    /// The kernel of a cell that occurs in the problem.
    pub(super) fn of(&self, cell: Cell) -> &Kernel {
        let place = self.0.partition_point(|(other, _)| *other < cell);
        &self.0[place].1
    }
}
