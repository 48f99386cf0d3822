//! Numbers by which Gmsh calls the elements.

use crate::element::{Cell, Order};

/// Gmsh's number of the complete element: `[P1, P2, P3, P4]`, in the order of [`Cell::ALL`].
const COMPLETE: [[i32; 4]; 8] = [
    [15; 4],
    [1, 8, 26, 27],
    [2, 9, 21, 23],
    [3, 10, 36, 37],
    [4, 11, 29, 30],
    [7, 14, 118, 119],
    [6, 13, 90, 91],
    [5, 12, 92, 93],
];

/// Gmsh's numbers of elements that leave out interior nodes.
const INCOMPLETE: [i32; 17] = [16, 39, 40, 20, 22, 24, 137, 32, 19, 125, 126, 18, 111, 112, 17, 99, 100];

/// What a Gmsh element number stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    /// An element with all nodes of its lattice.
    Complete(Cell, Order),
    /// An element that leaves out interior nodes (serendipity).
    Incomplete,
    /// An element of order 5 to 10.
    TooHigh,
}

/// Gmsh's number of an element.
#[must_use]
pub fn of(cell: Cell, order: Order) -> i32 {
    COMPLETE[cell as usize][order.get() - 1]
}

/// What a Gmsh element number stands for; `None` where it is no element that could be curved (polygons, ...).
pub(super) fn meaning(code: i32) -> Option<Type> {
    for cell in Cell::ALL {
        if let Some(order) = Order::all().find(|&order| of(cell, order) == code) {
            return Some(Type::Complete(cell, order));
        }
    }
    if INCOMPLETE.contains(&code) {
        return Some(Type::Incomplete);
    }
    // Line, triangle, quadrilateral, tet, hex, prism, pyramid of order 5, and of order 6 to 10 (GmshDefines.h).
    let high =
        matches!(code, 28 | 62..=66 | 25 | 42..=46 | 38 | 47..=51 | 31 | 71..=75 | 94..=98 | 106..=110 | 120..=124);
    high.then_some(Type::TooHigh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::node_order::judge;

    #[test]
    fn numbers_are_gmshs() {
        for (cell, order) in judge::elements() {
            let code = of(cell, order);
            assert_eq!(judge::element(cell, order)["gmsh"]["type"], code, "{cell} {order}");
            assert_eq!(meaning(code), Some(Type::Complete(cell, order)));
        }
    }
}
