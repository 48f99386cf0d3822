//! Node orders of file formats, as permutations of the internal order (CGNS).
//!
//! Each order is derived from its rules: the edges and face loops of every cell in storage order, and how the
//! interior is filled. The rules are those of Gmsh (`setOrder` on single elements) and of VTK's Lagrange cells from
//! XML version 2.1 on; `tests/judge/node_order.json`, which other programs wrote, is what the tests compare with.

use std::sync::OnceLock;

use super::lattice::{between, embed, shifted};
use super::{Cell, Face, Order, basis, lattice};

/// A file format's way to order the nodes of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FileOrder {
    /// CGNS, which is the internal order.
    Cgns,
    /// Gmsh MSH, all versions.
    Gmsh,
    /// VTK Lagrange cells (types 68 to 73), XML version 2.1 and later.
    Vtk,
    /// VTK Lagrange cells before XML version 2.1 (legacy: 5.1): two upright edges of the hex stand the other way round.
    VtkBefore21,
    /// UGRID (AFLR3), which has linear elements only; a pyramid's apex stands third.
    Ugrid,
}

impl FileOrder {
    /// For each slot of an element in the file, the node of the internal order that it holds.
    ///
    /// `None` where the format has no such element: VTK has no pyramid beyond the linear one, UGRID nothing beyond.
    #[must_use]
    pub fn slots(self, cell: Cell, order: Order) -> Option<&'static [u8]> {
        static TABLES: [[[Table; 4]; 8]; 5] = [const { [const { [const { Table::new() }; 4] }; 8] }; 5];
        TABLES[self as usize][cell as usize][order.get() - 1].get_or_init(|| self.build(cell, order)).as_deref()
    }

    fn build(self, cell: Cell, order: Order) -> Option<Vec<u8>> {
        let internal = lattice(cell, order);
        let layout = match self {
            FileOrder::Cgns => return Some((0..internal.len() as u8).collect()),
            FileOrder::Ugrid if order > Order::LINEAR => return None,
            FileOrder::Ugrid if cell == Cell::Pyramid => return Some(UGRID_PYRAMID.to_vec()),
            FileOrder::Ugrid => return Some((0..internal.len() as u8).collect()),
            FileOrder::Gmsh => &GMSH,
            FileOrder::VtkBefore21 if cell == Cell::Hex => return Some(old_hex(order)),
            FileOrder::VtkBefore21 => return FileOrder::Vtk.build(cell, order),
            FileOrder::Vtk if cell == Cell::Pyramid && order > Order::LINEAR => return None,
            FileOrder::Vtk => &VTK,
        };
        let nodes = points(layout, cell, order.get() as u8);
        Some(nodes.iter().filter_map(|at| internal.iter().position(|x| x == at)).map(|n| n as u8).collect())
    }
}

/// VTK's hex with its last two upright edges exchanged.
fn old_hex(order: Order) -> Vec<u8> {
    let inner = order.get() - 1;
    let mut slots = FileOrder::Vtk.build(Cell::Hex, order).unwrap_or_default();
    // The upright edges stand last of the twelve, behind the eight corners.
    let third = Cell::Hex.corner_count() + 10 * inner;
    slots[third..third + 2 * inner].rotate_left(inner);
    slots
}

/// UGRID's pyramid: its nodes 1, 4, 5, 2 go round the base, and 3 is the apex.
const UGRID_PYRAMID: [u8; 5] = [0, 3, 4, 1, 2];

/// A pyramid as VTK's degenerate hex of the same order: for each slot of the hex, the weights of the pyramid's nodes
/// in the slot's point.
///
/// The hex's lattice in the collapsed coordinates of the pyramid, `x = a (1 - c)`, `y = b (1 - c)`, `z = c`: its upper
/// face is the apex. The pyramid's functions are polynomials there, so that the hex has the pyramid's shape exactly.
#[must_use]
pub fn pyramid_as_hex(order: Order) -> Vec<Vec<f64>> {
    let p = order.get() as f64;
    let chart = points(&VTK, Cell::Hex, order.get() as u8);
    chart.iter().map(|at| basis::values(Cell::Pyramid, order, at.map(|x| f64::from(x) / p))).collect()
}

