//! The nodes of elements from the values of a space.

use rustc_hash::FxHashMap;

use glam::DVec3;

use super::collection::Collection;
use super::elements::Elements;
use super::numbering::Numbering;
use crate::element::Cell;
use crate::mesh::{FaceKey, NodeId, TooMany};

/// How far apart, as a part of the mesh's size, the values of two elements on a side that they share may be to be one node.
const SAME: f64 = 1e-12;

/// Points, and the nodes of cells and sides.
pub(super) struct Placed {
    pub(super) points: Vec<DVec3>,
    /// Nodes of the cells in internal order, one cell behind the other.
    pub(super) cells: Vec<NodeId>,
    /// Nodes of the sides likewise; `None` for one that is no side of a cell.
    pub(super) sides: Vec<Option<Vec<NodeId>>>,
    /// Nodes of one place that are apart: the mesh is joined to itself there.
    pub(super) apart: usize,
}

/// Where the values of a space stand.
pub(super) struct Layout {
    space: Collection,
    numbering: Numbering,
    /// Values before those of each cell, and of all, where cells have their own.
    own: Vec<usize>,
}

impl Layout {
    pub(super) fn new(space: Collection, vertices: usize, cells: &Elements) -> Layout {
        let numbering = Numbering::new(space.order, vertices, cells.iter().map(|(cell, _, corners)| (cell, corners)));
        let mut own = vec![0];
        let mut count = 0;
        for &(_, cell) in &cells.kinds {
            count += cell.node_count(space.order);
            own.push(count);
        }
        Layout { space, numbering, own }
    }

    /// Number of values.
    pub(super) fn count(&self) -> usize {
        if self.space.continuous { self.numbering.count() } else { self.own.last().copied().unwrap_or(0) }
    }

    /// The nodes that values give.
    ///
    /// # Errors
    /// [`TooMany`].
    pub(super) fn place(&self, values: &[DVec3], cells: &Elements, sides: &Elements) -> Result<Placed, TooMany> {
        let size = values.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[a, b], &x| [a.min(x), b.max(x)]);
        let tolerance = SAME * (size[1] - size[0]).length();
        let mut joint =
            Joint { first: vec![None; self.numbering.count()], others: FxHashMap::default(), points: Vec::new() };
        let mut matrices: FxHashMap<Cell, Option<Vec<f64>>> = FxHashMap::default();
        let mut placed = Placed { points: Vec::new(), cells: Vec::new(), sides: Vec::new(), apart: 0 };
        let mut places = Vec::new();
        for (n, (cell, _, corners)) in cells.iter().enumerate() {
            self.numbering.element(n, cell, corners, &mut places);
            let own: Vec<DVec3> = match self.space.continuous {
                true => places.iter().map(|&place| values[place]).collect(),
                false => self.space.places(cell).iter().map(|&row| values[self.own[n] + row]).collect(),
            };
            let matrix = matrices.entry(cell).or_insert_with(|| self.space.to_nodes(cell));
            let points = matrix.as_ref().map_or_else(|| own.clone(), |matrix| product(matrix, &own));
            for (&place, point) in places.iter().zip(points) {
                placed.cells.push(joint.node(place, point, self.space.continuous, tolerance)?);
            }
        }
        placed.sides = self.sides(cells, sides, &placed.cells);
        placed.apart = joint.others.values().map(Vec::len).sum();
        placed.points = joint.points;
        Ok(placed)
    }

    /// The nodes of sides, from the first cell that has each.
    fn sides(&self, cells: &Elements, sides: &Elements, nodes: &[NodeId]) -> Vec<Option<Vec<NodeId>>> {
        let mut owners: FxHashMap<FaceKey, usize> =
            sides.iter().map(|(_, _, corners)| (FaceKey::new(corners), usize::MAX)).collect();
        let all: Vec<(Cell, &[NodeId])> = cells.iter().map(|(cell, _, corners)| (cell, corners)).collect();
        for (n, (cell, corners)) in all.iter().enumerate() {
            for side in cell.sides() {
                let own: Vec<NodeId> = side.iter().map(|&corner| corners[usize::from(corner)]).collect();
                owners.entry(FaceKey::new(&own)).and_modify(|owner| *owner = (*owner).min(n));
            }
        }
        let (mut of_side, mut of_cell) = (Vec::new(), Vec::new());
        let mut side = |cell: Cell, corners: &[NodeId]| {
            let owner = owners.get(&FaceKey::new(corners)).copied().filter(|&owner| owner < all.len())?;
            self.numbering.side(cell, corners, &mut of_side);
            self.numbering.element(owner, all[owner].0, all[owner].1, &mut of_cell);
            let place = |value: &usize| of_cell.iter().position(|own| own == value);
            let nodes = &nodes[self.own[owner]..];
            of_side.iter().map(|value| place(value).map(|place| nodes[place])).collect::<Option<Vec<NodeId>>>()
        };
        sides.iter().map(|(cell, _, corners)| side(cell, corners)).collect()
    }
}

/// Nodes being made of the values at the places of a continuous space.
struct Joint {
    first: Vec<Option<NodeId>>,
    /// Further nodes of a place: where a mesh is joined to itself, its elements have different ones.
    others: FxHashMap<usize, Vec<NodeId>>,
    points: Vec<DVec3>,
}

impl Joint {
    fn node(&mut self, place: usize, point: DVec3, continuous: bool, tolerance: f64) -> Result<NodeId, TooMany> {
        let is = |points: &[DVec3], node: &NodeId| continuous || points[node.index()].distance(point) <= tolerance;
        let others = self.others.get(&place).into_iter().flatten();
        if let Some(known) = self.first[place].iter().chain(others).find(|node| is(&self.points, node)) {
            return Ok(*known);
        }
        let node = NodeId::new(self.points.len())?;
        self.points.push(point);
        if self.first[place].is_none() {
            self.first[place] = Some(node);
        } else {
            self.others.entry(place).or_default().push(node);
        }
        Ok(node)
    }
}

/// A square row-major matrix times a list of points.
fn product(matrix: &[f64], points: &[DVec3]) -> Vec<DVec3> {
    matrix.chunks_exact(points.len()).map(|row| row.iter().zip(points).map(|(&a, &x)| a * x).sum()).collect()
}
