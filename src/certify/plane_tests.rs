//! Plane meshes: triangles and quadrilaterals against the normal of their plane.

use glam::{DMat3, DVec3};

use super::tests::Random;
use super::{Certificate, NotCertifiable, Settings, Verdict, check};
use crate::element::{Cell, Order};
use crate::mesh::elevate::elevate;
use crate::mesh::{EntityKey, Mesh, NodeId, Parts};

/// A square of 2 x 2 cells over the unit square, the upper two cut into triangles, and the lines along its bottom:
///
/// ```text
/// +--+--+
/// |\ |\ |     triangles
/// +--+--+
/// |  |  |     quadrilaterals
/// +--+--+
/// ```
fn square() -> Mesh {
    let points = (0..9).map(|n| DVec3::new((n % 3) as f64 / 2.0, (n / 3) as f64 / 2.0, 0.0)).collect();
    let mut parts = Parts { points, ..Parts::default() };
    let mut push = |cell: Cell, nodes: &[usize]| {
        let nodes: Vec<NodeId> = nodes.iter().map(|&n| NodeId::new(n).unwrap()).collect();
        parts.push(cell, EntityKey::new(cell.dimension() as u8, 1), &nodes);
    };
    for first in [0, 1] {
        push(Cell::Line, &[first, first + 1]);
        push(Cell::Quad, &[first, first + 1, first + 4, first + 3]);
        let [a, b, c, d] = [3, 4, 7, 6].map(|n| n + first);
        push(Cell::Triangle, &[a, b, d]);
        push(Cell::Triangle, &[c, d, b]);
    }
    Mesh::new(parts).unwrap()
}

/// The square at an order, its nodes moved by a map before it is put somewhere.
fn certificate(order: Order, place: impl Fn(DVec3) -> DVec3, map: impl Fn(DVec3) -> DVec3) -> Certificate {
    let mesh = elevate(&square(), order).unwrap().mesh;
    let [linear, curved] = [false, true].map(|curved| {
        let at = |x: &DVec3| place(if curved { map(*x) } else { *x });
        mesh.points().iter().map(at).collect::<Vec<DVec3>>()
    });
    check(&mesh, &curved, Some(&linear), &Settings::default()).unwrap()
}

/// Planes to put it in: as it is, mirrored, turned, small and far off.
fn places() -> [Box<dyn Fn(DVec3) -> DVec3>; 4] {
    let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(1.9);
    [
        Box::new(|x| x),
        Box::new(|x| DVec3::new(x.y, x.x, 0.0)),
        Box::new(|x| DVec3::new(x.x, 0.0, x.y) * 1e-3),
        Box::new(move |x| turn * x * 3e-3 + DVec3::new(40.0, -3.0, 17.0)),
    ]
}

fn counts(certificate: &Certificate) -> [[usize; 3]; 2] {
    [Cell::Triangle, Cell::Quad].map(|cell| {
        let tally = certificate.tally(cell);
        [tally.valid, tally.invalid, tally.undecided]
    })
}

/// `x = u + a (u^2 - u)` over the square has `dx/du = 1 + a (2u - 1)`: its smallest value is `1 - a`, at `u = 0`, where one
/// quadrilateral and two triangles are, one of them with a corner; from `u = 1/2` on it is at least 1.
#[test]
fn the_minimum_is_the_known_one_in_any_plane() {
    for order in Order::all().skip(1) {
        for place in places() {
            for a in [0.3, 0.999, 1.001, 1.5] {
                let found = certificate(order, &place, |x| DVec3::new(x.x + a * (x.x * x.x - x.x), x.y, 0.0));
                let expected = if a < 1.0 { [[4, 0, 0], [2, 0, 0]] } else { [[2, 2, 0], [1, 1, 0]] };
                assert_eq!(counts(&found), expected, "{order} a = {a}");
                assert_eq!(found.holds(), a < 1.0);
                let bounds = found.relative;
                assert!(bounds.lower <= 1.0 - a + 1e-9 && bounds.upper >= 1.0 - a - 1e-9, "{order} {a}: {bounds:?}");
                assert!(a > 1.0 || bounds.upper - bounds.lower < 2e-3, "{order} {a}: {bounds:?}");
                let normal = found.normal.unwrap();
                let own = (place(DVec3::X) - place(DVec3::ZERO)).cross(place(DVec3::Y) - place(DVec3::ZERO));
                assert!(normal.dot(own.normalize()) > 1.0 - 1e-12, "{normal}");
            }
        }
    }
}

