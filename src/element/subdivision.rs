//! The linear sub-elements of a high-order element, as corner simplices of lattice nodes: tetrahedra, of plane cells triangles.
//!
//! A tet of order p falls into `p^3` linear tets, of which the octahedra inside can be cut along any of three
//! diagonals: in a viscous layer the one that touches the layer-normal edge is always wrong
//! (`docs/theory.md`, section 2), so all three cuts are offered and the caller takes, per element, the one whose worst
//! sub-tet is best. Hexes, prisms and pyramids give a tetrahedron at each corner of each linear sub-element (the
//! pyramids' at the four corners of the base: an apex has no corner tetrahedron).
//!
//! A triangle falls into `p^2` triangles, in one way only; a quadrilateral gives a triangle at each corner of each of its `p^2`. A corner
//! triangle is written as a tetrahedron that ends at its first node.

use super::cell::lattice_points;
use super::{Cell, Order, Tables, lattice};

/// Corner simplices (local nodes) of an element's sub-elements; one list per way to cut the element.
#[must_use]
pub fn corner_simplices(cell: Cell, order: Order) -> &'static [Vec<[u8; 4]>] {
    static TABLES: Tables<Cuts> = Tables::new();
    TABLES.get(cell, order, || match cell {
        Cell::Triangle => vec![subcells(cell, order, &TRIANGLE_ENDS)],
        Cell::Quad => vec![subcells(cell, order, &QUAD_CORNERS)],
        Cell::Tet => (0..3).map(|diagonal| tet(order, diagonal)).collect(),
        Cell::Pyramid => vec![subcells(cell, order, &PYRAMID_CORNERS)],
        Cell::Prism => vec![prism(order)],
        Cell::Hex => vec![subcells(cell, order, &hex_corners())],
        _ => Vec::new(),
    })
}

/// The nodes of a corner simplex, each once.
#[must_use]
pub fn simplex_nodes(simplex: &[u8; 4]) -> &[u8] {
    if simplex[0] == simplex[3] { &simplex[..3] } else { simplex }
}

/// The lists of corner simplices of one cell, one a way to cut it.
type Cuts = Vec<Vec<[u8; 4]>>;

/// Offsets of a corner simplex from the lattice point of its sub-element.
type Offsets = [[usize; 3]; 4];

/// Upright and inverted sub-triangles.
const TRIANGLE_ENDS: [Offsets; 2] =
    [[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]], [[1, 1, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]];

const QUAD_CORNERS: [Offsets; 4] = [
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0]],
    [[1, 0, 0], [1, 1, 0], [0, 0, 0], [1, 0, 0]],
    [[1, 1, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]],
    [[0, 1, 0], [0, 0, 0], [1, 1, 0], [0, 1, 0]],
];

/// Upright and inverted sub-tets.
const TET_ENDS: [Offsets; 2] =
    [[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1, 1, 0], [1, 0, 1], [0, 1, 1], [1, 1, 1]]];

/// The octahedron's corners, opposite ones in pairs: its three diagonals.
const OCTAHEDRON: [[[usize; 3]; 2]; 3] = [[[1, 0, 0], [0, 1, 1]], [[0, 1, 0], [1, 0, 1]], [[0, 0, 1], [1, 1, 0]]];

