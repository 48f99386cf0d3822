//! One element's share of the objective, and of its gradient and Hessian blocks by each of its nodes.
//!
//! The survey part is written as loops over samples, so that the compiler vectorises them: a P4 tet surveyed at
//! density 8 multiplies 35 nodes by 165 samples by 9 entries.

use glam::{DMat3, DVec3};

use super::density::{Density, Jet};
use crate::element::samples::LANES;
use crate::element::{Cell, Order, Samples, corner_tets};
use crate::quality::{Cut, corner_frame};

/// Gradient and Hessian block of the objective by one node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct NodeDerivative {
    pub(super) gradient: DVec3,
    pub(super) hessian: DMat3,
}

impl NodeDerivative {
    pub(super) const ZERO: NodeDerivative = NodeDerivative { gradient: DVec3::ZERO, hessian: DMat3::ZERO };
}

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
    cell: Cell,
    order: Order,
    survey: Samples,
    /// The linear element's gradients at the same points, for `J_c`.
    linear: Samples,
}

/// An element as the kernel sees it: nodes relative to the first corner.
pub(super) struct Element<'a> {
    pub(super) points: &'a [DVec3],
    pub(super) targets: &'a [DVec3],
    pub(super) cut: Cut,
}

/// Buffers that are kept from element to element.
#[derive(Default)]
pub(super) struct Scratch {
    /// `dx_a/dxi_b` at every sample, `[3 a + b][sample]`; later its cofactors.
    frame: Vec<f64>,
    target: Vec<f64>,
    jc: Vec<f64>,
    slope: Vec<f64>,
    curvature: Vec<f64>,
}

impl Kernel {
    pub(super) fn new(cell: Cell, order: Order, divisions: usize) -> Kernel {
        let survey = Samples::survey(cell, order, divisions);
        let linear = Samples::survey(cell, Order::LINEAR, divisions);
        Kernel { cell, order, survey, linear }
    }

    /// The element's share of the objective.
    pub(super) fn value(&self, element: &Element, weights: &Weights, scratch: &mut Scratch) -> f64 {
        let mut value = self.shape_value(element, weights);
        if weights.jacobian > 0.0 && value.is_finite() {
            self.frames(element, scratch);
            let sum: f64 = self.ratios(scratch).map(|l| weights.density.jacobian(l).value).sum();
            value += weights.jacobian / self.survey.count() as f64 * sum;
        }
        value
    }

    /// Smallest `C_JAC` at the survey points, equation (6).
    pub(super) fn c_jac(&self, element: &Element, scratch: &mut Scratch) -> f64 {
        self.frames(element, scratch);
        self.ratios(scratch).fold(1.0, f64::min)
    }

    /// The element's share of the objective; its derivatives are added to `nodes`.
    pub(super) fn derivatives(
        &self,
        element: &Element,
        weights: &Weights,
        scratch: &mut Scratch,
        nodes: &mut [NodeDerivative],
    ) -> f64 {
        let mut value = self.shape_derivatives(element, weights, nodes);
        if weights.jacobian > 0.0 && value.is_finite() {
            self.frames(element, scratch);
            value += self.survey_derivatives(weights, scratch, nodes);
        }
        value
    }

    fn shape_value(&self, element: &Element, weights: &Weights) -> f64 {
        let tets = &corner_tets(self.cell, self.order)[usize::from(element.cut)];
        let share = |&tet: &[u8; 4]| {
            let w = corner_frame(tet, element.targets).inverse();
            weights.density.shape_value(corner_frame(tet, element.points) * w)
        };
        weights.shape / tets.len() as f64 * tets.iter().map(share).sum::<f64>()
    }

