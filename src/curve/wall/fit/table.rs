//! Values and slopes of the Lagrange functions of wall faces and edges, where the fit needs them.

use crate::element::{Cell, Order, Samples, basis, interior_extension, interior_start};

/// Points an edge, times the order, at which all faces are measured.
const COARSE: usize = 2;
/// The same for faces that are fitted.
const FINE: usize = 3;
/// A function this close to 1 is that of a node at the point.
const AT_NODE: f64 = 1e-9;

/// Functions of one cell at one order. The rim of an edge is all of it.
pub(super) struct Table {
    /// Number of nodes on the rim.
    pub(super) rim: usize,
    /// Values at a few points between the nodes: `[point][node]`.
    pub(super) coarse: Vec<Vec<f64>>,
    /// Values at more of them.
    pub(super) fine: Vec<Vec<f64>>,
    /// Slopes by the unit cell's coordinates at the lattice's points, inner nodes following the rim: `[point][rim node]`.
    pub(super) slopes: Vec<Vec<[f64; 2]>>,
    /// Slopes of the linear functions at the same points: `[point][corner]`.
    pub(super) straight: Vec<Vec<[f64; 2]>>,
    /// Weights of the rim's nodes at each inner node.
    pub(super) extension: &'static [f64],
}

impl Table {
    /// The table of a line, triangle or quadrilateral.
    pub(super) fn new(cell: Cell, order: Order) -> Table {
        let rim = if cell == Cell::Line { cell.node_count(order) } else { interior_start(cell, order) };
        let extension = interior_extension(cell, order);
        let lattice = points(cell, order.get());
        let slopes = |order: Order| lattice.iter().map(move |&at| flat(basis::gradients(cell, order, at)));
        Table {
            rim,
            coarse: between(cell, order, COARSE),
            fine: between(cell, order, FINE),
            slopes: slopes(order).map(|slopes| led(slopes, rim, extension)).collect(),
            straight: slopes(Order::LINEAR).collect(),
            extension,
        }
    }
}

fn points(cell: Cell, divisions: usize) -> Vec<[f64; 3]> {
    let samples = Samples::survey(cell, Order::LINEAR, divisions);
    samples.points()[..samples.count()].to_vec()
}

/// Values at the points of `density` times the order an edge that are no nodes.
fn between(cell: Cell, order: Order, density: usize) -> Vec<Vec<f64>> {
    let values = points(cell, density * order.get()).into_iter().map(|at| basis::values(cell, order, at));
    values.filter(|values| values.iter().all(|v| (v - 1.0).abs() > AT_NODE)).collect()
}

fn flat(slopes: Vec<[f64; 3]>) -> Vec<[f64; 2]> {
    slopes.into_iter().map(|[x, y, _]| [x, y]).collect()
}

/// Slopes by the rim's nodes alone, where the inner nodes go as the extension takes them.
fn led(mut slopes: Vec<[f64; 2]>, rim: usize, extension: &[f64]) -> Vec<[f64; 2]> {
    let inner = slopes.split_off(rim);
    for (slope, weights) in inner.iter().zip(extension.chunks_exact(rim)) {
        for (own, weight) in slopes.iter_mut().zip(weights) {
            *own = std::array::from_fn(|axis| own[axis] + weight * slope[axis]);
        }
    }
    slopes
}
