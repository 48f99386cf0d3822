//! Elements with known Jacobians, and random ones against dense sampling.

use glam::DVec3;

use super::form::Form;
use super::pieces::LINE;
use super::product::{Product, Workspace};
pub(super) use super::random::Random;
use super::{Bounds, Finding, Judge, Method, Settings, Shape, Verdict};
use crate::element::{Cell, Net, Order, basis, bernstein, lattice};

/// A point of a cell in reference coordinates, often on its boundary.
pub(super) fn inside(cell: Cell, random: &mut Random) -> [f64; 3] {
    let mut at = [random.unit(), random.unit(), random.unit()];
    if random.unit() < 0.3 {
        let axis = (random.unit() * 3.0) as usize;
        at[axis.min(2)] = if random.unit() < 0.5 { 0.0 } else { 1.0 };
    }
    at[cell.dimension()..].fill(0.0);
    let tight = match cell {
        Cell::Tet => 3,
        Cell::Prism | Cell::Triangle => 2,
        _ => 0,
    };
    if at[..tight].iter().sum::<f64>() > 1.0 {
        let sum: f64 = at[..tight].iter().sum();
        let shrink = if random.unit() < 0.2 { 1.0 } else { random.unit() } / sum;
        at[..tight].iter_mut().for_each(|x| *x *= shrink);
    }
    at
}

/// Nodes of the straight element over the given corners.
pub(super) fn straight(cell: Cell, order: Order, corners: &[DVec3]) -> Vec<DVec3> {
    let unit = |at: &[u8; 3]| at.map(|x| f64::from(x) / order.get() as f64);
    let point = |weights: Vec<f64>| corners.iter().zip(weights).map(|(&x, w)| x * w).sum();
    lattice(cell, order)
        .iter()
        .map(|at| point(basis::values(cell, Order::LINEAR, bernstein::chart(cell, unit(at)))))
        .collect()
}

/// The unit cell's corners.
pub(super) fn unit_corners(cell: Cell) -> Vec<DVec3> {
    cell.corners().iter().map(|c| DVec3::from(c.map(f64::from))).collect()
}

/// The Jacobian determinant at a point in reference coordinates, by the basis functions' gradients.
pub(super) fn jacobian(cell: Cell, order: Order, points: &[DVec3], at: [f64; 3], normal: Option<DVec3>) -> f64 {
    let mut columns = [DVec3::ZERO; 3];
    for (slopes, &x) in basis::gradients(cell, order, at).into_iter().zip(points) {
        for axis in 0..3 {
            columns[axis] += (x - points[0]) * slopes[axis];
        }
    }
    columns[0].cross(columns[1]).dot(normal.unwrap_or(columns[2]))
}

pub(super) fn examine(cell: Cell, order: Order, points: &[DVec3], corners: Option<&[DVec3]>) -> Finding {
    Judge::default().examine(&Shape { cell, order, points, corners, upright: &[] }, &Settings::default())
}

fn each() -> impl Iterator<Item = (Cell, Order)> {
    Cell::VOLUME.into_iter().flat_map(|cell| Order::all().map(move |order| (cell, order)))
}

/// Value of a Bernstein polynomial of a net at a point in reference coordinates.
fn polynomial(net: Net, index: [usize; 3], at: [f64; 3]) -> f64 {
    let power = |x: f64, n: usize| x.powi(n as i32);
    let pair = |n: usize, i: usize, x: f64| power(x, i) * power(1.0 - x, n - i);
    let ([i, j, k], [x, y, z], [p, q, n]) = (index, at, net.degree);
    let powers = match net.cell {
        Cell::Tet => power(x, i) * power(y, j) * power(z, k) * power(1.0 - x - y - z, p - i - j - k),
        Cell::Prism => power(x, i) * power(y, j) * power(1.0 - x - y, p - i - j) * pair(n, k, z),
        Cell::Pyramid => pair(n, k, z) * pair(n - k + p, i, x) * pair(n - k + q, j, y),
        _ => pair(p, i, x) * pair(q, j, y) * pair(n, k, z),
    };
    net.weight(index) * powers
}

