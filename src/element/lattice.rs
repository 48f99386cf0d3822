//! Equispaced lattices in the internal node order, which is that of CGNS (SIDS): corners, edges, faces, interior.
//!
//! SIDS words place some interior P4 nodes at centroids of sub-triangles; its figures, Gmsh and the solvers
//! use the equispaced lattice, and so does this module.

use super::{Cell, Face, Order, Tables};

/// Lattice coordinates, 0 to `p` on each axis, of an element's nodes in internal order.
///
/// Divide by `p` for the position in the unit cell. The corners come first, so the linear element's
/// connectivity is a prefix of every order's.
#[must_use]
pub fn lattice(cell: Cell, order: Order) -> &'static [[u8; 3]] {
    static TABLES: Tables<Vec<[u8; 3]>> = Tables::new();
    TABLES.get(cell, order, || build(cell, order.get() as u8))
}

/// For each node of a cell's face, in the face's own internal order, its lattice coordinates in the cell.
#[must_use]
pub fn face_lattice(cell: Cell, face: &Face, order: Order) -> Vec<[u8; 3]> {
    let p = order.get() as u8;
    lattice(face.cell, order).iter().map(|&at| embed(cell, face, p, at)).collect()
}

/// For each edge of a cell, its nodes in the order of [`Cell::Line`]: both ends, then the inner ones from the first on.
#[must_use]
pub fn edge_nodes(cell: Cell, order: Order) -> &'static [Vec<usize>] {
    static TABLES: Tables<Vec<Vec<usize>>> = Tables::new();
    TABLES.get(cell, order, || {
        let inner = order.get() - 1;
        let first = |edge: usize| cell.corner_count() + edge * inner;
        let edges = cell.edges().iter().enumerate();
        edges.map(|(e, ends)| ends.map(usize::from).into_iter().chain(first(e)..first(e) + inner).collect()).collect()
    })
}

/// For each side of a cell, in the order of [`Cell::sides`], the cell's nodes on it in the side's own internal order.
#[must_use]
pub fn side_nodes(cell: Cell, order: Order) -> &'static [Vec<usize>] {
    static TABLES: Tables<Vec<Vec<usize>>> = Tables::new();
    TABLES.get(cell, order, || {
        if cell.dimension() < 3 {
            return edge_nodes(cell, order).to_vec();
        }
        let all = lattice(cell, order);
        let place = |at: &[u8; 3]| all.iter().position(|own| own == at);
        cell.faces().iter().map(|face| face_lattice(cell, face, order).iter().filter_map(place).collect()).collect()
    })
}

fn build(cell: Cell, p: u8) -> Vec<[u8; 3]> {
    if p == 0 {
        return vec![[0, 0, 0]];
    }
    let corner = |c: u8| cell.corners()[usize::from(c)].map(|x| x * p);
    let mut nodes: Vec<[u8; 3]> = (0..cell.corner_count() as u8).map(corner).collect();
    for &[a, b] in cell.edges() {
        nodes.extend((1..p).map(|step| between(cell, p, step, a, b)));
    }
    for face in cell.faces() {
        nodes.extend(face_interior(face.cell, p).into_iter().map(|at| embed(cell, face, p, at)));
    }
    if cell.dimension() == 3 {
        nodes.extend(volume_interior(cell, p));
    }
    nodes
}

/// The lattice point `step` of `p` from corner `a` to corner `b`.
pub(crate) fn between(cell: Cell, p: u8, step: u8, a: u8, b: u8) -> [u8; 3] {
    let (from, to) = (cell.corners()[usize::from(a)], cell.corners()[usize::from(b)]);
    std::array::from_fn(|x| (p - step) * from[x] + step * to[x])
}

/// A face's lattice point `(i, j)` in the coordinates of the cell.
pub(crate) fn embed(cell: Cell, face: &Face, p: u8, [i, j, _]: [u8; 3]) -> [u8; 3] {
    let corner = |q: usize| cell.corners()[usize::from(face.corners[q])].map(i16::from);
    let (origin, first, second) = (corner(0), corner(1), corner(face.corners.len() - 1));
    let [i, j] = [i16::from(i), i16::from(j)];
    std::array::from_fn(|x| {
        let at = i16::from(p) * origin[x] + i * (first[x] - origin[x]) + j * (second[x] - origin[x]);
        at as u8
    })
}

/// Interior nodes of a triangle: the smaller triangle's lattice; of a quadrilateral: rings walked from beside
/// the first corner, the centre last.
fn face_interior(cell: Cell, p: u8) -> Vec<[u8; 3]> {
    match cell {
        Cell::Triangle if p >= 3 => shifted(build(Cell::Triangle, p - 3), [1, 1, 0]),
        Cell::Quad if p >= 2 => shifted(rings(p - 2), [1, 1, 0]),
        _ => Vec::new(),
    }
}

/// All points of the square `0..=n` by rings: each walked round once from its first corner.
fn rings(n: u8) -> Vec<[u8; 3]> {
    if n == 0 {
        return vec![[0, 0, 0]];
    }
    let mut nodes: Vec<[u8; 3]> = (0..n).map(|i| [i, 0, 0]).collect();
    nodes.extend((0..n).map(|j| [n, j, 0]));
    nodes.extend((1..=n).rev().map(|i| [i, n, 0]));
    nodes.extend((1..=n).rev().map(|j| [0, j, 0]));
    if n >= 2 {
        nodes.extend(shifted(rings(n - 2), [1, 1, 0]));
    }
    nodes
}

/// Interior nodes of a volume cell: layers in the third coordinate, each in the order of its face.
fn volume_interior(cell: Cell, p: u8) -> Vec<[u8; 3]> {
    (1..p)
        .flat_map(|k| {
            let layer = match cell {
                Cell::Hex => face_interior(Cell::Quad, p),
                Cell::Pyramid => face_interior(Cell::Quad, p - k),
                Cell::Prism => face_interior(Cell::Triangle, p),
                Cell::Tet => face_interior(Cell::Triangle, p - k),
                _ => Vec::new(),
            };
            shifted(layer, [0, 0, k])
        })
        .collect()
}

/// Lattice points moved by a number of steps on each axis.
pub(crate) fn shifted(nodes: Vec<[u8; 3]>, by: [u8; 3]) -> Vec<[u8; 3]> {
    nodes.into_iter().map(|at| std::array::from_fn(|x| at[x] + by[x])).collect()
}

#[cfg(test)]
mod tests {
    use super::super::cell::lattice_points;
    use super::*;

    #[test]
    fn every_lattice_point_stands_once() {
        for cell in Cell::ALL {
            for order in Order::all() {
                let mut ours: Vec<[usize; 3]> = lattice(cell, order).iter().map(|at| at.map(usize::from)).collect();
                let mut all: Vec<[usize; 3]> = lattice_points(cell, order.get()).collect();
                ours.sort_unstable();
                all.sort_unstable();
                assert_eq!(ours, all, "{cell} {order}");
            }
        }
    }

    #[test]
    fn a_face_carries_the_lattice_of_its_own_cell() {
        for cell in Cell::VOLUME {
            for order in Order::all() {
                for face in cell.faces() {
                    let nodes = face_lattice(cell, face, order);
                    assert!(nodes.iter().all(|at| lattice(cell, order).contains(at)), "{cell} {order}");
                    for (q, &c) in face.corners.iter().enumerate() {
                        assert_eq!(nodes[q], cell.corners()[usize::from(c)].map(|x| x * order.get() as u8));
                    }
                }
            }
        }
    }
}
