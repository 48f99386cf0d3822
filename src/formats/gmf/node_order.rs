//! The order of an element's nodes, as files say it: by the coordinates of each node in the lattice of the element.
//!
//! Triangles, tetrahedra and the triangles of prisms have barycentric coordinates, one for each corner, which sum up to the order; the
//! other directions have one coordinate from 0 to the order.

use crate::element::{Cell, Order, lattice};

/// Coordinates of every node, in internal order.
pub(super) fn coordinates(cell: Cell, order: Order) -> Vec<Vec<i64>> {
    let p = order.get() as i64;
    let of_node = |&at: &[u8; 3]| {
        let [i, j, k] = at.map(i64::from);
        match cell {
            Cell::Point => vec![],
            Cell::Line => vec![i],
            Cell::Triangle => vec![p - i - j, i, j],
            Cell::Quad => vec![i, j],
            Cell::Tet => vec![p - i - j - k, i, j, k],
            Cell::Prism => vec![p - i - j, i, j, k],
            Cell::Pyramid | Cell::Hex => vec![i, j, k],
        }
    };
    lattice(cell, order).iter().map(of_node).collect()
}

/// For each node of an element in the file the node of the internal order, from the coordinates that the file gives; `None` where these
/// are not each node's once.
pub(super) fn slots(cell: Cell, order: Order, given: &[Vec<i64>]) -> Option<Vec<usize>> {
    let known = coordinates(cell, order);
    let slots: Vec<usize> = given.iter().map(|at| known.iter().position(|own| own == at)).collect::<Option<_>>()?;
    let mut sorted = slots.clone();
    sorted.sort_unstable();
    (sorted.len() == known.len() && sorted.windows(2).all(|pair| pair[0] < pair[1])).then_some(slots)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_found_by_coordinates() {
        for cell in Cell::ALL.into_iter().filter(|cell| cell.dimension() > 0) {
            for order in Order::all() {
                let mut given = coordinates(cell, order);
                assert_eq!(slots(cell, order, &given).unwrap(), (0..given.len()).collect::<Vec<_>>());
                given.reverse();
                assert_eq!(slots(cell, order, &given).unwrap()[0], given.len() - 1, "{cell} {order}");
                given[0] = given[1].clone();
                assert_eq!(slots(cell, order, &given), None, "{cell} {order}: a node twice");
            }
        }
    }
}
