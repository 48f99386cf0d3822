//! How the interior nodes of a face or edge, as one element sees it, stand in the order of its other owners.

use super::{Cell, Order, lattice};

/// The canonical order of a face's corners: the smallest first, then towards its smaller neighbour.
///
/// Returns positions in `corners`; for an edge the smaller end comes first.
#[must_use]
pub fn canonical<T: Ord + Copy>(corners: &[T]) -> [u8; 4] {
    let n = corners.len();
    if let &[a, b] = corners {
        return around(2, usize::from(b < a), true);
    }
    let first = (0..n).min_by_key(|&q| corners[q]).unwrap_or(0);
    let (next, previous) = ((first + 1) % n, (first + n - 1) % n);
    around(n, first, corners[next] < corners[previous])
}

/// The positions of `n` corners from the first on, one way round or the other, and over again.
fn around(n: usize, first: usize, forward: bool) -> [u8; 4] {
    let step = if forward || n < 3 { 1 } else { n - 1 };
    let mut at = first;
    std::array::from_fn(|_| {
        let position = at as u8;
        at += step;
        at -= if at >= n { n } else { 0 };
        position
    })
}

/// For each interior node of a line, triangle or quadrilateral in its own internal order: its place among the
/// interior nodes of the same cell with corners in the order `seen` (positions in the cell's own corners).
#[must_use]
pub fn interior_slots(cell: Cell, order: Order, seen: [u8; 4]) -> Vec<usize> {
    let p = order.get() as i16;
    let nodes = lattice(cell, order);
    let corners = cell.corner_count();
    let interior = &nodes[interior_start(cell, order)..];
    let corner = |q: u8| cell.corners()[usize::from(q)].map(|x| i16::from(x) * p);
    let origin = corner(seen[0]);
    let axes: Vec<[i16; 3]> = match corners {
        2 => vec![corner(seen[1])],
        _ => vec![corner(seen[1]), corner(seen[corners - 1])],
    };
    interior
        .iter()
        .map(|node| {
            let at = node.map(i16::from);
            let place = if corners == 4 { along(at, origin, &axes, p) } else { weights(at, p, &seen[..corners]) };
            interior.iter().position(|other| other.map(i16::from) == place).unwrap_or_default()
        })
        .collect()
}

/// [`interior_slots`] of one cell and order, for all ways in which its corners can be seen.
#[derive(Clone, Debug)]
pub struct InteriorSlots {
    /// By the first two corners as they are seen: they determine the others.
    known: [[Vec<usize>; 4]; 4],
}

impl InteriorSlots {
    /// The slots of a line, triangle or quadrilateral; none for other cells.
    #[must_use]
    pub fn new(cell: Cell, order: Order) -> InteriorSlots {
        let corners = cell.corner_count();
        let mut known: [[Vec<usize>; 4]; 4] = Default::default();
        for first in (0..corners).filter(|_| matches!(cell.dimension(), 1 | 2)) {
            for forward in [true, false] {
                let seen = around(corners, first, forward);
                known[usize::from(seen[0])][usize::from(seen[1])] = interior_slots(cell, order, seen);
            }
        }
        InteriorSlots { known }
    }

    /// The slots for corners in the order `seen`.
    #[must_use]
    pub fn of(&self, seen: [u8; 4]) -> &[usize] {
        &self.known[usize::from(seen[0])][usize::from(seen[1])]
    }
}

/// The nodes of an element with its first two axes exchanged: the same shape, turned the other way round.
///
/// Slot `n` of the turned element holds node `mirrored[n]` of the given one.
#[must_use]
pub fn mirrored(cell: Cell, order: Order) -> Vec<u8> {
    let nodes = lattice(cell, order);
    let exchanged = |&[i, j, k]: &[u8; 3]| nodes.iter().position(|&at| at == [j, i, k]).unwrap_or_default() as u8;
    nodes.iter().map(exchanged).collect()
}

/// Number of an element's nodes before those of its interior.
#[must_use]
pub fn interior_start(cell: Cell, order: Order) -> usize {
    cell.node_count(order) - interior_count(cell, order)
}

