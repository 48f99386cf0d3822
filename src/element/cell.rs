//! The table of cells: the only place where a cell is spelled out.

use std::fmt;

use serde::{Deserialize, Serialize};

/// Polynomial order of a mesh, 1 to [`Order::MAX`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct Order(u8);

impl Order {
    /// The straight-sided mesh that generators write.
    pub const LINEAR: Order = Order(1);
    /// The highest order: CGNS and the solvers stop here.
    pub const MAX: Order = Order(4);

    /// An order from a number.
    ///
    /// # Errors
    /// [`OrderOutOfRange`] outside 1 to [`Order::MAX`].
    pub fn new(p: usize) -> Result<Order, OrderOutOfRange> {
        let known = (Order::LINEAR.get()..=Order::MAX.get()).contains(&p);
        if known { Ok(Order(p as u8)) } else { Err(OrderOutOfRange(p)) }
    }

    /// The order as a number.
    #[must_use]
    pub const fn get(self) -> usize {
        self.0 as usize
    }

    /// All orders, rising.
    pub fn all() -> impl Iterator<Item = Order> {
        (Order::LINEAR.0..=Order::MAX.0).map(Order)
    }
}

impl TryFrom<u8> for Order {
    type Error = OrderOutOfRange;
    fn try_from(p: u8) -> Result<Order, OrderOutOfRange> {
        Order::new(usize::from(p))
    }
}

impl From<Order> for u8 {
    fn from(order: Order) -> u8 {
        order.0
    }
}

impl Default for Order {
    fn default() -> Order {
        Order::LINEAR
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "P{}", self.0)
    }
}

/// A polynomial order that there is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("polynomial order {0} is outside 1 to {max}", max = Order::MAX.get())]
pub struct OrderOutOfRange(pub usize);

/// The shapes of mesh elements, of every dimension.
///
/// The unit cell of each has its corners at 0 and 1 (see [`Cell::corners`]); the pyramid is the oblique one
/// with the apex above its first corner, as in the CGNS and Gmsh tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cell {
    /// A single node.
    Point,
    /// A segment.
    Line,
    /// A triangle.
    Triangle,
    /// A quadrilateral.
    Quad,
    /// A tetrahedron.
    Tet,
    /// A pyramid on a quadrilateral.
    Pyramid,
    /// A triangular prism.
    Prism,
    /// A hexahedron.
    Hex,
}

/// One face of a cell: its shape, and its corners in the loop in which CGNS stores the face's nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Triangle or quadrilateral.
    pub cell: Cell,
    /// Local corners of the loop.
    pub corners: &'static [u8],
    /// Whether the loop's normal points out of the cell; CGNS stores each cell's first face the other way.
    pub outward: bool,
}

/// What the table says of one cell.
struct Definition {
    name: &'static str,
    dimension: usize,
    /// Corners of the unit cell.
    corners: &'static [[u8; 3]],
    /// Corner pairs in CGNS storage order and direction.
    edges: &'static [[u8; 2]],
    /// Faces in CGNS storage order.
    faces: &'static [Face],
    /// Which axes are bounded together: `i + j <= p` (triangle-like) rather than each alone.
    bound: Bound,
}

/// The inequality that bounds a cell's lattice beside `0 <= i, j, k <= p`.
#[derive(Clone, Copy)]
enum Bound {
    /// Each axis alone.
    Box,
    /// `i + j + k <= p`.
    Sum,
    /// `i + j <= p`.
    Base,
    /// `i + k <= p` and `j + k <= p`.
    Apex,
}

const fn tri(corners: &'static [u8]) -> Face {
    Face { cell: Cell::Triangle, corners, outward: true }
}

const fn quad(corners: &'static [u8]) -> Face {
    Face { cell: Cell::Quad, corners, outward: true }
}

const fn inward(face: Face) -> Face {
    Face { outward: false, ..face }
}

static POINT: Definition =
    Definition { name: "point", dimension: 0, corners: &[[0, 0, 0]], edges: &[], faces: &[], bound: Bound::Sum };

static LINE: Definition = Definition {
    name: "line",
    dimension: 1,
    corners: &[[0, 0, 0], [1, 0, 0]],
    edges: &[[0, 1]],
    faces: &[],
    bound: Bound::Sum,
};

static TRIANGLE: Definition = Definition {
    name: "triangle",
    dimension: 2,
    corners: &[[0, 0, 0], [1, 0, 0], [0, 1, 0]],
    edges: &[[0, 1], [1, 2], [2, 0]],
    faces: &[tri(&[0, 1, 2])],
    bound: Bound::Sum,
};

static QUAD: Definition = Definition {
    name: "quad",
    dimension: 2,
    corners: &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0]],
    faces: &[quad(&[0, 1, 2, 3])],
    bound: Bound::Box,
};

