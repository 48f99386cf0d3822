//! Numbers by which SU2 calls its elements, and the order of their nodes.

use crate::element::{Cell, Order, lattice};
use crate::formats::node_order::NodeOrder;
use crate::formats::vtk::{node_order, type_code};

/// Nodes row by row, from order 2 on; linear elements have VTK's order.
pub(super) static ORDER: NodeOrder = NodeOrder::new(|cell, order| {
    if order == Order::LINEAR {
        return node_order::ORDER.slots(cell, order).map(<[u8]>::to_vec);
    }
    let mut rows: Vec<u8> = (0..lattice(cell, order).len() as u8).collect();
    rows.sort_by_key(|&n| {
        let [i, j, k] = lattice(cell, order)[usize::from(n)];
        [k, j, i]
    });
    Some(rows)
});

/// What an element type number stands for: VTK's number of the linear element, with 100 more for each order beyond the first, and
/// with the order of the solution, which is of no interest here, in the ten thousands (`SU2_CFD`'s finite-element reader).
pub(super) fn meaning(code: i64) -> Option<(Cell, Order)> {
    let code = if code > 10_000 { code % 10_000 } else { code };
    let order = Order::new(usize::try_from(code / 100).ok()? + 1).ok()?;
    let is = |cell: &Cell| {
        let linear = type_code::Type::Complete(*cell, Order::LINEAR);
        type_code::meaning(code % 100, cell.corner_count()) == linear
    };
    Some((Cell::ALL.into_iter().find(is)?, order))
}

/// The type number of an element.
pub(super) fn of(cell: Cell, order: Order) -> Option<usize> {
    // VTK's classic wedge, which this program does not write for VTK.
    let linear = if cell == Cell::Prism { 13 } else { type_code::of(cell, Order::LINEAR)? };
    Some(usize::from(linear) + 100 * (order.get() - 1))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn orders_stand_in_the_hundreds() {
        let order = |p| Order::new(p).unwrap();
        assert_eq!(meaning(12), Some((Cell::Hex, order(1))));
        assert_eq!(meaning(105), Some((Cell::Triangle, order(2))));
        assert_eq!(meaning(30_310), Some((Cell::Tet, order(4))));
        for cell in Cell::ALL.into_iter().filter(|&cell| cell != Cell::Point) {
            assert!(Order::all().all(|p| meaning(of(cell, p).unwrap() as i64) == Some((cell, p))), "{cell}");
        }
        assert_eq!([meaning(7), meaning(-5), meaning(512), meaning(i64::MAX)], [None; 4]);
    }

    /// SU2 finds the corners of its elements by these places (`CPrimalGridFEM::GetCornerPointsAllFaces`).
    #[test]
    fn corners_stand_at_the_ends_of_rows() {
        for p in 2..=4 {
            let order = Order::new(p).unwrap();
            let triangle = (p + 1) * (p + 2) / 2;
            for (cell, places) in [
                (Cell::Line, vec![0, p]),
                (Cell::Triangle, vec![0, p, triangle - 1]),
                (Cell::Quad, vec![0, p, (p + 1) * (p + 1) - 1, p * (p + 1)]),
                (Cell::Tet, vec![0, p, triangle - 1, cell_nodes(Cell::Tet, order) - 1]),
                (Cell::Prism, vec![0, p, triangle - 1, p * triangle, p * triangle + p, (p + 1) * triangle - 1]),
                (Cell::Pyramid, {
                    let base = (p + 1) * (p + 1);
                    vec![0, p, base - 1, p * (p + 1), cell_nodes(Cell::Pyramid, order) - 1]
                }),
            ] {
                let slots = ORDER.slots(cell, order).unwrap();
                let found: Vec<usize> = places.iter().map(|&place| usize::from(slots[place])).collect();
                assert_eq!(found, (0..cell.corner_count()).collect::<Vec<_>>(), "{cell} {order}");
            }
        }
    }

    fn cell_nodes(cell: Cell, order: Order) -> usize {
        cell.node_count(order)
    }
}
