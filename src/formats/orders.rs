//! Node orders by name, for programs that take elements from memory: those of formats, and those of libraries that have no format of
//! their own, or one that numbers nodes otherwise than its elements do.

use super::node_order::NodeOrder;
use super::{mfem, msh, vtk};
use crate::element::{Cell, Face, Order, between, embed, interior_start, lattice};

/// Who orders the nodes of an element so, and the order.
pub struct NamedOrder {
    /// The word that chooses it.
    pub name: &'static str,
    /// What it is, in one line.
    pub title: &'static str,
    order: &'static NodeOrder,
}

/// All orders that have a name, the internal one first.
pub static NODE_ORDERS: [NamedOrder; 6] = [
    NamedOrder { name: "cgns", title: "corners, edges, faces, interior, as CGNS (SIDS) has them", order: &CGNS },
    NamedOrder { name: "lexicographic", title: "row by row, the first axis fastest", order: &LEXICOGRAPHIC },
    NamedOrder { name: "gmsh", title: "that of MSH files", order: &msh::node_order::ORDER },
    NamedOrder { name: "vtk", title: "that of VTK's Lagrange cells", order: &vtk::node_order::ORDER },
    NamedOrder { name: "basix", title: "that of Basix and DOLFINx", order: &BASIX },
    NamedOrder { name: "mfem", title: "that of MFEM's continuous elements", order: &MFEM },
];

impl NamedOrder {
    /// The order of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static NamedOrder> {
        NODE_ORDERS.iter().find(|own| own.name == name)
    }

    /// For each slot of an element in this order, the node of the internal order that it holds; `None` where there is no such element.
    #[must_use]
    pub fn slots(&self, cell: Cell, order: Order) -> Option<&'static [u8]> {
        self.order.slots(cell, order)
    }
}

static CGNS: NodeOrder = NodeOrder::new(|cell, order| Some((0..cell.node_count(order) as u8).collect()));

static LEXICOGRAPHIC: NodeOrder = NodeOrder::new(|cell, order| {
    let mut points = lattice(cell, order).to_vec();
    points.sort_unstable_by_key(first_axis_fastest);
    Some(slots(&points, cell, order))
});

static BASIX: NodeOrder = NodeOrder::new(|cell, order| Some(BASIX_RULES.slots(cell, order)));

/// MFEM's pyramids beyond P1 are of another space, with other nodes.
static MFEM: NodeOrder = NodeOrder::new(|cell, order| {
    (cell != Cell::Pyramid || order == Order::LINEAR).then(|| MFEM_RULES.slots(cell, order))
});

fn slots(points: &[[u8; 3]], cell: Cell, order: Order) -> Vec<u8> {
    let internal = lattice(cell, order);
    points.iter().filter_map(|at| internal.iter().position(|own| own == at)).map(|node| node as u8).collect()
}

fn first_axis_fastest(&[i, j, k]: &[u8; 3]) -> [u8; 3] {
    [k, j, i]
}

/// A library's reference elements, by what follows what in a cell: corners, then the nodes inside each edge, each face and the cell, each
/// inside row by row, the first axis fastest.
struct Rules(fn(Cell) -> Entities);

/// The corners, edges and faces of one cell in a library's sequence, by their internal corners.
struct Entities {
    corners: &'static [u8],
    /// Ends, from the first node on.
    edges: &'static [[u8; 2]],
    /// Loops, from the face's origin along its first axis; a quadrilateral's last corner is the end of its second axis.
    faces: &'static [&'static [u8]],
}

impl Rules {
    /// The permutation of an element's nodes.
    fn slots(&self, cell: Cell, order: Order) -> Vec<u8> {
        let p = order.get() as u8;
        let own = (self.0)(cell);
        let corner = |&c: &u8| cell.corners()[usize::from(c)].map(|x| x * p);
        let mut nodes: Vec<[u8; 3]> = own.corners.iter().map(corner).collect();
        for &[a, b] in own.edges {
            nodes.extend((1..p).map(|step| between(cell, p, step, a, b)));
        }
        for &corners in own.faces {
            let shape = if corners.len() == 3 { Cell::Triangle } else { Cell::Quad };
            let face = Face { cell: shape, corners, outward: true };
            nodes.extend(inside(shape, order).into_iter().map(|at| embed(cell, &face, p, at)));
        }
        if cell.dimension() > 1 {
            nodes.extend(inside(cell, order));
        }
        slots(&nodes, cell, order)
    }
}

