//! Node orders of formats, as permutations of the internal order, which is that of CGNS.
//!
//! An order is derived from its rules: the edges and face loops of every cell in storage order, and how the interior is filled.
//! Each format states its own; `tests/judge/node_order.json`, which other programs wrote, is what the tests compare with.

use std::sync::OnceLock;

use crate::element::{Cell, Face, Order, between, embed, lattice, shifted};

/// A format's way to order the nodes of an element.
pub(super) struct NodeOrder {
    build: fn(Cell, Order) -> Option<Vec<u8>>,
    tables: [[Table; 4]; 8],
}

/// One permutation, made when it is first asked for.
type Table = OnceLock<Option<Vec<u8>>>;

impl NodeOrder {
    /// The order that a function makes; it gives `None` for elements that the format lacks.
    pub(super) const fn new(build: fn(Cell, Order) -> Option<Vec<u8>>) -> NodeOrder {
        NodeOrder { build, tables: [const { [const { Table::new() }; 4] }; 8] }
    }

    /// For each slot of an element in the file, the node of the internal order that it holds; `None` where the format has no
    /// such element.
    pub(super) fn slots(&'static self, cell: Cell, order: Order) -> Option<&'static [u8]> {
        self.tables[cell as usize][order.get() - 1].get_or_init(|| (self.build)(cell, order)).as_deref()
    }
}

/// One cell's rule: the pieces in which its nodes follow the corners.
pub(super) struct Rule {
    /// Corner pairs, in storage order and direction.
    pub(super) edges: &'static [[u8; 2]],
    /// Corner loops of the faces; each face is filled like the interior of its own cell, from the loop's start.
    pub(super) faces: &'static [&'static [u8]],
    pub(super) interior: Interior,
}

/// How the nodes inside a cell follow one another.
#[derive(Clone, Copy)]
pub(super) enum Interior {
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
pub(super) type Layout = [Rule; 8];

pub(super) const POINT: Rule = Rule { edges: &[], faces: &[], interior: Interior::Smaller(1) };
pub(super) const LINE: Rule = Rule { edges: &[], faces: &[], interior: Interior::Lexicographic };
pub(super) const TRIANGLE: Rule = Rule { edges: &[[0, 1], [1, 2], [2, 0]], faces: &[], interior: Interior::Smaller(3) };

/// The permutation of an element by a format's rules.
pub(super) fn by_rules(layout: &Layout, cell: Cell, order: Order) -> Vec<u8> {
    let internal = lattice(cell, order);
    let nodes = points(layout, cell, order.get() as u8);
    nodes.iter().filter_map(|at| internal.iter().position(|x| x == at)).map(|n| n as u8).collect()
}

/// Lattice coordinates of an element's nodes in a format's order.
pub(super) fn points(layout: &Layout, cell: Cell, p: u8) -> Vec<[u8; 3]> {
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

/// What other programs say of node orders and type codes (`tests/judge/node_order.json`), for the tests of the formats.
#[cfg(test)]
#[allow(clippy::unwrap_used)]
pub(super) mod judge {
    use serde_json::Value;

    use super::NodeOrder;
    use crate::element::{Cell, Order, lattice};

    /// The cells and orders that the table knows.
    pub(crate) fn elements() -> impl Iterator<Item = (Cell, Order)> {
        let cells = Cell::ALL.into_iter().filter(|&cell| cell != Cell::Point);
        cells.flat_map(|cell| Order::all().map(move |order| (cell, order)))
    }

    /// What the table says of an element.
    pub(crate) fn element(cell: Cell, order: Order) -> Value {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/judge/node_order.json");
        let judge: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        let shape = if cell == Cell::Triangle { "tri" } else { cell.name() };
        let element = &judge["elements"][format!("{shape}_p{}", order.get())];
        assert!(element.is_object(), "{cell} {order} stands in the judge's table");
        element.clone()
    }

    /// A list of lattice triples (pairs, single numbers) as triples; `None` where there is none.
    pub(crate) fn triples(nodes: &Value) -> Option<Vec<[u8; 3]>> {
        let triple = |node: &Value| {
            let axes = node.as_array().unwrap();
            std::array::from_fn(|x| axes.get(x).map_or(0, |v| v.as_u64().unwrap() as u8))
        };
        Some(nodes.as_array()?.iter().map(triple).collect())
    }

    /// Where an order puts an element's nodes.
    pub(crate) fn points(own: &'static NodeOrder, cell: Cell, order: Order) -> Vec<[u8; 3]> {
        let slots = own.slots(cell, order).unwrap();
        slots.iter().map(|&n| lattice(cell, order)[usize::from(n)]).collect()
    }

    /// Holds an order against the judge's of a format, for all elements that the format has; an order is a permutation that
    /// begins with the corners.
    pub(crate) fn compare(own: &'static NodeOrder, format: &str, has: impl Fn(Cell, Order) -> bool) {
        for (cell, order) in elements() {
            let Some(theirs) = triples(&element(cell, order)[format]["nodes"]) else {
                assert!(!has(cell, order) && own.slots(cell, order).is_none(), "{format} {cell} {order}");
                continue;
            };
            assert_eq!(points(own, cell, order), theirs, "{format} {cell} {order}");
            let slots = own.slots(cell, order).unwrap();
            assert!((0..cell.corner_count()).all(|n| usize::from(slots[n]) == n), "{format} {cell} {order}");
            let mut sorted = slots.to_vec();
            sorted.sort_unstable();
            assert!(sorted.iter().enumerate().all(|(n, &s)| usize::from(s) == n), "{format} {cell} {order}");
        }
    }
}
