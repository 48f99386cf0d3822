//! Gmsh's node order.

use crate::formats::node_order::{Interior, LINE, Layout, NodeOrder, POINT, Rule, TRIANGLE, by_rules};

/// The order of MSH files of all versions: that of `setOrder` on single elements.
pub(in crate::formats) static ORDER: NodeOrder = NodeOrder::new(|cell, order| Some(by_rules(&LAYOUT, cell, order)));

static LAYOUT: Layout = [
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::node_order::judge;

    #[test]
    fn nodes_lie_where_gmsh_puts_them() {
        judge::compare(&ORDER, "gmsh", |_, _| true);
    }
}