/// The nodes inside a cell, on none of its corners, edges and faces.
fn inside(cell: Cell, order: Order) -> Vec<[u8; 3]> {
    let mut nodes = lattice(cell, order)[interior_start(cell, order)..].to_vec();
    nodes.sort_unstable_by_key(first_axis_fastest);
    nodes
}

/// The constructors in MFEM's `fem/fe/fe_h1.cpp`.
static MFEM_RULES: Rules = Rules(|cell| {
    let own = mfem::geometry_of(cell);
    Entities { corners: &[0, 1, 2, 3, 4, 5, 6, 7][..cell.corner_count()], edges: own.edges, faces: own.faces }
});

/// `basix.topology`, `basix.geometry` and `basix.create_lattice`: corners by their coordinates, edges and faces by their corners.
static BASIX_RULES: Rules = Rules(basix_entities);

fn basix_entities(cell: Cell) -> Entities {
    let entities = |corners, edges, faces| Entities { corners, edges, faces };
    match cell {
        Cell::Point => entities(&[0], &[], &[]),
        Cell::Line => entities(&[0, 1], &[[0, 1]], &[]),
        Cell::Triangle => entities(&[0, 1, 2], &[[1, 2], [0, 2], [0, 1]], &[]),
        Cell::Quad => entities(&[0, 1, 3, 2], &[[0, 1], [0, 3], [1, 2], [3, 2]], &[]),
        Cell::Tet => entities(
            &[0, 1, 2, 3],
            &[[2, 3], [1, 3], [1, 2], [0, 3], [0, 2], [0, 1]],
            &[&[1, 2, 3], &[0, 2, 3], &[0, 1, 3], &[0, 1, 2]],
        ),
        Cell::Pyramid => entities(
            &[0, 1, 3, 2, 4],
            &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 4], [3, 2], [3, 4], [2, 4]],
            &[&[0, 1, 2, 3], &[0, 1, 4], &[0, 3, 4], &[1, 2, 4], &[3, 2, 4]],
        ),
        Cell::Prism => entities(
            &[0, 1, 2, 3, 4, 5],
            &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [3, 5], [4, 5]],
            &[&[0, 1, 2], &[0, 1, 4, 3], &[0, 2, 5, 3], &[1, 2, 5, 4], &[3, 4, 5]],
        ),
        Cell::Hex => entities(
            &[0, 1, 3, 2, 4, 5, 7, 6],
            &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [3, 2], [3, 7], [2, 6], [4, 5], [4, 7], [5, 6], [7, 6]],
            &[&[0, 1, 2, 3], &[0, 1, 5, 4], &[0, 3, 7, 4], &[1, 2, 6, 5], &[3, 2, 6, 7], &[4, 5, 6, 7]],
        ),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::formats::node_order::judge;

    #[test]
    fn nodes_lie_where_each_library_puts_them() {
        let compared = |own: &NamedOrder| {
            let elements = judge::elements().filter(|&(cell, order)| {
                let theirs = judge::triples(&judge::element(cell, order)[own.name]["nodes"]);
                let ours = own.slots(cell, order);
                let points =
                    |slots: &[u8]| slots.iter().map(|&n| lattice(cell, order)[usize::from(n)]).collect::<Vec<_>>();
                assert!(theirs.is_none() || theirs == ours.map(points), "{} {cell} {order}", own.name);
                theirs.is_some()
            });
            (own.name, elements.count())
        };
        let counts: Vec<_> = NODE_ORDERS.iter().map(compared).collect();
        let all = judge::elements().count();
        // VTK has no curved pyramids, MFEM has others; no other program says what lexicographic is
        let expected =
            [("cgns", all), ("lexicographic", 0), ("gmsh", all), ("vtk", all - 3), ("basix", all), ("mfem", all - 3)];
        assert_eq!(counts, expected);
    }

    #[test]
    fn every_order_is_a_permutation() {
        for own in &NODE_ORDERS {
            for (cell, order) in judge::elements() {
                let Some(slots) = own.slots(cell, order) else { continue };
                let mut sorted = slots.to_vec();
                sorted.sort_unstable();
                assert!(sorted.into_iter().eq(0..cell.node_count(order) as u8), "{} {cell} {order}", own.name);
            }
        }
    }
}
