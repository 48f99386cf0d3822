//! Numbers by which VTK calls the cells.

use crate::element::{Cell, Order};

/// VTK's number of the Lagrange hex, which stands for the pyramids that VTK lacks.
pub(super) const LAGRANGE_HEX: u8 = 72;

/// VTK's number of an element; `None` for pyramids beyond the linear one, which VTK lacks.
///
/// Linear elements are the classic ones, except the prism: which way VTK's own wedge points has changed between
/// versions, and the Lagrange wedge's has not.
pub(in crate::formats) fn of(cell: Cell, order: Order) -> Option<u8> {
    let linear = order == Order::LINEAR;
    match cell {
        Cell::Point => Some(1),
        Cell::Line => Some(if linear { 3 } else { 68 }),
        Cell::Triangle => Some(if linear { 5 } else { 69 }),
        Cell::Quad => Some(if linear { 9 } else { 70 }),
        Cell::Tet => Some(if linear { 10 } else { 71 }),
        Cell::Hex => Some(if linear { 12 } else { LAGRANGE_HEX }),
        Cell::Prism => Some(73),
        Cell::Pyramid => linear.then_some(14),
    }
}

/// What a VTK cell type with a number of nodes stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::formats) enum Type {
    /// A cell with all nodes of its lattice, in the order of VTK's Lagrange cells.
    Complete(Cell, Order),
    /// A cell that leaves out interior nodes, or has nodes that no lattice has.
    Incomplete,
    /// A cell of a known type with a number of nodes that none of its orders has.
    Count,
    /// No cell that could be curved.
    Unknown,
}

/// What a VTK cell type stands for. The complete quadratic cells have the order of the Lagrange cells of order 2.
pub(in crate::formats) fn meaning(code: i64, nodes: usize) -> Type {
    let cell = match code {
        1 => Cell::Point,
        3 | 21 | 68 => Cell::Line,
        5 | 22 | 69 => Cell::Triangle,
        9 | 28 | 70 => Cell::Quad,
        10 | 24 | 71 => Cell::Tet,
        14 => Cell::Pyramid,
        13 | 32 | 73 => Cell::Prism,
        12 | 29 | 72 => Cell::Hex,
        23 | 25 | 26 | 27 | 30 | 31 | 33..=37 | 74 => return Type::Incomplete,
        _ => return Type::Unknown,
    };
    let fixed = match code {
        1 | 3 | 5 | 9 | 10 | 12 | 13 | 14 => Some(1),
        21 | 22 | 24 | 28 | 29 | 32 => Some(2),
        _ => None,
    };
    let fits = |order: &Order| fixed.is_none_or(|p| order.get() == p) && cell.node_count(*order) == nodes;
    Order::all().find(fits).map_or(Type::Count, |order| Type::Complete(cell, order))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::node_order::judge;

    #[test]
    fn numbers_are_vtks() {
        for (cell, order) in judge::elements().filter(|&(_, order)| order > Order::LINEAR) {
            let Some(code) = of(cell, order) else { continue };
            assert_eq!(judge::element(cell, order)["vtk"]["type"], code, "{cell} {order}");
            assert_eq!(meaning(code.into(), cell.node_count(order)), Type::Complete(cell, order));
        }
    }
}
