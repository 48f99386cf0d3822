//! Random curved elements against dense sampling: the certificate is never contradicted and seldom undecided.

use glam::DVec3;

use super::tests::{Random, inside, straight, unit_corners};
use super::{Finding, Judge, Settings, Shape, Verdict};
use crate::element::{Cell, Order, Samples};

/// Gradient tables at random points, for the order and for order 1.
pub(super) struct Dense {
    cell: Cell,
    order: Order,
    tables: [Samples; 2],
}

impl Dense {
    fn new(cell: Cell, order: Order, count: usize, random: &mut Random) -> Dense {
        let mut points: Vec<[f64; 3]> = (0..count).map(|_| inside(cell, random)).collect();
        points.extend(cell.corners().iter().map(|c| c.map(f64::from)));
        Dense::at(cell, order, points)
    }

    /// At given points in reference coordinates.
    pub(super) fn at(cell: Cell, order: Order, points: Vec<[f64; 3]>) -> Dense {
        Dense { cell, order, tables: [order, Order::LINEAR].map(|order| Samples::new(cell, order, points.clone())) }
    }

    /// Determinants at the points, shifted by the first node.
    fn determinants(&self, table: usize, points: &[DVec3], normal: Option<DVec3>) -> Vec<f64> {
        let samples = &self.tables[table];
        let mut columns = vec![[DVec3::ZERO; 3]; samples.count()];
        for (node, &x) in points.iter().enumerate() {
            let x = x - points[0];
            for (axis, slopes) in samples.gradient(node).into_iter().enumerate() {
                for (column, slope) in columns.iter_mut().zip(slopes) {
                    column[axis] += x * *slope;
                }
            }
        }
        columns.iter().map(|c| c[0].cross(c[1]).dot(normal.unwrap_or(c[2]))).collect()
    }

    /// Smallest sampled `J` and `J / J_c`.
    pub(super) fn least(&self, points: &[DVec3], corners: &[DVec3], normal: Option<DVec3>) -> [f64; 2] {
        let (j, c) = (self.determinants(0, points, normal), self.determinants(1, corners, normal));
        let ratio = j.iter().zip(&c).map(|(j, c)| j / c).fold(f64::INFINITY, f64::min);
        [j.iter().copied().fold(f64::INFINITY, f64::min), ratio]
    }

    /// Largest sampled `J`, as a measure of rounding.
    fn size(&self, points: &[DVec3], normal: Option<DVec3>) -> f64 {
        self.determinants(0, points, normal).iter().fold(0.0, |l, j| f64::max(l, j.abs()))
    }
}

/// A random element: corners and curved nodes.
struct Sample {
    corners: Vec<DVec3>,
    points: Vec<DVec3>,
    /// That of a face's plane.
    normal: Option<DVec3>,
    /// Whether its smallest `J / J_c` was brought near to zero.
    marginal: bool,
}

/// Corners of an isotropic element, a pancake or a needle, in some rotation, possibly far from the origin; and the normal of a
/// face's plane, of either orientation.
fn random_corners(cell: Cell, random: &mut Random) -> (Vec<DVec3>, Option<DVec3>) {
    let kind = random.unit();
    let thin = 10f64.powf(-4.0 * random.unit());
    let stretch = if kind < 0.4 {
        DVec3::ONE
    } else if kind < 0.7 {
        DVec3::new(1.0, 1.0, thin)
    } else {
        DVec3::new(1.0, thin, thin)
    };
    let axis = (random.vector() + DVec3::Z * 0.01).normalize();
    let turn = glam::DMat3::from_axis_angle(axis, random.unit() * 6.0);
    let shift = if random.unit() < 0.3 { random.vector() * 1e3 } else { DVec3::ZERO };
    let is_face = cell.has_jacobian(1);
    let within = if is_face { DVec3::new(1.0, 1.0, 0.0) } else { DVec3::ONE };
    let bend = |x: DVec3, random: &mut Random| turn * ((x + random.vector() * 0.1) * within * stretch) + shift;
    (unit_corners(cell).into_iter().map(|x| bend(x, random)).collect(), is_face.then(|| turn * DVec3::Z))
}

