//! Edges and faces that are as they would be without a curve.

use glam::DVec3;

use crate::element::{Cell, Order, basis};
use crate::mesh::NodeId;

/// How far a node may be from where a straight edge or face has it, as a fraction of the mesh's diagonal: what rounding leaves.
const ROUNDING: f64 = 1e-15;

/// Tells straight edges and faces of one order from others.
pub(super) struct Straight {
    tolerance: f64,
    /// Weights of the corners at each node.
    weights: [Vec<Vec<f64>>; 3],
}

impl Straight {
    /// For elements of an order among these points.
    pub(super) fn new(order: Order, points: &[DVec3]) -> Straight {
        let [lower, upper] = points
            .iter()
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[lower, upper], &x| [lower.min(x), upper.max(x)]);
        let weights = KINDS.map(|cell| basis::at_lattice(cell, Order::LINEAR, order));
        let size = (upper - lower).length().max(lower.abs().max_element()).max(upper.abs().max_element());
        Straight { tolerance: ROUNDING * size, weights }
    }

    /// Whether a line, triangle or quadrilateral of these nodes is straight and evenly divided.
    pub(super) fn is(&self, cell: Cell, points: &[DVec3], nodes: &[NodeId]) -> bool {
        let Some(kind) = KINDS.iter().position(|own| *own == cell) else { return false };
        self.weights[kind].iter().zip(nodes).all(|(weights, node)| {
            let even: DVec3 = weights.iter().zip(nodes).map(|(&w, corner)| w * points[corner.index()]).sum();
            even.distance(points[node.index()]) <= self.tolerance
        })
    }
}

const KINDS: [Cell; 3] = [Cell::Line, Cell::Triangle, Cell::Quad];