/// One permutation, made when it is first asked for.
type Table = OnceLock<Option<Vec<u8>>>;

/// One cell's rule: the pieces in which its nodes follow the corners.
struct Rule {
    /// Corner pairs, in storage order and direction.
    edges: &'static [[u8; 2]],
    /// Corner loops of the faces; each face is filled like the interior of its own cell, from the loop's start.
    faces: &'static [&'static [u8]],
    interior: Interior,
}

/// How the nodes inside a cell follow one another.
#[derive(Clone, Copy)]
enum Interior {
    /// As the same cell of an order that is this much lower.
    Smaller(u8),
    /// First coordinate fastest.
    Lexicographic,
    /// Prism: for each node of the inner triangle the line above it, in the line's own order.
    Columns,
    /// Prism: the inner triangle at each height.
    Layers,
}

/// The rules of one format, in the order of [`Cell::ALL`].
type Layout = [Rule; 8];

const POINT: Rule = Rule { edges: &[], faces: &[], interior: Interior::Smaller(1) };
const LINE: Rule = Rule { edges: &[], faces: &[], interior: Interior::Lexicographic };
const TRIANGLE: Rule = Rule { edges: &[[0, 1], [1, 2], [2, 0]], faces: &[], interior: Interior::Smaller(3) };

static GMSH: Layout = [
    POINT,
    LINE,
    TRIANGLE,
    Rule { edges: &[[0, 1], [1, 2], [2, 3], [3, 0]], faces: &[], interior: Interior::Smaller(2) },
    Rule {
        edges: &[[0, 1], [1, 2], [2, 0], [3, 0], [3, 2], [3, 1]],
        faces: &[&[0, 2, 1], &[0, 1, 3], &[0, 3, 2], &[3, 1, 2]],
        interior: Interior::Smaller(4),
    },
    Rule {
        edges: &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 4], [2, 3], [2, 4], [3, 4]],
        faces: &[&[0, 1, 4], &[3, 0, 4], &[1, 2, 4], &[2, 3, 4], &[0, 3, 2, 1]],
        interior: Interior::Smaller(3),
    },
    Rule {
        edges: &[[0, 1], [0, 2], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [3, 5], [4, 5]],
        faces: &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[0, 3, 5, 2], &[1, 2, 5, 4]],
        interior: Interior::Columns,
    },
    Rule {
        edges: &[[0, 1], [0, 3], [0, 4], [1, 2], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 7], [5, 6], [6, 7]],
        faces: &[&[0, 3, 2, 1], &[0, 1, 5, 4], &[0, 4, 7, 3], &[1, 2, 6, 5], &[2, 3, 7, 6], &[4, 5, 6, 7]],
        interior: Interior::Smaller(2),
    },
];