#[test]
fn straight_cells_and_a_concave_quadrilateral() {
    for place in places() {
        for order in Order::all() {
            let straight = certificate(order, &place, |x| x);
            assert!(straight.holds() && (straight.relative.lower - 1.0).abs() < 1e-6, "{order}");
            assert_eq!(straight.tally(Cell::Quad).straight + straight.tally(Cell::Triangle).straight, 6, "{order}");
        }
        // The lower left corner of the square is drawn over the middle of its quadrilateral.
        let concave =
            certificate(Order::LINEAR, &place, |x| if x == DVec3::ZERO { DVec3::new(0.4, 0.4, 0.0) } else { x });
        assert_eq!(counts(&concave), [[4, 0, 0], [1, 1, 0]]);
        assert!(matches!(concave.failures[0].finding.verdict, Verdict::Invalid { value, .. } if value < 0.0));
    }
}

/// Whatever the nodes do, what sampling finds is between the bounds.
#[test]
fn bounds_hold_against_dense_sampling() {
    let mut random = Random(14);
    for order in Order::all().skip(1) {
        let mesh = elevate(&square(), order).unwrap().mesh;
        for amount in [0.01, 0.03, 0.08] {
            let noise = |x: &DVec3| *x + random.vector() * DVec3::new(amount, amount, 0.0);
            let curved: Vec<DVec3> = mesh.points().iter().map(noise).collect();
            let found = check(&mesh, &curved, Some(mesh.points()), &Settings::default()).unwrap();
            let mut least = f64::INFINITY;
            for cell in mesh.cells().iter() {
                let own = |x: &[DVec3]| cell.nodes.iter().map(|n| x[n.index()]).collect::<Vec<DVec3>>();
                let (points, straight) = (own(&curved), own(mesh.points()));
                let at =
                    || (0..=40).flat_map(|i| (0..=40).map(move |j| [f64::from(i) / 40.0, f64::from(j) / 40.0, 0.0]));
                let jacobian = |x: &[DVec3], at| super::tests::jacobian(cell.cell, order, x, at, found.normal);
                let inside = at().filter(|at| cell.cell == Cell::Quad || at[0] + at[1] <= 1.0);
                let ratio =
                    inside.map(|at| jacobian(&points, at) / jacobian(&straight, at)).fold(f64::INFINITY, f64::min);
                assert!(ratio >= found.minima[cell.id.index()] - 1e-9, "{order} {amount}");
                let failed = found.failures.iter().any(|failure| failure.element == cell.id);
                assert!(ratio > 0.0 || failed, "{order} {amount}: an element with J/Jc = {ratio} passes");
                least = least.min(ratio);
            }
            assert!(found.relative.lower <= least, "{order} {amount}: {least}");
        }
    }
}

#[test]
fn what_cannot_be_certified_is_refused() {
    let refused = |mesh: &Mesh| check(mesh, mesh.points(), None, &Settings::default()).unwrap_err();
    assert_eq!(refused(&Mesh::default()), NotCertifiable::NoCells);
    let mut lines = square().into_parts();
    lines.blocks.retain(|block| block.cell == Cell::Line);
    let lines = Mesh::new(lines).unwrap();
    assert_eq!(refused(&lines), NotCertifiable::NoCells);
    assert!(!super::mesh(&lines, lines.points(), None, &Settings::default()).holds());
    let mut bent = square();
    bent.points_mut()[4].z = 0.1;
    assert_eq!(refused(&bent), NotCertifiable::NotPlane);
    let certificate = super::mesh(&bent, bent.points(), None, &Settings::default());
    assert_eq!(counts(&certificate), [[0, 0, 4], [0, 0, 2]]);
}
