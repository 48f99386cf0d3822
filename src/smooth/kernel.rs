//! One element's contribution to the objective, and to its gradient and Hessian blocks by each of its nodes.

use glam::{DMat3, DVec3};

use super::density::Density;
use super::derivative::NodeDerivative;
use super::survey::{Scratch, Survey};
use crate::element::{Cell, Order, corner_simplices, simplex_nodes};
use crate::quality::{Cut, corner_frame};

/// Weights of the two components of equation (2), and how their samples count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weights {
    /// Weight of the mean over the sub-elements.
    pub(super) shape: f64,
    /// Weight of the mean over the survey points.
    pub(super) jacobian: f64,
    pub(super) density: Density,
}

/// Tables for all elements of one cell.
pub(super) struct Kernel {
    pub(super) cell: Cell,
    pub(super) order: Order,
    pub(super) survey: Survey,
}

/// An element as the kernel sees it: nodes relative to the first corner, those of plane cells in the plane of x and y.
pub(super) struct Element<'a> {
    pub(super) points: &'a [DVec3],
    pub(super) targets: &'a [DVec3],
    pub(super) cut: Cut,
}

impl Kernel {
    pub(super) fn new(cell: Cell, order: Order, divisions: usize) -> Kernel {
        Kernel { cell, order, survey: Survey::new(cell, order, divisions) }
    }

    /// The element's contribution to the objective.
    pub(super) fn value(&self, element: &Element, weights: &Weights, scratch: &mut Scratch) -> f64 {
        let mut value = self.shape_value(element, weights);
        if weights.jacobian > 0.0 && value.is_finite() {
            value += weights.jacobian * self.survey.value(element.points, element.targets, &weights.density, scratch);
        }
        value
    }

    /// Smallest `C_JAC` at the survey points, equation (6).
    pub(super) fn c_jac(&self, element: &Element, scratch: &mut Scratch) -> f64 {
        self.survey.c_jac(element.points, element.targets, scratch)
    }

    /// The element's contribution to the objective; its derivatives are added to `nodes`.
    pub(super) fn derivatives(
        &self,
        element: &Element,
        weights: &Weights,
        scratch: &mut Scratch,
        nodes: &mut [NodeDerivative],
    ) -> f64 {
        let mut value = self.shape_derivatives(element, weights, nodes);
        if weights.jacobian > 0.0 && value.is_finite() {
            let term = (&weights.density, weights.jacobian);
            value += self.survey.derivatives(element.points, element.targets, term, scratch, nodes);
        }
        value
    }

    fn shape_value(&self, element: &Element, weights: &Weights) -> f64 {
        let simplices = &corner_simplices(self.cell, self.order)[usize::from(element.cut)];
        let flat = self.cell.is_flat();
        let share = |&simplex: &[u8; 4]| {
            let w = corner_frame(simplex, element.targets).inverse();
            weights.density.shape_value(corner_frame(simplex, element.points) * w, flat)
        };
        weights.shape / simplices.len() as f64 * simplices.iter().map(share).sum::<f64>()
    }

    fn shape_derivatives(&self, element: &Element, weights: &Weights, nodes: &mut [NodeDerivative]) -> f64 {
        if self.cell.is_flat() {
            self.shape_sums::<true>(element, weights, nodes)
        } else {
            self.shape_sums::<false>(element, weights, nodes)
        }
    }

    fn shape_sums<const FLAT: bool>(&self, element: &Element, weights: &Weights, nodes: &mut [NodeDerivative]) -> f64 {
        let simplices = &corner_simplices(self.cell, self.order)[usize::from(element.cut)];
        let scale = weights.shape / simplices.len() as f64;
        let mut value = 0.0;
        for &simplex in simplices {
            let w = corner_frame(simplex, element.targets).inverse();
            let sample = weights.density.shape::<FLAT>(corner_frame(simplex, element.points) * w);
            value += scale * sample.value;
            for (&node, g) in simplex_nodes(&simplex).iter().zip(hats(w, FLAT)) {
                let node = &mut nodes[usize::from(node)];
                node.gradient += sample.stress * g * scale;
                node.hessian += sample.hessian(g) * scale;
            }
        }
        value
    }
}

