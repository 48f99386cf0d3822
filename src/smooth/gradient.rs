//! The paper's engine (§2.3): every node goes up the gradient of its own cost, node by node.
//!
//! It works on the paper's costs as they are printed, not on the smooth objective of [`super::density`]: `C_WCN` of the
//! sub-elements at the node, `C_JAC` at the survey points of the elements around it, each blended from the worst and the
//! mean by equation (8), the two by equation (2). Only nodes below the threshold and their immediate neighbours move; a step
//! is at most [`FRACTION`] of the smallest inscribed radius of the (unperturbed) sub-elements at the node.
//!
//! Where the paper is silent: the wish is the step that would bring the cost to 1 if its slope stayed, and a node whose
//! cost fell since the last sweep goes half as far, later farther again. All nodes of a sweep step from the same state, so
//! that the result does not depend on their order or on the number of threads. Nodes on walls keep their springs
//! ([`super::Anchor`]), as with the other engine; nodes of periodic patches, of which the paper has none, are held.

use glam::DVec3;
use rayon::prelude::*;

use super::kernel::{Element, Kernel, hats};
use super::objective::{Gathered, Objective};
use super::survey::Scratch;
use super::{Constraint, Freedom};
use crate::element::{corner_simplices, simplex_nodes};
use crate::quality::{c_wcn_slope, corner_frame, nodal};

/// Longest step, as a fraction of the inscribed radius. Of 0.02, 0.05, 0.1, 0.25 and 0.5 the best on wing_sharp at scale 0.4, P2,
/// at the threshold 0.95: min C_JAC 0.778 after 97 sweeps, 0.770, 0.771, 0.753 and 0.691 after 200 with the others.
const FRACTION: f64 = 0.05;
/// What a node's steps are multiplied by after its cost fell, and after it rose.
const CAUTION: [f64; 2] = [0.5, 1.2];
/// Elements that one task evaluates.
const TASK: usize = 64;

/// One component of the cost around a node, gathered: worst and sum of its values, and their slopes by the node.
#[derive(Clone, Copy)]
struct Share {
    worst: (f64, DVec3),
    sum: (f64, DVec3),
    count: usize,
}

impl Share {
    const NONE: Share = Share { worst: (f64::INFINITY, DVec3::ZERO), sum: (0.0, DVec3::ZERO), count: 0 };

    fn add(&mut self, value: f64, slope: DVec3) {
        self.merge(&Share { worst: (value, slope), sum: (value, slope), count: 1 });
    }

    fn merge(&mut self, other: &Share) {
        if other.worst.0 < self.worst.0 {
            self.worst = other.worst;
        }
        self.sum = (self.sum.0 + other.sum.0, self.sum.1 + other.sum.1);
        self.count += other.count;
    }

    /// Equation (8) and its slope.
    fn cost(&self) -> (f64, DVec3) {
        if self.count == 0 {
            return (1.0, DVec3::ZERO);
        }
        let (worst, slope) = self.worst;
        let (mean, mean_slope) = (self.sum.0 / self.count as f64, self.sum.1 / self.count as f64);
        let by_worst = if worst <= 0.0 { slope } else { slope * (1.0 - 2.0 * worst + mean) + mean_slope * worst };
        (nodal(worst, mean), by_worst)
    }
}

