//! Node orders of VTK's Lagrange cells, types 68 to 73, and the pyramids that VTK lacks.

use crate::element::{Cell, Order, basis};
use crate::formats::node_order::{Interior, LINE, Layout, NodeOrder, POINT, Rule, TRIANGLE, by_rules, points};

/// The order from XML version 2.1 and legacy version 5.1 on. There is no pyramid beyond the linear one.
pub(in crate::formats) static ORDER: NodeOrder = NodeOrder::new(|cell, order| match cell {
    Cell::Pyramid if order > Order::LINEAR => None,
    _ => Some(by_rules(&LAYOUT, cell, order)),
});

/// The order before those versions: the last two upright edges of the hex stand the other way round.
pub(super) static BEFORE_21: NodeOrder = NodeOrder::new(|cell, order| {
    let mut slots = ORDER.slots(cell, order)?.to_vec();
    if cell == Cell::Hex {
        let inner = order.get() - 1;
        // The upright edges stand last of the twelve, behind the eight corners.
        let third = cell.corner_count() + 10 * inner;
        slots[third..third + 2 * inner].rotate_left(inner);
    }
    Some(slots)
});

/// A pyramid as VTK's degenerate hex of the same order: for each slot of the hex, the weights of the pyramid's nodes
/// in the slot's point.
///
/// The hex's lattice in the collapsed coordinates of the pyramid, `x = a (1 - c)`, `y = b (1 - c)`, `z = c`: its upper
/// face is the apex. The pyramid's functions are polynomials there, so that the hex has the pyramid's shape exactly.
pub(super) fn pyramid_as_hex(order: Order) -> Vec<Vec<f64>> {
    let p = order.get() as f64;
    let chart = points(&LAYOUT, Cell::Hex, order.get() as u8);
    chart.iter().map(|at| basis::values(Cell::Pyramid, order, at.map(|x| f64::from(x) / p))).collect()
}

static LAYOUT: Layout = [
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::lattice;
    use crate::formats::node_order::judge;

    #[test]
    fn nodes_lie_where_vtk_puts_them() {
        judge::compare(&ORDER, "vtk", |cell, order| cell != Cell::Pyramid || order == Order::LINEAR);
    }

    #[test]
    fn the_old_hex_is_that_of_the_judges_table() {
        for order in Order::all().skip(1) {
            let theirs = judge::triples(&judge::element(Cell::Hex, order)["vtk"]["nodes_file_version_below_2_1"]);
            assert_eq!(judge::points(&BEFORE_21, Cell::Hex, order), theirs.unwrap(), "{order}");
        }
    }

    #[test]
    fn a_pyramid_as_hex_has_the_pyramids_shape() {
        for order in Order::all() {
            let p = order.get() as f64;
            let at = |node: &[u8; 3]| glam::DVec3::from(node.map(f64::from)) / p;
            let nodes = lattice(Cell::Pyramid, order);
            let hex = judge::points(&ORDER, Cell::Hex, order);
            for (weights, chart) in pyramid_as_hex(order).iter().zip(hex.iter().map(at)) {
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
}