/// Gradients of a corner simplex' hat functions in its target, by its nodes, `w` being the inverse of the target's frame; of a plane one
/// (`flat`) the fourth is none.
pub(super) fn hats(w: DMat3, flat: bool) -> [DVec3; 4] {
    let rows = w.transpose();
    let [x, y, z] = [rows.x_axis, rows.y_axis, if flat { DVec3::ZERO } else { rows.z_axis }];
    [-(x + y + z), x, y, z]
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::element::lattice;

    /// A curved element: the lattice bent by a smooth map and shrunk, so that no sample is near the cap at J = J_c.
    pub(in super::super) fn bent(cell: Cell, order: Order) -> (Vec<DVec3>, Vec<DVec3>) {
        let flat = |x: DVec3| if cell.is_flat() { x.with_z(0.0) } else { x };
        let targets: Vec<DVec3> = lattice(cell, order)
            .iter()
            .map(|n| DVec3::from(n.map(|x| f64::from(x) / order.get() as f64)) * DVec3::new(1.0, 0.8, 0.3))
            .collect();
        let bend =
            |x: &DVec3| *x * 0.8 + DVec3::new(0.1 * x.y * x.x, -0.1 * x.z * x.x, 0.15 * x.x * x.x - 0.2 * x.z * x.y);
        (targets.iter().map(bend).map(flat).collect(), targets)
    }

    #[test]
    fn gradients_and_hessians_have_their_order() {
        let mut scratch = Scratch::default();
        let weights = Weights { shape: 0.4, jacobian: 0.6, density: Density { emphasis: 5.0, delta: 0.0 } };
        for cell in Cell::CURVABLE {
            for order in Order::all().skip(1) {
                let kernel = Kernel::new(cell, order, order.get());
                let (points, targets) = bent(cell, order);
                let mut nodes = vec![NodeDerivative::ZERO; points.len()];
                let element = Element { points: &points, targets: &targets, cut: 0 };
                let value = kernel.derivatives(&element, &weights, &mut scratch, &mut nodes);
                let same = kernel.value(&element, &weights, &mut scratch);
                assert!((value - same).abs() < 1e-12 * value, "{cell} {order}: {value} and {same}");
                for moved in [0, points.len() / 2, points.len() - 1] {
                    let d = DVec3::new(0.2, -0.15, if cell.is_flat() { 0.0 } else { 0.1 });
                    let mut remainder = |h: f64, with: f64| {
                        let mut points = points.clone();
                        points[moved] += d * h;
                        let element = Element { points: &points, targets: &targets, cut: 0 };
                        let bend = (nodes[moved].hessian * d).dot(d) * 0.5 * h * h * with;
                        (kernel.value(&element, &weights, &mut scratch)
                            - value
                            - h * nodes[moved].gradient.dot(d)
                            - bend)
                            .abs()
                    };
                    let mut rate = |with: f64| (remainder(1e-3, with) / remainder(5e-4, with)).log2();
                    let (first, second) = (rate(0.0), rate(1.0));
                    assert!((first - 2.0).abs() < 0.15, "{cell} {order} node {moved}: gradient h^{first:.2}");
                    // Where the cubic term happens to vanish the remainder falls faster still.
                    assert!(second > 2.7, "{cell} {order} node {moved}: hessian h^{second:.2}");
                }
            }
        }
    }

    #[test]
    fn the_straight_element_costs_nothing() {
        let mut scratch = Scratch::default();
        let weights = Weights { shape: 0.5, jacobian: 0.5, density: Density { emphasis: 100.0, delta: 0.0 } };
        for cell in Cell::CURVABLE {
            let (_, targets) = bent(cell, Order::MAX);
            let kernel = Kernel::new(cell, Order::MAX, 8);
            let element = Element { points: &targets, targets: &targets, cut: 0 };
            assert!(kernel.value(&element, &weights, &mut scratch) < 1e-12, "{cell}");
        }
    }
}