const PYRAMID_CORNERS: [Offsets; 4] = [
    [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    [[1, 0, 0], [0, 0, 0], [1, 1, 0], [0, 0, 1]],
    [[0, 1, 0], [1, 1, 0], [0, 0, 0], [0, 0, 1]],
    [[1, 1, 0], [0, 1, 0], [1, 0, 0], [0, 0, 1]],
];

fn hex_corners() -> Vec<Offsets> {
    let flip = |at: [usize; 3], axis: usize| -> [usize; 3] {
        std::array::from_fn(|a| if a == axis { 1 - at[a] } else { at[a] })
    };
    (0..8)
        .map(|corner: usize| {
            let at = [corner & 1, corner >> 1 & 1, corner >> 2];
            [at, flip(at, 0), flip(at, 1), flip(at, 2)]
        })
        .collect()
}

fn tet(order: Order, diagonal: usize) -> Vec<[u8; 4]> {
    let [from, to] = OCTAHEDRON[diagonal];
    let [[a, c], [b, d]] = [OCTAHEDRON[(diagonal + 1) % 3], OCTAHEDRON[(diagonal + 2) % 3]];
    let ring = [a, b, c, d];
    let wedges = (0..4).map(|q| [from, to, ring[q], ring[(q + 1) % 4]]);
    let offsets: Vec<Offsets> = TET_ENDS.into_iter().chain(wedges).collect();
    subcells(Cell::Tet, order, &offsets)
}

/// Corner tets of the upright and the inverted sub-prisms.
fn prism(order: Order) -> Vec<[u8; 4]> {
    let triangles = [[[0, 0], [1, 0], [0, 1]], [[1, 1], [0, 1], [1, 0]]];
    let mut offsets = Vec::new();
    for triangle in triangles {
        for q in 0..3 {
            for level in 0..2 {
                let at = |corner: usize, k: usize| {
                    let [i, j] = triangle[corner % 3];
                    [i, j, k]
                };
                offsets.push([at(q, level), at(q + 1, level), at(q + 2, level), at(q, 1 - level)]);
            }
        }
    }
    // A sub-prism needs all its six corners, not only those of one corner tet.
    whole_subcells(Cell::Prism, order, &offsets, 6)
}

fn subcells(cell: Cell, order: Order, offsets: &[Offsets]) -> Vec<[u8; 4]> {
    let whole = match cell {
        Cell::Hex => 8,
        Cell::Quad | Cell::Pyramid => 4,
        _ => 1,
    };
    whole_subcells(cell, order, offsets, whole)
}

/// The corner simplices at every lattice point, taken in runs of `whole`: a run counts where all its nodes exist.
fn whole_subcells(cell: Cell, order: Order, offsets: &[Offsets], whole: usize) -> Vec<[u8; 4]> {
    let nodes = lattice(cell, order);
    let find = |at: [usize; 3]| nodes.iter().position(|n| n.map(usize::from) == at).map(|n| n as u8);
    let mut tets = Vec::new();
    for origin in lattice_points(cell, order.get()) {
        for run in offsets.chunks(whole) {
            let placed = run.iter().map(|tet| {
                let corners = tet.map(|offset| find(std::array::from_fn(|a| origin[a] + offset[a])));
                let [a, b, c, d] = corners;
                Some([a?, b?, c?, d?])
            });
            if let Some(placed) = placed.collect::<Option<Vec<[u8; 4]>>>() {
                tets.extend(placed);
            }
        }
    }
    tets
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(cell: Cell, order: Order, tet: [u8; 4]) -> f64 {
        let at = |n: u8| glam::DVec3::from(lattice(cell, order)[usize::from(n)].map(f64::from));
        let [o, a, b, c] = tet.map(at);
        ((a - o).cross(b - o).dot(c - o) / 6.0 / (order.get() as f64).powi(3)).abs()
    }

    #[test]
    fn the_sub_tets_of_a_tet_fill_it_whatever_the_cut() {
        for order in Order::all() {
            for cut in corner_simplices(Cell::Tet, order) {
                assert_eq!(cut.len(), order.get().pow(3));
                let sum: f64 = cut.iter().map(|&t| volume(Cell::Tet, order, t)).sum();
                assert!((sum - 1.0 / 6.0).abs() < 1e-14, "{order}: {sum}");
            }
        }
    }

    #[test]
    fn plane_cells_have_their_triangles_all_turning_one_way() {
        for order in Order::all() {
            let p = order.get();
            for (cell, count) in [(Cell::Triangle, p * p), (Cell::Quad, 4 * p * p)] {
                let corners = &corner_simplices(cell, order)[0];
                let nodes = lattice(cell, order);
                let at = |n: u8| glam::DVec3::from(nodes[usize::from(n)].map(f64::from));
                let turn = |&[o, a, b, end]: &[u8; 4]| ((at(a) - at(o)).cross(at(b) - at(o)).z, end == o);
                assert!(corners.iter().map(turn).all(|own| own == (1.0, true)), "{cell} {order}");
                assert_eq!(corners.len(), count);
            }
        }
    }

    #[test]
    fn other_cells_have_a_tet_at_each_corner_of_each_sub_element() {
        for order in Order::all() {
            let p = order.get();
            let count = |cell: Cell| corner_simplices(cell, order)[0].len();
            assert_eq!(count(Cell::Hex), 8 * p.pow(3));
            assert_eq!(count(Cell::Prism), 6 * p.pow(3));
            assert_eq!(count(Cell::Pyramid), 4 * (1..=p).map(|m| m * m).sum::<usize>());
            for cell in [Cell::Hex, Cell::Prism, Cell::Pyramid] {
                assert!(corner_simplices(cell, order)[0].iter().all(|&t| volume(cell, order, t) > 1e-6), "{cell}");
            }
        }
    }
}
