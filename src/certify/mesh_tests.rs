//! The certificate of whole meshes.

use glam::DVec3;

use super::elements::{Buffer, Elements};
use super::tests::{Random, straight, unit_corners};
use super::{Bounds, Certificate, Method, Settings, Verdict, certify, mesh};
use crate::element::{Cell, Order};
use crate::mesh::elevate::elevate;
use crate::mesh::{Block, ElementId, EntityKey, Mesh, NodeId, Parts};

/// Curved elements of one kind after another, each with its own nodes.
struct Loose {
    elements: Vec<(Cell, Order, Vec<DVec3>, Vec<DVec3>)>,
}

impl Elements for Loose {
    fn count(&self) -> usize {
        self.elements.len()
    }

    fn id(&self, place: usize) -> ElementId {
        ElementId::new(place).unwrap_or_default()
    }

    fn place(&self, element: ElementId) -> usize {
        element.index()
    }

    fn read(&self, element: ElementId, into: &mut Buffer) -> (Cell, Order) {
        let (cell, order, points, corners) = &self.elements[element.index()];
        into.points.extend_from_slice(points);
        into.corners.extend_from_slice(corners);
        (*cell, *order)
    }
}

/// Random elements of all kinds; every `straight_each`-th is straight.
fn loose(seed: u64, count: usize, order: Option<Order>, amount: f64) -> Loose {
    let mut random = Random(seed);
    let orders: Vec<Order> = Order::all().collect();
    let element = |n: usize| {
        let cell = Cell::VOLUME[n % 4];
        let order = order.unwrap_or(orders[n / 4 % 4]);
        let corners: Vec<DVec3> = unit_corners(cell).iter().map(|&x| x + random.vector() * 0.05).collect();
        let amount = if n.is_multiple_of(3) { 0.0 } else { amount * random.unit() };
        let points = straight(cell, order, &corners).iter().map(|&x| x + random.vector() * amount).collect();
        (cell, order, points, corners)
    };
    Loose { elements: (0..count).map(element).collect() }
}

#[test]
fn the_certificate_is_the_same_for_any_number_of_threads() {
    let loose = loose(3, 5000, None, 0.06);
    let run = |threads: usize| -> Option<Certificate> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().ok()?;
        Some(pool.install(|| certify(&loose, &Settings::default())))
    };
    let one = run(1);
    assert!(one.as_ref().is_some_and(|c| c.tallies().map(|(_, t)| t.elements).sum::<usize>() == 5000));
    for threads in [2, 7] {
        assert!(format!("{:?}", run(threads)) == format!("{one:?}"), "{threads} threads");
    }
}

#[test]
fn a_meshes_minimum_is_that_of_its_elements() {
    let loose = loose(4, 600, None, 0.012);
    let certificate = certify(&loose, &Settings::default());
    let sharp = Settings { gap: 1e-4, ..Settings::default() };
    let mut judge = super::Judge::default();
    let (mut relative, mut scaled) = (f64::INFINITY, f64::INFINITY);
    for (cell, order, points, corners) in &loose.elements {
        let shape = super::Shape { cell: *cell, order: *order, points, corners: Some(corners), upright: &[] };
        let finding = judge.examine(&shape, &sharp);
        if let Verdict::Invalid { .. } = finding.verdict {
            continue;
        }
        relative = relative.min(finding.relative.upper);
        scaled = scaled.min(judge.scaled(&shape, &sharp).upper);
    }
    assert!(certificate.holds(), "{} failures", certificate.failures.len());
    for (bounds, least) in [(certificate.relative, relative), (certificate.scaled, scaled)] {
        assert!(
            bounds.lower <= least && bounds.upper >= least - 2e-4 && bounds.upper - bounds.lower < 2e-3,
            "{bounds:?} {least}"
        );
    }
    let of_elements = certificate.minima.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(of_elements.to_bits(), certificate.relative.lower.to_bits(), "one proven minimum");
    assert_eq!(certificate.worst_relative.len(), 10);
    assert!(certificate.worst_relative[0].finding.relative.lower >= certificate.relative.lower);
    assert!(certificate.worst_relative.iter().all(|judged| judged.place.is_finite()));
}

/// A row of unit cubes along x, elevated, with one node of the third pulled out.
#[test]
fn a_mesh_is_read_by_its_blocks() -> Result<(), Box<dyn std::error::Error>> {
    let corner = |n: usize| [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[y, z]: [usize; 2]| 4 * n + 2 * z + y);
    let id = |n: usize| NodeId::new(n);
    let mut nodes = Vec::new();
    for n in 0..5 {
        let [a, b] = [corner(n), corner(n + 1)];
        nodes.extend(a.into_iter().chain(b).map(id).collect::<Result<Vec<_>, _>>()?);
    }
    let points: Vec<DVec3> = (0..24).map(|n| DVec3::new((n / 4) as f64, (n % 2) as f64, (n / 2 % 2) as f64)).collect();
    let block = Block { tags: (1..=5).collect(), nodes, ..Block::new(Cell::Hex, EntityKey::new(3, 1)) };
    let linear = Mesh::new(Parts { points: points.clone(), blocks: vec![block], ..Parts::default() })?;
    let mut curved = elevate(&linear, Order::new(2)?)?.mesh;
    let certificate = mesh(&curved, curved.points(), Some(&points), &Settings::default());
    assert!(certificate.holds() && certificate.tally(Cell::Hex).straight == 5);
    assert!((certificate.relative.lower - 1.0).abs() < 1e-9);
    let inner = curved.cells().nodes(ElementId::new(2)?)[26];
    curved.points_mut()[inner.index()] += DVec3::new(0.6, 0.0, 0.0);
    let certificate = mesh(&curved, curved.points(), Some(&points), &Settings::default());
    assert_eq!(certificate.failures.len(), 1);
    let failure = certificate.failures[0];
    assert_eq!((failure.element, certificate.tally(Cell::Hex).invalid), (ElementId::new(2)?, 1));
    assert!((2.0..=3.0).contains(&failure.place.x), "{failure:?}");
    assert!(certificate.relative.lower < 0.0 && certificate.relative != Bounds::UNKNOWN);
    assert_eq!(mesh(&curved, curved.points(), None, &Settings::default()).failures.len(), 1);
    Ok(())
}

/// Prints elements a second for easy elements: `cargo test --release certify -- --ignored --nocapture speed`.
#[test]
#[ignore = "a measurement"]
fn speed() {
    let settings = Settings::default();
    for order in Order::all().skip(1) {
        for cell in Cell::VOLUME {
            for amount in [0.0, 0.01, 0.03] {
                let mut loose = loose(9, 4 * 6000, Some(order), amount);
                loose.elements.retain(|element| element.0 == cell);
                let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
                let start = std::time::Instant::now();
                let Ok(certificate) = pool.map(|pool| pool.install(|| certify(&loose, &settings))) else { return };
                let tally = certificate.tally(cell);
                let rate = tally.elements as f64 / start.elapsed().as_secs_f64();
                println!("{cell:8} {order} noise {amount}: {rate:9.0} a second, {tally:?}");
                assert_eq!(tally.straight > 2 * tally.elements / 3, amount == 0.0);
                assert!(certificate.tallies().all(|(_, t)| t.double == 0 || Method::Double != Method::Simple));
            }
        }
    }
}
