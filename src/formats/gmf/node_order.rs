//! Node orders that files state themselves: the indices of each node, as of Bernstein polynomials.
//!
//! Triangles and tets have one index a corner, which sum up to the order; quadrilaterals, hexes and pyramids the lattice
//! coordinates; prisms the three of their triangle and the height. Where a file states none, the order is that of CGNS: ViZiR's
//! own, and that of the files of order 2 which Gmsh writes.

use crate::element::{Cell, Order, lattice};

/// Number of indices of a node.
pub(super) fn indices(cell: Cell) -> usize {
    match cell {
        Cell::Point => 0,
        Cell::Line => 1,
        Cell::Quad => 2,
        Cell::Triangle | Cell::Pyramid | Cell::Hex => 3,
        Cell::Tet | Cell::Prism => 4,
    }
}

/// The indices of a lattice point.
pub(super) fn row(cell: Cell, order: Order, [i, j, k]: [u8; 3]) -> Vec<u8> {
    let p = order.get() as u8;
    match cell {
        Cell::Point => Vec::new(),
        Cell::Line => vec![i],
        Cell::Quad => vec![i, j],
        Cell::Triangle => vec![p - i - j, i, j],
        Cell::Pyramid | Cell::Hex => vec![i, j, k],
        Cell::Tet => vec![p - i - j - k, i, j, k],
        Cell::Prism => vec![p - i - j, i, j, k],
    }
}

/// For each slot of an element in the file, the node of the internal order that it holds; `None` where the rows of indices are
/// no order of the element's nodes.
pub(super) fn slots(cell: Cell, order: Order, rows: &[i64]) -> Option<Vec<u8>> {
    let known: Vec<Vec<i64>> =
        lattice(cell, order).iter().map(|&at| row(cell, order, at).into_iter().map(i64::from).collect()).collect();
    let slots: Vec<u8> = rows
        .chunks_exact(indices(cell))
        .filter_map(|own| known.iter().position(|indices| indices == own))
        .map(|n| n as u8)
        .collect();
    let mut sorted = slots.clone();
    sorted.sort_unstable();
    sorted.dedup();
    (sorted.len() == known.len() && slots.len() == known.len()).then_some(slots)
}
