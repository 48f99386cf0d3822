//! The rounding bound of `f64`, held against coefficients computed in pairs of `f64`.

use glam::{DMat3, DVec3};

use super::judge::{Judge, Shape, frame};
use super::real::Double;
use super::tests::{Random, straight};
use crate::element::{Cell, Order};

/// A bent element: stretched, turned, noisy, far from the origin, by chance.
fn bent(cell: Cell, order: Order, random: &mut Random) -> Vec<DVec3> {
    let flat = DVec3::new(1.0, 1.0, 10f64.powf(-4.0 * random.unit()));
    let turn = DMat3::from_axis_angle(random.vector().normalize_or(DVec3::X), 3.0 * random.unit());
    let offset = random.vector() * 10f64.powf(6.0 * random.unit() - 3.0);
    let corners: Vec<DVec3> = cell.corners().iter().map(|c| DVec3::from(c.map(f64::from)) * flat).collect();
    let noise = 0.1 * random.unit();
    let nodes = straight(cell, order, &corners).into_iter();
    nodes.map(|x| turn * (x + random.vector() * noise * flat) + offset).collect()
}

#[test]
fn the_bound_covers_what_pairs_of_f64_find() {
    let (mut random, mut judge) = (Random(7), Judge::default());
    for cell in Cell::VOLUME {
        for order in Order::all() {
            let mut tightest = 0.0f64;
            for _ in 0..40 {
                let points = bent(cell, order, &mut random);
                let shape = Shape { cell, order, points: &points, corners: None, upright: &[] };
                let frame = frame(&shape).unwrap_or_else(|| unreachable!("a finite element of size 1"));
                let simple = judge.coefficients::<f64>(&shape, frame);
                let coefficients = judge.root.clone();
                let double = judge.coefficients::<Double>(&shape, frame);
                for (own, exact) in coefficients.iter().zip(&judge.root) {
                    let off = (own - exact).abs();
                    assert!(off <= simple.error + double.error, "{cell} {order}: {off:e} > {:e}", simple.error);
                    tightest = tightest.max(off / simple.error);
                }
            }
            println!("{cell} {order}: at most {tightest:.4} of the bound");
            assert!(tightest > 1e-6, "{cell} {order}: nothing was rounded");
        }
    }
}