fn sample(dense: &Dense, random: &mut Random) -> Sample {
    let (cell, order) = (dense.cell, dense.order);
    let (corners, normal) = random_corners(cell, random);
    let flat = straight(cell, order, &corners);
    // Noise that follows the shape: a random combination of the element's own edges at every node.
    let frame = cell.edges()[..3].iter().map(|&[a, b]| corners[usize::from(b)] - corners[usize::from(a)]);
    let frame: Vec<DVec3> = frame.collect();
    let noise: Vec<DVec3> = (0..flat.len())
        .map(|_| {
            let weights = random.vector();
            frame[0] * weights.x + frame[1] * weights.y + frame[2] * weights.z
        })
        .collect();
    let at = |t: f64| -> Vec<DVec3> { flat.iter().zip(&noise).map(|(&x, &n)| x + n * t).collect() };
    let marginal = random.unit() < 0.4;
    if !marginal {
        let points = at(random.unit() * 0.15);
        return Sample { corners, points, normal, marginal };
    }
    let target = 1e-3 * (2.0 * random.unit() - 1.0);
    // The minimum as sampling sees it leaves spots between the points; as the certificate sees it, none. Which way an
    // element is made has no part in how it is checked.
    let (sampled, sharp) = (random.unit() < 0.3, Settings { gap: 1e-4, ..Settings::default() });
    let mut judge = Judge::default();
    let mut least = |points: &[DVec3]| {
        let shape = Shape { cell, order, points, corners: Some(&corners), upright: normal.as_slice() };
        if sampled { dense.least(points, &corners, normal)[1] } else { judge.examine(&shape, &sharp).relative.upper }
    };
    let (mut low, mut high) = (0.0, 0.5);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if least(&at(middle)) > target { low = middle } else { high = middle }
    }
    let points = at(low);
    let marginal = least(&points).abs() < 1e-3;
    Sample { corners, points, normal, marginal }
}

/// What a finding may not say.
fn contradiction(dense: &Dense, sample: &Sample, finding: &Finding) -> Option<String> {
    let [least, ratio] = dense.least(&sample.points, &sample.corners, sample.normal);
    let size = dense.size(&sample.points, sample.normal);
    let extent = sample.points.iter().map(|x| x.distance(sample.points[0])).fold(0.0, f64::max);
    let slack = 1e-12 * extent.powi(dense.cell.dimension() as i32) + 1e-9 * size; // the sampling's own rounding
    let relative_slack = slack / dense.size(&sample.corners_as_nodes(dense), sample.normal).max(1e-300);
    if finding.verdict.is_valid() && least < -slack {
        return Some(format!("valid, but J = {least:e}"));
    }
    if finding.relative.lower > ratio + relative_slack {
        return Some(format!("lower bound {}, but sampled {ratio}", finding.relative.lower));
    }
    if let Verdict::Invalid { at, value } = finding.verdict {
        let there = super::tests::jacobian(dense.cell, dense.order, &sample.points, at, sample.normal);
        if there > value + slack || value > 0.0 {
            return Some(format!("J = {value:e} claimed, {there:e} found at {at:?}"));
        }
    }
    None
}

impl Sample {
    fn corners_as_nodes(&self, dense: &Dense) -> Vec<DVec3> {
        straight(dense.cell, dense.order, &self.corners)
    }
}

/// Judges random elements of every kind and order and prints a table.
fn survey(seed: u64, elements: usize, points: usize) {
    println!("seed {seed}");
    let settings = Settings::default();
    for cell in Cell::ALL.into_iter().filter(|cell| cell.dimension() >= 2) {
        let constant = matches!(cell, Cell::Tet | Cell::Triangle);
        for order in Order::all().filter(|&p| p > Order::LINEAR || !constant) {
            let mut random = Random(seed ^ ((cell as u64) << 8) ^ order.get() as u64);
            let (bisected, dense) =
                (Dense::new(cell, order, 1000, &mut random), Dense::new(cell, order, points, &mut random));
            let mut judge = Judge::default();
            let (mut undecided, mut valid, mut marginal, mut pieces) = (0, 0, 0, Vec::new());
            let mut seconds = 0.0;
            for n in 0..elements {
                let sample = sample(&bisected, &mut random);
                let shape = Shape {
                    cell,
                    order,
                    points: &sample.points,
                    corners: Some(&sample.corners),
                    upright: sample.normal.as_slice(),
                };
                let start = std::time::Instant::now();
                let finding = judge.examine(&shape, &settings);
                seconds += start.elapsed().as_secs_f64();
                if let Some(text) = contradiction(&dense, &sample, &finding) {
                    panic!("{cell} {order}, element {n} of seed {seed}: {text}\n{finding:?}");
                }
                undecided += usize::from(finding.verdict == Verdict::Undecided);
                valid += usize::from(finding.verdict.is_valid());
                marginal += usize::from(sample.marginal);
                pieces.push(finding.pieces);
            }
            pieces.sort_unstable();
            let (median, most) = (pieces[elements / 2], pieces[elements - 1]);
            println!(
                "{cell:8} {order}: {elements} elements, {marginal} marginal, {valid} valid, {undecided} undecided, \
                 pieces median {median} max {most}, {:.1} us each",
                seconds / elements as f64 * 1e6
            );
            assert!(undecided * 100 <= elements, "{cell} {order}: {undecided} undecided");
        }
    }
}

#[test]
fn random_elements_are_judged_as_dense_sampling_finds_them() {
    survey(20_261_122, 60, 1000);
}

/// The figures of the documentation: `cargo test --release certify -- --ignored --nocapture`.
#[test]
#[ignore = "minutes"]
fn a_thousand_elements_of_each_kind_against_ten_thousand_points() {
    survey(5, 1000, 10_000);
}
