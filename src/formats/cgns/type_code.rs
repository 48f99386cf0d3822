//! Numbers and names by which CGNS calls the elements.

use crate::element::{Cell, Order};

/// CGNS' number of the complete element, in the order of [`Cell::ALL`] (`cgnslib.h`).
const COMPLETE: [[i32; 4]; 8] = [
    [2; 4],
    [3, 4, 24, 40],
    [5, 6, 26, 42],
    [7, 9, 28, 44],
    [10, 11, 30, 47],
    [12, 13, 33, 50],
    [14, 16, 36, 53],
    [17, 19, 39, 56],
];

/// CGNS' `ElementType_t` number of an element.
pub(super) fn of(cell: Cell, order: Order) -> i32 {
    COMPLETE[cell as usize][order.get() - 1]
}

/// What a CGNS `ElementType_t` number stands for, where it is a complete element.
pub(super) fn meaning(code: i32) -> Option<(Cell, Order)> {
    Cell::ALL.into_iter().flat_map(|cell| Order::all().map(move |p| (cell, p))).find(|&(cell, p)| of(cell, p) == code)
}

/// CGNS' name of an element: `TETRA_10`, ...
pub(super) fn name(cell: Cell, order: Order) -> String {
    let stem = match cell {
        Cell::Point => return "NODE".into(),
        Cell::Line => "BAR",
        Cell::Triangle => "TRI",
        Cell::Quad => "QUAD",
        Cell::Tet => "TETRA",
        Cell::Pyramid => "PYRA",
        Cell::Prism => "PENTA",
        Cell::Hex => "HEXA",
    };
    format!("{stem}_{}", cell.node_count(order))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::lattice;
    use crate::formats::node_order::judge;

    #[test]
    fn numbers_and_names_are_those_of_the_standard_and_the_internal_order_is_its_own() {
        for (cell, order) in judge::elements() {
            let theirs = &judge::element(cell, order)["cgns"];
            assert_eq!(theirs["id"], of(cell, order), "{cell} {order}");
            assert_eq!(theirs["name"], name(cell, order), "{cell} {order}");
            assert_eq!(meaning(of(cell, order)), Some((cell, order)));
            assert_eq!(judge::triples(&theirs["nodes"]).as_deref(), Some(lattice(cell, order)), "{cell} {order}");
        }
    }
}
