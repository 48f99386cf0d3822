//! Layers: flat and needle-like elements that are bent by many times their height, far from the origin; and elements
//! that a survey at equispaced points takes for valid.

use glam::{DMat3, DVec3};

use super::random_tests::Dense;
use super::tests::{Random, examine, jacobian, straight, unit_corners};
use super::{Judge, Settings, Shape, Verdict};
use crate::element::{Cell, Order, Samples};

/// A bent element: `thin` high, its nodes raised by 600 times that along the layer's normal as the square of the
/// tangential position, so that `J = J_c` but for rounding and for `noise`, relative to the height.
///
/// ```text
///      .-----.
///    .'  .-.  '.     every column keeps its height
///   /  .'   '.  \
/// ```
fn bent(cell: Cell, order: Order, stretch: DVec3, noise: f64, random: &mut Random) -> [Vec<DVec3>; 2] {
    let turn = DMat3::from_axis_angle((random.vector() + DVec3::Z * 0.1).normalize(), 6.0 * random.unit());
    let offset = random.vector() * 1e3;
    let place = |x: DVec3| turn * (x * stretch) + offset;
    let unit = straight(cell, order, &unit_corners(cell));
    let node = |x: &DVec3| {
        let rise = 600.0 * (x.x * (1.0 - x.x) + 0.3 * x.x * x.y);
        place(*x + DVec3::Z * rise + random.vector() * noise)
    };
    [unit.iter().map(node).collect(), unit_corners(cell).into_iter().map(place).collect()]
}

#[test]
fn bent_layers_are_valid_far_from_the_origin() {
    let order_2 = Order::all().skip(1);
    for (seed, order) in order_2.enumerate() {
        for cell in Cell::VOLUME {
            let mut random = Random(40 + seed as u64);
            for stretch in [DVec3::new(1.0, 1.0, 1e-4), DVec3::new(1.0, 1e-4, 1e-4)] {
                for noise in [0.0, 1e-3] {
                    // Noise along the layer works through the bend: 600 times as strong.
                    let [points, corners] = bent(cell, order, stretch, noise / 600.0, &mut random);
                    let finding = examine(cell, order, &points, Some(&corners));
                    assert_eq!(finding.verdict, Verdict::Valid, "{cell} {order} {stretch} {noise}: {finding:?}");
                    assert!(finding.relative.lower > 0.8, "{cell} {order} {stretch} {noise}: {finding:?}");
                }
            }
        }
    }
}

/// Elements whose Jacobian is positive at the equispaced points of density p, but not everywhere.
#[test]
fn spots_between_survey_points_are_found() {
    for cell in Cell::VOLUME {
        for order in Order::all().skip(1) {
            let mut random = Random(77 ^ cell as u64 ^ (order.get() as u64) << 4);
            let places = Samples::survey(cell, order, order.get());
            let survey = Dense::at(cell, order, places.points().to_vec());
            let corners = unit_corners(cell);
            let flat = straight(cell, order, &corners);
            let mut judge = Judge::default();
            let mut found = 0;
            for _ in 0..40 {
                let noise: Vec<DVec3> = flat.iter().map(|_| random.vector()).collect();
                let at = |t: f64| -> Vec<DVec3> { flat.iter().zip(&noise).map(|(&x, &n)| x + n * t).collect() };
                let (mut low, mut high) = (0.0, 0.5);
                for _ in 0..12 {
                    let middle = 0.5 * (low + high);
                    if survey.least(&at(middle), &corners, None)[0] > 0.01 { low = middle } else { high = middle }
                }
                let points = at(low);
                let shape = Shape { cell, order, points: &points, corners: Some(&corners), upright: &[] };
                if let Verdict::Invalid { at, value } = judge.examine(&shape, &Settings::default()).verdict {
                    let there = jacobian(cell, order, &points, at, None);
                    assert!(there <= value + 1e-9 && value <= 0.0, "{cell} {order} {at:?}: {there} for {value}");
                    found += 1;
                }
            }
            assert!(found > 2, "{cell} {order}: the survey saw all but {found} of 40");
        }
    }
}

/// An element without any volume, in a coordinate plane, has `J = 0` exactly.
#[test]
fn flat_elements_are_invalid() {
    for cell in Cell::VOLUME {
        for order in Order::all() {
            let corners = unit_corners(cell);
            let points: Vec<DVec3> = straight(cell, order, &corners).iter().map(|x| x.with_z(0.1)).collect();
            let finding = examine(cell, order, &points, Some(&corners));
            assert!(matches!(finding.verdict, Verdict::Invalid { .. }), "{cell} {order} {finding:?}");
        }
    }
}

/// Nodes that are not finite, all alike, or of the wrong number are no proof of anything.
#[test]
fn nonsense_is_undecided() {
    let (cell, order) = (Cell::Prism, Order::MAX);
    let good = straight(cell, order, &unit_corners(cell));
    let mut broken = good.clone();
    broken[7].y = f64::NAN;
    let mut far = good.clone();
    far[3] = DVec3::splat(f64::MAX);
    let alike = vec![DVec3::ONE; good.len()];
    for points in [&broken[..], &far[..], &alike[..], &good[1..], &[]] {
        assert_eq!(examine(cell, order, points, None).verdict, Verdict::Undecided);
    }
    let corners = vec![DVec3::INFINITY; 6];
    let finding = examine(cell, order, &good, Some(&corners));
    assert_eq!(finding.verdict, Verdict::Valid, "without a reference the verdict stands");
    assert_eq!(finding.relative, super::Bounds::UNKNOWN);
}

/// Sizes from 1e-80 to 1e80 give the same findings, as all is scaled by powers of two.
#[test]
fn size_does_not_matter() {
    let mut random = Random(8);
    for cell in Cell::VOLUME {
        let order = Order::MAX;
        let points: Vec<DVec3> =
            straight(cell, order, &unit_corners(cell)).iter().map(|&x| x + random.vector() * 0.01).collect();
        let expected = examine(cell, order, &points, None);
        for power in [-260, -30, 30, 260] {
            let scaled: Vec<DVec3> = points.iter().map(|&x| x * 2f64.powi(power)).collect();
            assert_eq!(examine(cell, order, &scaled, None), expected, "{cell} 2^{power}");
        }
    }
}