static VTK: Layout = [
    POINT,
    LINE,
    TRIANGLE,
    Rule { edges: &[[0, 1], [1, 2], [3, 2], [0, 3]], faces: &[], interior: Interior::Lexicographic },
    Rule {
        edges: &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
        faces: &[&[0, 1, 3], &[2, 3, 1], &[0, 3, 2], &[0, 2, 1]],
        interior: Interior::Smaller(4),
    },
    // Only the linear pyramid exists, which has nothing but corners.
    Rule { edges: &[], faces: &[], interior: Interior::Smaller(3) },
    Rule {
        edges: &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
        faces: &[&[0, 1, 2], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
        interior: Interior::Layers,
    },
    Rule {
        edges: &[[0, 1], [1, 2], [3, 2], [0, 3], [4, 5], [5, 6], [7, 6], [4, 7], [0, 4], [1, 5], [2, 6], [3, 7]],
        faces: &[&[0, 3, 7, 4], &[1, 2, 6, 5], &[0, 1, 5, 4], &[3, 2, 6, 7], &[0, 1, 2, 3], &[4, 5, 6, 7]],
        interior: Interior::Lexicographic,
    },
];

/// Lattice coordinates of an element's nodes in a format's order.
fn points(layout: &Layout, cell: Cell, p: u8) -> Vec<[u8; 3]> {
    if p == 0 {
        return vec![[0, 0, 0]];
    }
    let rule = &layout[cell as usize];
    let mut nodes: Vec<[u8; 3]> = cell.corners().iter().map(|corner| corner.map(|x| x * p)).collect();
    for &[a, b] in rule.edges {
        nodes.extend((1..p).map(|step| between(cell, p, step, a, b)));
    }
    for &corners in rule.faces {
        let shape = if corners.len() == 3 { Cell::Triangle } else { Cell::Quad };
        let face = Face { cell: shape, corners, outward: true };
        nodes.extend(interior(layout, shape, p).into_iter().map(|at| embed(cell, &face, p, at)));
    }
    nodes.extend(interior(layout, cell, p));
    nodes
}

/// The nodes that lie on no corner, edge or face of the cell.
fn interior(layout: &Layout, cell: Cell, p: u8) -> Vec<[u8; 3]> {
    let by: [u8; 3] = std::array::from_fn(|axis| u8::from(axis < cell.dimension()));
    match layout[cell as usize].interior {
        _ if cell == Cell::Point => Vec::new(),
        Interior::Smaller(drop) if p < drop => Vec::new(),
        Interior::Smaller(drop) => shifted(points(layout, cell, p - drop), by),
        Interior::Lexicographic => {
            let axis = |on: u8| if on == 1 { 1..p } else { 0..1 };
            axis(by[2]).flat_map(|k| axis(by[1]).flat_map(move |j| axis(1).map(move |i| [i, j, k]))).collect()
        }
        Interior::Columns | Interior::Layers if p < 3 => Vec::new(),
        Interior::Columns => {
            let line = points(layout, Cell::Line, p - 2);
            let above = |[i, j, _]: [u8; 3]| line.iter().map(move |&[k, ..]| [i, j, k + 1]);
            interior(layout, Cell::Triangle, p).into_iter().flat_map(above).collect()
        }
        Interior::Layers => {
            let layer = interior(layout, Cell::Triangle, p);
            (1..p).flat_map(|k| shifted(layer.clone(), [0, 0, k])).collect()
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
mod tests {
    use serde_json::Value;

    use super::super::type_code;
    use super::*;

    /// Tables made from the output of Gmsh, VTK and CGNS (`tests/judge/node_order.json`).
    fn judge() -> Value {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/judge/node_order.json");
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    fn shape(cell: Cell) -> &'static str {
        if cell == Cell::Triangle { "tri" } else { cell.name() }
    }

    /// A table's lattice triples (pairs, single numbers) as triples.
    fn triples(table: &Value) -> Option<Vec<[u8; 3]>> {
        let nodes = table.get("nodes")?.as_array()?;
        let triple = |node: &Value| {
            let axes = node.as_array().unwrap();
            std::array::from_fn(|x| axes.get(x).map_or(0, |v| v.as_u64().unwrap() as u8))
        };
        Some(nodes.iter().map(triple).collect())
    }

    #[test]
    fn every_order_lies_where_the_other_programs_put_it() {
        let judge = judge();
        let mut compared = 0;
        for (format, key) in [(FileOrder::Cgns, "cgns"), (FileOrder::Gmsh, "gmsh"), (FileOrder::Vtk, "vtk")] {
            for cell in Cell::ALL.into_iter().filter(|&c| c != Cell::Point) {
                for order in Order::all() {
                    let element = &judge["elements"][format!("{}_p{}", shape(cell), order.get())];
                    assert!(element.is_object(), "{cell} {order} stands in the judge's table");
                    let Some(theirs) = triples(&element[key]) else {
                        assert!(format == FileOrder::Vtk && cell == Cell::Pyramid, "{key} {cell} {order}");
                        continue;
                    };
                    let slots = format.slots(cell, order).unwrap();
                    let ours: Vec<[u8; 3]> = slots.iter().map(|&n| lattice(cell, order)[usize::from(n)]).collect();
                    assert_eq!(ours, theirs, "{key} {cell} {order}");
                    compared += 1;
                }
            }
        }
        assert!(compared >= 81, "3 formats, 7 cells, 4 orders, less 3 pyramids: {compared}");
    }

    #[test]
    fn the_old_hex_is_that_of_the_judges_table() {
        let judge = judge();
        for order in Order::all().skip(1) {
            let vtk = &judge["elements"][format!("hex_p{}", order.get())]["vtk"];
            let table = serde_json::json!({ "nodes": vtk["nodes_file_version_below_2_1"] });
            let theirs = triples(&table).unwrap();
            let slots = FileOrder::VtkBefore21.slots(Cell::Hex, order).unwrap();
            let ours: Vec<[u8; 3]> = slots.iter().map(|&n| lattice(Cell::Hex, order)[usize::from(n)]).collect();
            assert_eq!(ours, theirs, "{order}");
        }
    }

    #[test]
    fn slots_are_permutations_that_begin_with_the_corners() {
        for format in [FileOrder::Cgns, FileOrder::Gmsh, FileOrder::Vtk] {
            for cell in Cell::ALL {
                for order in Order::all() {
                    let Some(slots) = format.slots(cell, order) else {
                        assert!(format == FileOrder::Vtk && cell == Cell::Pyramid && order > Order::LINEAR);
                        continue;
                    };
                    assert!((0..cell.corner_count()).all(|n| usize::from(slots[n]) == n), "{format:?} {cell} {order}");
                    let mut sorted = slots.to_vec();
                    sorted.sort_unstable();
                    assert!(sorted.iter().enumerate().all(|(n, &s)| usize::from(s) == n), "{format:?} {cell} {order}");
                    assert_eq!(slots.len(), cell.node_count(order));
                }
            }
        }
    }

    #[test]
    fn a_pyramid_as_hex_has_the_pyramids_shape() {
        for order in Order::all() {
            let p = order.get() as f64;
            let at = |node: &[u8; 3]| glam::DVec3::from(node.map(f64::from)) / p;
            let nodes = lattice(Cell::Pyramid, order);
            let hex = FileOrder::Vtk
                .slots(Cell::Hex, order)
                .unwrap()
                .iter()
                .map(|&n| at(&lattice(Cell::Hex, order)[usize::from(n)]));
            for (weights, chart) in pyramid_as_hex(order).iter().zip(hex) {
                let sum: glam::DVec3 = weights.iter().zip(nodes).map(|(&w, node)| w * at(node)).sum();
                let shrink = 1.0 - chart.z;
                assert!(
                    sum.distance(glam::dvec3(chart.x * shrink, chart.y * shrink, chart.z)) < 1e-13,
                    "{order} {chart}"
                );
                assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-13, "{order} {chart}");
            }
        }
    }

    #[test]
    fn type_codes_are_those_of_the_judges_table() {
        let judge = judge();
        for cell in Cell::ALL.into_iter().filter(|&c| c != Cell::Point) {
            for order in Order::all() {
                let element = &judge["elements"][format!("{}_p{}", shape(cell), order.get())];
                let gmsh = type_code::gmsh(cell, order);
                assert_eq!(element["gmsh"]["type"], gmsh, "{cell} {order}");
                assert_eq!(type_code::from_gmsh(gmsh), Some(type_code::GmshType::Complete(cell, order)));
                assert_eq!(element["cgns"]["id"], type_code::cgns(cell, order), "{cell} {order}");
                assert_eq!(element["cgns"]["name"], type_code::cgns_name(cell, order), "{cell} {order}");
                if let Some(vtk) = type_code::vtk(cell, order).filter(|_| order > Order::LINEAR) {
                    assert_eq!(element["vtk"]["type"], vtk, "{cell} {order}");
                }
            }
        }
    }
}