#[test]
fn no_line_is_longer_than_the_longest() {
    let lines = |(cell, order): (Cell, Order)| {
        Form::of(cell, order).directions.iter().flat_map(|direction| &direction.bundles).map(Vec::len).max()
    };
    let faces = [Cell::Triangle, Cell::Quad].into_iter().flat_map(|cell| Order::all().map(move |order| (cell, order)));
    assert_eq!(each().chain(faces).filter_map(lines).max(), Some(LINE));
}

#[test]
fn coefficients_sum_to_the_jacobian() {
    let mut random = Random(1);
    for (cell, order) in each() {
        let corners = unit_corners(cell);
        let points: Vec<DVec3> = straight(cell, order, &corners).iter().map(|&x| x + random.vector() * 0.3).collect();
        let product = Product::of(cell, order);
        let mut work = Workspace::<f64>::default();
        work.nodes = points.iter().map(|&x| (x - points[0]).to_array()).collect();
        let mut net = Vec::new();
        product.coefficients(&mut work, &mut net);
        let space = Net::jacobian(cell, order);
        for _ in 0..20 {
            let at = inside(cell, &mut random);
            let terms = space.indices().into_iter().zip(&net);
            let sum: f64 = terms.map(|(index, c)| c * polynomial(space, index, at)).sum();
            let expected = jacobian(cell, order, &points, at, None);
            assert!((sum - expected).abs() < 1e-10, "{cell} {order} at {at:?}: {sum} for {expected}");
        }
    }
}

#[test]
fn straight_elements_have_ratio_one() {
    let mut random = Random(2);
    for (cell, order) in each() {
        let corners: Vec<DVec3> = unit_corners(cell).iter().map(|&x| x + random.vector() * 0.1 + 7.0).collect();
        let finding = examine(cell, order, &straight(cell, order, &corners), Some(&corners));
        assert_eq!(finding.verdict, Verdict::Valid, "{cell} {order}");
        assert_eq!(finding.method, Method::Straight, "{cell} {order}");
        assert!(
            finding.relative.lower > 1.0 - 1e-8 && finding.relative.upper < 1.0 + 1e-8,
            "{cell} {order} {finding:?}"
        );
    }
}

#[test]
fn affine_and_mirrored_elements() {
    for (cell, order) in each() {
        let corners = unit_corners(cell);
        let stretch = DVec3::new(1.0, 0.5, 1.2);
        let points: Vec<DVec3> = straight(cell, order, &corners).iter().map(|&x| x * stretch).collect();
        let Finding { verdict, relative, .. } = examine(cell, order, &points, Some(&corners));
        assert_eq!(verdict, Verdict::Valid);
        assert!(
            (relative.lower - 0.6).abs() < 1e-9 && (relative.upper - 0.6).abs() < 1e-9,
            "{cell} {order} {relative:?}"
        );
        let mirrored: Vec<DVec3> = points.iter().map(|&x| x * DVec3::new(-1.0, 1.0, 1.0)).collect();
        let Finding { verdict, relative, .. } = examine(cell, order, &mirrored, Some(&corners));
        assert!(
            matches!(verdict, Verdict::Invalid { value, .. } if (value + 0.6).abs() < 1e-9),
            "{cell} {order} {verdict:?}"
        );
        assert!((relative.upper + 0.6).abs() < 1e-9);
        let alone = examine(cell, order, &mirrored, None);
        assert_eq!(alone.relative, Bounds::UNKNOWN);
        assert!(matches!(alone.verdict, Verdict::Invalid { .. }));
    }
}

/// The middle node of an edge along x, pushed by `t` along the edge: `J = 1 + 4 t (1 - 2 x - y - z)` there, so that the
/// P2 tet is valid for `|t| < 1/4` only.
#[test]
fn a_tet_turns_invalid_where_the_formula_says() {
    let order = Order::all().nth(1).unwrap_or_default();
    for (t, valid) in [(0.2499999999, true), (0.2500000001, false), (-0.2499999999, true), (-0.2500000001, false)] {
        let mut points = straight(Cell::Tet, order, &unit_corners(Cell::Tet));
        points[4] += DVec3::X * t;
        let finding = examine(Cell::Tet, order, &points, None);
        assert_eq!(finding.verdict.is_valid(), valid, "{t}: {finding:?}");
        assert_ne!(finding.verdict, Verdict::Undecided);
        let least = 1.0 - 4.0 * f64::abs(t);
        assert!(finding.relative.lower <= least + 1e-12 && finding.relative.upper >= least - 1e-12, "{finding:?}");
    }
}