    fn shape_derivatives(&self, element: &Element, weights: &Weights, nodes: &mut [NodeDerivative]) -> f64 {
        let tets = &corner_tets(self.cell, self.order)[usize::from(element.cut)];
        let scale = weights.shape / tets.len() as f64;
        let mut value = 0.0;
        for &tet in tets {
            let w = corner_frame(tet, element.targets).inverse();
            let sample = weights.density.shape(corner_frame(tet, element.points) * w);
            value += scale * sample.value;
            let rows = w.transpose();
            let hats = [-(rows.x_axis + rows.y_axis + rows.z_axis), rows.x_axis, rows.y_axis, rows.z_axis];
            for (&node, g) in tet.iter().zip(hats) {
                let node = &mut nodes[usize::from(node)];
                node.gradient += sample.stress * g * scale;
                node.hessian += sample.hessian(g) * scale;
            }
        }
        value
    }

    /// Fills the frames at all samples, and `J_c`.
    fn frames(&self, element: &Element, scratch: &mut Scratch) {
        let corners = &element.targets[..self.cell.corner_count()];
        accumulate(&self.linear, corners, &mut scratch.target);
        accumulate(&self.survey, element.points, &mut scratch.frame);
        let n = self.survey.padded();
        scratch.jc.resize(n, 0.0);
        let target = &scratch.target;
        for s in 0..n {
            scratch.jc[s] = determinant(&std::array::from_fn(|q| target[q * n + s]));
        }
    }

    /// `J / J_c` at the samples.
    fn ratios<'a>(&self, scratch: &'a Scratch) -> impl Iterator<Item = f64> + 'a {
        let n = self.survey.padded();
        (0..self.survey.count())
            .map(move |s| determinant(&std::array::from_fn(|q| scratch.frame[q * n + s])) / scratch.jc[s])
    }

    fn survey_derivatives(&self, weights: &Weights, scratch: &mut Scratch, nodes: &mut [NodeDerivative]) -> f64 {
        let (n, count) = (self.survey.padded(), self.survey.count());
        let scale = weights.jacobian / count as f64;
        scratch.slope.clear();
        scratch.slope.resize(n, 0.0);
        scratch.curvature.clear();
        scratch.curvature.resize(n, 0.0);
        let mut value = 0.0;
        for s in 0..count {
            let frame: [f64; 9] = std::array::from_fn(|q| scratch.frame[q * n + s]);
            let cofactor = cofactors(&frame);
            let inverse = 1.0 / scratch.jc[s];
            let l = inverse * (frame[0] * cofactor[0] + frame[1] * cofactor[1] + frame[2] * cofactor[2]);
            let jet: Jet = weights.density.jacobian(l);
            value += scale * jet.value;
            scratch.slope[s] = scale * jet.slope * inverse;
            scratch.curvature[s] = scale * jet.curvature * inverse * inverse;
            for (q, c) in cofactor.into_iter().enumerate() {
                scratch.frame[q * n + s] = c;
            }
        }
        if scratch.curvature.iter().any(|&c| c != 0.0) {
            for (node, out) in nodes.iter_mut().enumerate() {
                add_node(self.survey.gradient(node), scratch, out);
            }
        }
        value
    }
}

/// `frame[3 a + b][s] = sum_i x_i[a] dphi_i/dxi_b(s)`.
fn accumulate(samples: &Samples, points: &[DVec3], frame: &mut Vec<f64>) {
    let n = samples.padded();
    frame.clear();
    frame.resize(9 * n, 0.0);
    for (node, x) in points.iter().enumerate() {
        for (b, slope) in samples.gradient(node).into_iter().enumerate() {
            for (a, x) in x.to_array().into_iter().enumerate() {
                for (entry, &slope) in frame[(3 * a + b) * n..][..n].iter_mut().zip(slope) {
                    *entry += x * slope;
                }
            }
        }
    }
}