/// Number of nodes inside an element, on none of its corners, edges or faces.
#[must_use]
pub fn interior_count(cell: Cell, order: Order) -> usize {
    let p = order.get();
    let inside = |at: &&[u8; 3]| {
        let at = at.map(usize::from);
        let axes = cell.dimension();
        // One step outward along every axis and along every bound must leave room: p more divisions hold the point
        // moved by one in all axes, and none is zero.
        at[..axes].iter().all(|&x| x > 0) && strictly_inside(cell, p, at)
    };
    if cell.dimension() == 0 { 0 } else { lattice(cell, order).iter().filter(inside).count() }
}

fn strictly_inside(cell: Cell, p: usize, at: [usize; 3]) -> bool {
    (0..cell.dimension()).all(|axis| {
        let mut further = at;
        further[axis] += 1;
        cell.holds(p, further)
    })
}

/// Coordinates of `at` in the square whose origin and axes' ends are given.
fn along(at: [i16; 3], origin: [i16; 3], ends: &[[i16; 3]], p: i16) -> [i16; 3] {
    let mut place = [0; 3];
    for (x, end) in place.iter_mut().zip(ends) {
        *x = (0..3).map(|a| (at[a] - origin[a]) * (end[a] - origin[a])).sum::<i16>() / p;
    }
    place
}

/// Lattice coordinates in the simplex with its corners taken in the order `seen`.
fn weights(at: [i16; 3], p: i16, seen: &[u8]) -> [i16; 3] {
    let own = [p - at[0] - at[1] - at[2], at[0], at[1]];
    let mut place = [0; 3];
    for (x, &q) in place.iter_mut().zip(&seen[1..]) {
        *x = own[usize::from(q)];
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn canonical_corners_start_at_the_smallest() {
        assert_eq!(canonical(&[7, 3])[..2], [1, 0]);
        assert_eq!(canonical(&[5, 2, 9])[..3], [1, 0, 2]);
        assert_eq!(canonical(&[5, 9, 2])[..3], [2, 0, 1]);
        assert_eq!(canonical(&[4, 8, 6, 1]), [3, 0, 1, 2]);
        assert_eq!(canonical(&[8, 4, 1, 6]), [2, 1, 0, 3]);
    }

    /// Two owners of a face, each with its own first corner and direction, must agree where each node lies.
    #[test]
    fn owners_agree_on_the_place_of_every_node() {
        for (cell, loops) in [
            (Cell::Line, vec![vec![0, 1], vec![1, 0]]),
            (Cell::Triangle, vec![vec![0, 1, 2], vec![2, 1, 0], vec![1, 2, 0], vec![0, 2, 1]]),
            (Cell::Quad, vec![vec![0, 1, 2, 3], vec![2, 1, 0, 3], vec![3, 0, 1, 2], vec![1, 0, 3, 2]]),
        ] {
            let unit: Vec<DVec3> = cell.corners().iter().map(|c| DVec3::from(c.map(f64::from))).collect();
            for order in Order::all() {
                let place = |corners: &[usize], node: usize| -> DVec3 {
                    let at = lattice(cell, order)[interior_start(cell, order) + node].map(f64::from);
                    let weights = super::super::basis::values(cell, Order::LINEAR, at.map(|x| x / order.get() as f64));
                    corners.iter().zip(weights).map(|(&c, w)| unit[c] * w).sum()
                };
                for corners in &loops {
                    let seen = canonical(corners);
                    let shared: Vec<usize> = seen[..corners.len()].iter().map(|&q| corners[usize::from(q)]).collect();
                    for (node, slot) in interior_slots(cell, order, seen).into_iter().enumerate() {
                        assert!(place(corners, node).distance(place(&shared, slot)) < 1e-12, "{cell} {order}");
                    }
                }
            }
        }
    }

    #[test]
    fn interior_counts() {
        let counts = |cell: Cell| Order::all().map(|p| interior_count(cell, p)).collect::<Vec<_>>();
        assert_eq!(counts(Cell::Line), [0, 1, 2, 3]);
        assert_eq!(counts(Cell::Triangle), [0, 0, 1, 3]);
        assert_eq!(counts(Cell::Quad), [0, 1, 4, 9]);
        assert_eq!(counts(Cell::Tet), [0, 0, 0, 1]);
        assert_eq!(counts(Cell::Pyramid), [0, 0, 1, 5]);
        assert_eq!(counts(Cell::Prism), [0, 0, 2, 9]);
        assert_eq!(counts(Cell::Hex), [0, 1, 8, 27]);
    }
}
