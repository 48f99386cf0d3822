//! Straight elements: how far the nodes are from the lattice of their own corners.

use super::real::UNIT;
use crate::element::{Cell, Order, Tables, basis, bernstein, lattice};

/// Nodes that are farther than this from the lattice, relative to the element's size, make it curved.
const STRAIGHT: f64 = 1e-9;

/// Largest distance by components of the nodes from the lattice of the corners, rounding included; `None` where it is
/// more than [`STRAIGHT`].
///
/// `nodes` are shifted and scaled, `largest` their largest components. Relative to `largest`: a node's own shift is off
/// by `u`, the weights by less than `40 u` taken together (at most 8, each a product of up to three differences of
/// lattice coordinates), the sum of products by `9 u`; `64 u` covers them.
pub(super) fn distance(cell: Cell, order: Order, nodes: &[[f64; 3]], largest: [f64; 3]) -> Option<[f64; 3]> {
    let corners = cell.corner_count();
    let mut off = [0.0f64; 3];
    for (node, weights) in nodes.iter().zip(weights(cell, order).chunks_exact(corners)).skip(corners).rev() {
        for axis in 0..3 {
            let straight: f64 = nodes.iter().zip(weights).map(|(corner, weight)| corner[axis] * weight).sum();
            off[axis] = off[axis].max((node[axis] - straight).abs());
        }
        if off.iter().any(|&x| x > STRAIGHT) {
            return None;
        }
    }
    Some([0, 1, 2].map(|axis| off[axis] + 64.0 * UNIT * largest[axis]))
}

/// Weights of the corners at each node of the straight element.
fn weights(cell: Cell, order: Order) -> &'static [f64] {
    static TABLES: Tables<Vec<f64>> = Tables::new();
    TABLES.get(cell, order, || {
        let unit = |at: &[u8; 3]| at.map(|x| f64::from(x) / order.get() as f64);
        let values = |at| basis::values(cell, Order::LINEAR, bernstein::chart(cell, unit(at)));
        lattice(cell, order).iter().flat_map(values).collect()
    })
}
