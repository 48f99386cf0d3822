//! The order of the nodes of elements in HOPR's files.

use crate::element::{Cell, Order, Tables, lattice};

/// For each place of an element's nodes row by row, the first axis fastest, the node in internal order.
pub(super) fn of(cell: Cell, order: Order) -> &'static [usize] {
    static TABLES: Tables<Vec<usize>> = Tables::new();
    TABLES.get(cell, order, || {
        let nodes = lattice(cell, order);
        let mut places: Vec<usize> = (0..nodes.len()).collect();
        places.sort_by_key(|&n| [nodes[n][2], nodes[n][1], nodes[n][0]]);
        places
    })
}