/// Raises the nodes' costs by at most `sweeps` steps and returns their number; ends when all costs are at least
/// `threshold`, or when `watch` returns false.
pub(super) fn climb(
    objective: &Objective,
    constraint: &dyn Constraint,
    x: &mut Vec<DVec3>,
    sweeps: usize,
    threshold: f64,
    mut watch: impl FnMut(usize) -> bool,
) -> usize {
    let radii = radii(objective);
    let mut caution = vec![1.0; x.len()];
    let mut before: Vec<f64> = Vec::new();
    for done in 0..sweeps {
        let costs = costs(objective, x);
        let active = active(objective, &costs, threshold);
        if !active.contains(&true) {
            return done;
        }
        for ((caution, (cost, _)), before) in caution.iter_mut().zip(&costs).zip(&before) {
            let [shorter, longer] = CAUTION;
            *caution = if cost < before { *caution * shorter } else { (*caution * longer).min(1.0) };
        }
        before.clear();
        before.extend(costs.iter().map(|c| c.0));
        let step = |i: usize| {
            if !active[i] {
                return x[i];
            }
            let node = objective.patch.nodes[i];
            let freedom = constraint.freedom(node, x[i]);
            let slope = freedom.keep(costs[i].1);
            let steep = slope.length();
            if steep == 0.0 || !steep.is_finite() {
                return x[i];
            }
            let length = caution[i] * ((1.0 - costs[i].0) / steep).min(FRACTION * radii[i]);
            let wish = x[i] + slope * (length / steep);
            match freedom {
                Freedom::Space => wish,
                _ => constraint.restrict(node, x[i], wish),
            }
        };
        *x = (0..x.len()).into_par_iter().with_min_len(256).map(step).collect();
        if !watch(done + 1) {
            return done + 1;
        }
    }
    sweeps
}

/// Cost of every node of the patch and its slope by the node's place.
fn costs(objective: &Objective, x: &[DVec3]) -> Vec<(f64, DVec3)> {
    let patch = objective.patch;
    let mut slots = vec![[Share::NONE; 2]; patch.slots.len()];
    for (run, kernel) in patch.runs.iter().zip(&objective.kernels) {
        let out = &mut slots[run.slot..run.slot + run.count * run.stride];
        out.par_chunks_mut(TASK * run.stride).enumerate().for_each_init(Gathered::default, |gathered, (task, out)| {
            for (out, e) in out.chunks_mut(run.stride).zip(task * TASK..) {
                let (element, scratch) = objective.gather(run, e, x, gathered);
                shares(kernel, &element, objective.weights.jacobian > 0.0, scratch, out);
            }
        });
    }
    let [shape, size] = [objective.weights.shape, objective.weights.jacobian];
    let cost = |node: usize| {
        let mut around = [Share::NONE; 2];
        for &slot in patch.incident(node) {
            for (all, own) in around.iter_mut().zip(&slots[slot as usize]) {
                all.merge(own);
            }
        }
        let [(wcn, wcn_slope), (jac, jac_slope)] = around.map(|share| share.cost());
        (shape * wcn + size * jac, patch.view.back(wcn_slope * shape + jac_slope * size))
    };
    let mut costs: Vec<_> = (0..patch.nodes.len()).into_par_iter().with_min_len(256).map(cost).collect();
    for &(node, anchor) in &objective.anchors {
        let (off, stiffness) = (x[node] - anchor.place, 1.0 / (anchor.slack * anchor.slack));
        costs[node].0 -= off.length_squared() * stiffness;
        costs[node].1 -= off * (2.0 * stiffness);
    }
    costs
}

/// Adds an element's sub-elements and survey points to the shares of its nodes.
fn shares(kernel: &Kernel, element: &Element, jacobian: bool, scratch: &mut Scratch, nodes: &mut [[Share; 2]]) {
    let flat = kernel.cell.is_flat();
    for &simplex in &corner_simplices(kernel.cell, kernel.order)[usize::from(element.cut)] {
        let w = corner_frame(simplex, element.targets).inverse();
        let (value, stress) = c_wcn_slope(corner_frame(simplex, element.points) * w, flat);
        for (&node, hat) in simplex_nodes(&simplex).iter().zip(hats(w, flat)) {
            nodes[usize::from(node)][0].add(value, stress * hat);
        }
    }
    if jacobian {
        let survey = &kernel.survey;
        survey.sensitivities(element.points, element.targets, scratch, |node, value, slope| {
            nodes[node][1].add(value, slope);
        });
    }
}