static TET: Definition = Definition {
    name: "tet",
    dimension: 3,
    corners: &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    edges: &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
    faces: &[inward(tri(&[0, 1, 2])), tri(&[0, 1, 3]), tri(&[1, 2, 3]), tri(&[2, 0, 3])],
    bound: Bound::Sum,
};

static PYRAMID: Definition = Definition {
    name: "pyramid",
    dimension: 3,
    corners: &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1]],
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
    faces: &[inward(quad(&[0, 1, 2, 3])), tri(&[0, 1, 4]), tri(&[1, 2, 4]), tri(&[2, 3, 4]), tri(&[3, 0, 4])],
    bound: Bound::Apex,
};

static PRISM: Definition = Definition {
    name: "prism",
    dimension: 3,
    corners: &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
    edges: &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 4], [2, 5], [3, 4], [4, 5], [5, 3]],
    faces: &[inward(tri(&[0, 1, 2])), quad(&[0, 1, 4, 3]), quad(&[1, 2, 5, 4]), quad(&[2, 0, 3, 5]), tri(&[3, 4, 5])],
    bound: Bound::Base,
};

static HEX: Definition = Definition {
    name: "hex",
    dimension: 3,
    corners: &[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 5], [2, 6], [3, 7], [4, 5], [5, 6], [6, 7], [7, 4]],
    faces: &[
        inward(quad(&[0, 1, 2, 3])),
        quad(&[0, 1, 5, 4]),
        quad(&[1, 2, 6, 5]),
        quad(&[2, 3, 7, 6]),
        quad(&[3, 0, 4, 7]),
        quad(&[4, 5, 6, 7]),
    ],
    bound: Bound::Box,
};

impl Cell {
    /// All cells, by rising dimension.
    pub const ALL: [Cell; 8] =
        [Cell::Point, Cell::Line, Cell::Triangle, Cell::Quad, Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex];

    /// The cells that fill a part of a plane.
    pub const FLAT: [Cell; 2] = [Cell::Triangle, Cell::Quad];

    /// The cells of meshes that can be curved.
    pub const CURVABLE: [Cell; 6] = [Cell::Triangle, Cell::Quad, Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex];

    /// The cells that fill a volume.
    pub const VOLUME: [Cell; 4] = [Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex];

    fn definition(self) -> &'static Definition {
        match self {
            Cell::Point => &POINT,
            Cell::Line => &LINE,
            Cell::Triangle => &TRIANGLE,
            Cell::Quad => &QUAD,
            Cell::Tet => &TET,
            Cell::Pyramid => &PYRAMID,
            Cell::Prism => &PRISM,
            Cell::Hex => &HEX,
        }
    }

    /// The field's word for the cell: `tet`, `pyramid`, `prism`, `hex`, ...
    #[must_use]
    pub fn name(self) -> &'static str {
        self.definition().name
    }

    /// Dimension of the cell itself, 0 to 3.
    #[must_use]
    pub fn dimension(self) -> usize {
        self.definition().dimension
    }

    /// Whether it is a cell of plane meshes: a triangle or quadrilateral.
    #[must_use]
    pub fn is_flat(self) -> bool {
        self.dimension() == 2
    }

    /// Whether its map has a Jacobian determinant: a volume's has, a face's with one vector that stands on it, a line's with two.
    #[must_use]
    pub fn has_jacobian(self, vectors: usize) -> bool {
        self.dimension() + vectors == 3
    }

    /// Corners of the unit cell, each coordinate 0 or 1.
    #[must_use]
    pub fn corners(self) -> &'static [[u8; 3]] {
        self.definition().corners
    }

    /// Number of corners: nodes of the linear element.
    #[must_use]
    pub fn corner_count(self) -> usize {
        self.corners().len()
    }

    /// Corner pairs of the edges, in CGNS storage order and direction.
    #[must_use]
    pub fn edges(self) -> &'static [[u8; 2]] {
        self.definition().edges
    }

    /// Faces in CGNS storage order; a triangle or quadrilateral has itself as its one face.
    #[must_use]
    pub fn faces(self) -> &'static [Face] {
        self.definition().faces
    }

    /// Local corners of the sides, the cells of one dimension less that bound it: the faces of a volume, the edges of a face.
    pub fn sides(self) -> impl Iterator<Item = &'static [u8]> {
        let dimension = self.dimension();
        let faces = self.faces().iter().filter(move |_| dimension == 3).map(|face| face.corners);
        let edges = self.edges().iter().filter(move |_| dimension == 2).map(|edge| &edge[..]);
        faces.chain(edges)
    }

    /// Whether cells of this kind can stand one on another in a column: two of its sides share no corner.
    #[must_use]
    pub fn stacks(self) -> bool {
        let apart = |a: &[u8], b: &[u8]| a.iter().all(|corner| !b.contains(corner));
        self.sides().any(|one| self.sides().any(|other| apart(one, other)))
    }

    /// Number of nodes of the element of order `p`.
    #[must_use]
    pub fn node_count(self, order: Order) -> usize {
        // Readers ask this of every element: counting the lattice would cost them a third of their time.
        let definition = self.definition();
        let n = order.get() + 1;
        match definition.bound {
            Bound::Box => (0..definition.dimension).fold(1, |count, _| count * n),
            Bound::Sum => (0..definition.dimension).fold(1, |count, k| count * (n + k) / (k + 1)),
            Bound::Base => n * n * (n + 1) / 2,
            Bound::Apex => n * (n + 1) * (2 * n + 1) / 6,
        }
    }

    /// Whether the lattice of `n` divisions an edge has a point at `(i, j, k)`.
    #[must_use]
    pub fn holds(self, n: usize, [i, j, k]: [usize; 3]) -> bool {
        let definition = self.definition();
        let axes = [i, j, k];
        if axes.iter().any(|&x| x > n) || axes[definition.dimension..].iter().any(|&x| x > 0) {
            return false;
        }
        match definition.bound {
            Bound::Box => true,
            Bound::Sum => i + j + k <= n,
            Bound::Base => i + j <= n,
            Bound::Apex => i + k <= n && j + k <= n,
        }
    }
}