/// Adds one node's derivatives: `J` is affine in the node with the slope `c = cof(D) grad phi`.
fn add_node(gradient: [&[f64]; 3], scratch: &Scratch, out: &mut NodeDerivative) {
    let n = gradient[0].len();
    let mut force = [[0.0; LANES]; 3];
    let mut block = [[0.0; LANES]; 6];
    for start in (0..n).step_by(LANES) {
        for lane in 0..LANES {
            let s = start + lane;
            let g = [gradient[0][s], gradient[1][s], gradient[2][s]];
            let at = |q: usize| scratch.frame[q * n + s];
            let c: [f64; 3] = std::array::from_fn(|a| at(3 * a) * g[0] + at(3 * a + 1) * g[1] + at(3 * a + 2) * g[2]);
            let (slope, curvature) = (scratch.slope[s], scratch.curvature[s]);
            for a in 0..3 {
                force[a][lane] += slope * c[a];
            }
            let bent = c.map(|c| c * curvature);
            block[0][lane] += bent[0] * c[0];
            block[1][lane] += bent[1] * c[1];
            block[2][lane] += bent[2] * c[2];
            block[3][lane] += bent[1] * c[2];
            block[4][lane] += bent[0] * c[2];
            block[5][lane] += bent[0] * c[1];
        }
    }
    let sum = |lanes: [f64; LANES]| lanes.iter().sum::<f64>();
    out.gradient += DVec3::from(force.map(sum));
    let [xx, yy, zz, yz, xz, xy] = block.map(sum);
    out.hessian += DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
}

/// Cofactors of a row-major 3x3 matrix, row-major.
fn cofactors(m: &[f64; 9]) -> [f64; 9] {
    [
        m[4] * m[8] - m[5] * m[7],
        m[5] * m[6] - m[3] * m[8],
        m[3] * m[7] - m[4] * m[6],
        m[2] * m[7] - m[1] * m[8],
        m[0] * m[8] - m[2] * m[6],
        m[1] * m[6] - m[0] * m[7],
        m[1] * m[5] - m[2] * m[4],
        m[2] * m[3] - m[0] * m[5],
        m[0] * m[4] - m[1] * m[3],
    ]
}

fn determinant(m: &[f64; 9]) -> f64 {
    let c = cofactors(m);
    m[0] * c[0] + m[1] * c[1] + m[2] * c[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::lattice;

    /// A curved element: the lattice bent by a smooth map and shrunk, so that no sample is near the cap at J = J_c.
    fn bent(cell: Cell, order: Order) -> (Vec<DVec3>, Vec<DVec3>) {
        let targets: Vec<DVec3> = lattice(cell, order)
            .iter()
            .map(|n| DVec3::from(n.map(|x| f64::from(x) / order.get() as f64)) * DVec3::new(1.0, 0.8, 0.3))
            .collect();
        let bend =
            |x: &DVec3| *x * 0.8 + DVec3::new(0.1 * x.y * x.x, -0.1 * x.z * x.x, 0.15 * x.x * x.x - 0.2 * x.z * x.y);
        (targets.iter().map(bend).collect(), targets)
    }

    #[test]
    fn gradients_and_hessians_have_their_order() {
        let mut scratch = Scratch::default();
        let weights = Weights { shape: 0.4, jacobian: 0.6, density: Density { emphasis: 5.0, delta: 0.0 } };
        for cell in Cell::VOLUME {
            for order in Order::all().skip(1) {
                let kernel = Kernel::new(cell, order, order.get());
                let (points, targets) = bent(cell, order);
                let mut nodes = vec![NodeDerivative::ZERO; points.len()];
                let element = Element { points: &points, targets: &targets, cut: 0 };
                let value = kernel.derivatives(&element, &weights, &mut scratch, &mut nodes);
                let same = kernel.value(&element, &weights, &mut scratch);
                assert!((value - same).abs() < 1e-12 * value, "{cell} {order}: {value} and {same}");
                for moved in [0, points.len() / 2, points.len() - 1] {
                    let d = DVec3::new(0.2, -0.15, 0.1);
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
        for cell in Cell::VOLUME {
            let (_, targets) = bent(cell, Order::MAX);
            let kernel = Kernel::new(cell, Order::MAX, 8);
            let element = Element { points: &targets, targets: &targets, cut: 0 };
            assert!(kernel.value(&element, &weights, &mut scratch) < 1e-12, "{cell}");
        }
    }
}