/// Movable nodes that are below the threshold or share an element with one that is.
fn active(objective: &Objective, costs: &[(f64, DVec3)], threshold: f64) -> Vec<bool> {
    let patch = objective.patch;
    let low = |&node: &u32| patch.movable[node as usize] && costs[node as usize].0 < threshold;
    let mut active = vec![false; patch.nodes.len()];
    for run in &patch.runs {
        for nodes in patch.slots[run.slot..][..run.count * run.stride].chunks_exact(run.stride) {
            if nodes.iter().any(low) {
                nodes.iter().for_each(|&node| active[node as usize] = patch.movable[node as usize]);
            }
        }
    }
    for &(image, of, _) in &patch.periodic {
        (active[image], active[of]) = (false, false);
    }
    active
}

/// For every node the smallest inscribed radius of the unperturbed sub-elements at it: 3 volume / surface; of a triangle's as well, 2 area /
/// rim.
fn radii(objective: &Objective) -> Vec<f64> {
    let patch = objective.patch;
    let mut radii = vec![f64::INFINITY; patch.nodes.len()];
    for (run, kernel) in patch.runs.iter().zip(&objective.kernels) {
        let elements = patch.slots[run.slot..][..run.count * run.stride].chunks_exact(run.stride);
        for (nodes, &cut) in elements.zip(&objective.cuts[run.first..]) {
            for simplex in &corner_simplices(kernel.cell, kernel.order)[usize::from(cut)] {
                let corners = simplex.map(|n| nodes[usize::from(n)] as usize);
                let [o, a, b, c] = corners.map(|n| patch.targets[n]);
                let (u, v, w) = (a - o, b - o, c - o);
                let radius = if kernel.cell.is_flat() {
                    u.cross(v).length() / [u, v, v - u].map(DVec3::length).iter().sum::<f64>()
                } else {
                    let twice = [u.cross(v), v.cross(w), w.cross(u), (v - u).cross(w - u)].map(DVec3::length);
                    u.cross(v).dot(w).abs() / twice.iter().sum::<f64>()
                };
                corners.iter().for_each(|&n| radii[n] = radii[n].min(radius));
            }
        }
    }
    radii
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Cell, Order};
    use crate::smooth::kernel::tests::bent;

    /// The cost of one node of a single element, and its slope.
    fn cost(kernel: &Kernel, points: &[DVec3], targets: &[DVec3], node: usize) -> (f64, DVec3) {
        let mut nodes = vec![[Share::NONE; 2]; points.len()];
        shares(kernel, &Element { points, targets, cut: 0 }, true, &mut Scratch::default(), &mut nodes);
        let [(wcn, wcn_slope), (jac, jac_slope)] = nodes[node].map(|share| share.cost());
        (0.4 * wcn + 0.6 * jac, wcn_slope * 0.4 + jac_slope * 0.6)
    }

    #[test]
    fn slopes_of_nodal_costs_have_their_order() {
        for cell in Cell::CURVABLE {
            for order in Order::all().skip(1) {
                let kernel = Kernel::new(cell, order, order.get());
                let (mut points, targets) = bent(cell, order);
                // Without that some survey points tie for the worst (in the prism, those with x = 0, y = 1: J does not depend
                // on z there), and the cost has no slope.
                for (n, x) in points.iter_mut().enumerate() {
                    let n = n as f64;
                    *x += DVec3::new((1.3 * n).sin(), (2.1 * n + 0.5).sin(), (3.7 * n + 1.1).sin()) * 2e-3;
                }
                for node in [0, points.len() / 2, points.len() - 1] {
                    let d = DVec3::new(0.2, -0.15, 0.1);
                    let (value, slope) = cost(&kernel, &points, &targets, node);
                    let remainder = |h: f64| {
                        let mut moved = points.clone();
                        moved[node] += d * h;
                        (cost(&kernel, &moved, &targets, node).0 - value - h * slope.dot(d)).abs()
                    };
                    let (coarse, fine) = (remainder(2e-5), remainder(1e-5));
                    assert!(fine < 0.3 * coarse + 1e-13, "{cell} {order} node {node}: {coarse:e}, {fine:e}");
                }
            }
        }
    }
}