/// All lattice points of `n` divisions an edge, first coordinate fastest.
pub(super) fn lattice_points(cell: Cell, n: usize) -> impl Iterator<Item = [usize; 3]> {
    let axis = 0..=n;
    axis.clone()
        .flat_map(move |k| (0..=n).flat_map(move |j| (0..=n).map(move |i| [i, j, k])))
        .filter(move |&at| cell.holds(n, at))
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_with_two_sides_apart_stack() {
        let stack: Vec<Cell> = Cell::ALL.into_iter().filter(|cell| cell.stacks()).collect();
        assert_eq!(stack, [Cell::Quad, Cell::Prism, Cell::Hex]);
    }

    #[test]
    fn the_table_proves_itself() {
        for cell in Cell::VOLUME {
            let (corners, edges, faces) = (cell.corners(), cell.edges(), cell.faces());
            assert_eq!(corners.len() + faces.len(), edges.len() + 2, "Euler: {cell}");
            for &[a, b] in edges {
                let shared = faces
                    .iter()
                    .filter(|f| {
                        let n = f.corners.len();
                        (0..n).any(|q| {
                            let pair = [f.corners[q], f.corners[(q + 1) % n]];
                            pair == [a, b] || pair == [b, a]
                        })
                    })
                    .count();
                assert_eq!(shared, 2, "{cell}: edge {a}-{b} bounds two faces");
            }
            for face in faces {
                assert_eq!(face.corners.len(), face.cell.corner_count());
                assert_eq!(face.outward, normal_points_out(cell, face), "{cell}: {:?}", face.corners);
            }
        }
    }

    fn normal_points_out(cell: Cell, face: &Face) -> bool {
        let at = |c: u8| glam::DVec3::from(cell.corners()[usize::from(c)].map(f64::from));
        let middle = (0..cell.corner_count()).map(|c| at(c as u8)).sum::<glam::DVec3>() / cell.corner_count() as f64;
        let [a, b, c] = [at(face.corners[0]), at(face.corners[1]), at(face.corners[2])];
        (b - a).cross(c - a).dot(a - middle) > 0.0
    }

    #[test]
    fn node_counts_are_those_of_the_cgns_element_names() {
        let counts = |cell: Cell| Order::all().map(|p| cell.node_count(p)).collect::<Vec<_>>();
        for cell in Cell::ALL {
            let lattice = Order::all().map(|p| lattice_points(cell, p.get()).count());
            assert!(lattice.eq(counts(cell)), "{cell}");
        }
        assert_eq!(counts(Cell::Point), [1, 1, 1, 1]);
        assert_eq!(counts(Cell::Line), [2, 3, 4, 5]);
        assert_eq!(counts(Cell::Triangle), [3, 6, 10, 15]);
        assert_eq!(counts(Cell::Quad), [4, 9, 16, 25]);
        assert_eq!(counts(Cell::Tet), [4, 10, 20, 35]);
        assert_eq!(counts(Cell::Pyramid), [5, 14, 30, 55]);
        assert_eq!(counts(Cell::Prism), [6, 18, 40, 75]);
        assert_eq!(counts(Cell::Hex), [8, 27, 64, 125]);
    }

    #[test]
    fn orders_outside_1_to_4_are_refused() {
        assert_eq!(Order::new(0), Err(OrderOutOfRange(0)));
        assert_eq!(Order::new(5), Err(OrderOutOfRange(5)));
        assert!(Order::all().all(|p| Order::new(p.get()) == Ok(p)));
    }
}
