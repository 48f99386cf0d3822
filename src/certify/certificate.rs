//! The certificate of a mesh: every element judged, in parallel and in a fixed order.

use glam::DVec3;
use rayon::prelude::*;

use super::contest::{Contest, Measure, SHARP};
use super::elements::{Buffer, Elements, MeshElements};
use super::judged::Judged;
use super::{Bounds, Finding, Judge, Method, Settings, Shape, Verdict};
use crate::element::{Cell, basis};
use crate::mesh::{ElementId, Mesh};

/// Elements judged in one go by one thread.
const CHUNK: usize = 1024;

/// Chunks that are judged before what they found is merged: what waits for it does not grow with the mesh.
const BATCH: usize = 64;

/// What is proven of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate {
    /// The unit normal that the faces of a plane mesh are judged against.
    pub normal: Option<DVec3>,
    /// By kind of cell.
    tallies: [Tally; Cell::ALL.len()],
    /// All elements that are not proven valid, in their order.
    pub failures: Vec<Judged>,
    /// For every element, in order, a lower bound of its `J / J_c`; minus infinity where `J_c` is not positive. The least
    /// where all are positive is `relative.lower`.
    pub minima: Vec<f64>,
    /// Bounds of the smallest `J / J_c` of all elements whose `J_c` is positive.
    pub relative: Bounds,
    /// Bounds of the smallest scaled Jacobian.
    pub scaled: Bounds,
    /// The elements with the smallest `J / J_c`, worst first.
    pub worst_relative: Vec<Judged>,
    /// The elements with the smallest scaled Jacobian, worst first.
    pub worst_scaled: Vec<Judged>,
}

/// Counts of the elements of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// All.
    pub elements: usize,
    /// Straight ones, certified by their linear element.
    pub straight: usize,
    /// Those that took more than `f64`.
    pub double: usize,
    /// Proven valid.
    pub valid: usize,
    /// Proven invalid.
    pub invalid: usize,
    /// Neither.
    pub undecided: usize,
    /// Those whose `J_c` is not positive: the linear element is itself invalid.
    pub without_reference: usize,
}

impl Certificate {
    /// Whether there are elements, and every one is proven valid.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.failures.is_empty() && !self.minima.is_empty()
    }

    /// Counts of the elements of each kind that there is, in the order of [`Cell::ALL`].
    pub fn tallies(&self) -> impl Iterator<Item = (Cell, &Tally)> {
        Cell::ALL.into_iter().zip(&self.tallies).filter(|(_, tally)| tally.elements > 0)
    }

    /// Counts of the elements of one kind.
    #[must_use]
    pub fn tally(&self, cell: Cell) -> Tally {
        self.tallies[cell as usize]
    }
}

/// Certifies a mesh with its nodes at `positions`; `linear_corners` are the points of its linear nodes before they were moved,
/// which `J_c` is taken from ([`MeshElements::new`]).
#[must_use]
pub fn mesh(mesh: &Mesh, positions: &[DVec3], linear_corners: Option<&[DVec3]>, settings: &Settings) -> Certificate {
    let elements = MeshElements::new(mesh, positions, linear_corners);
    Certificate { normal: elements.normal(), ..certify(&elements, settings) }
}

/// Certifies a mesh of faces on curved surfaces with its nodes at `positions`, each against the mean normal of its linear face, whose corners
/// are those of `linear`, the points of the linear nodes before they were moved.
#[must_use]
pub fn surface(mesh: &Mesh, positions: &[DVec3], linear: &[DVec3], settings: &Settings) -> Certificate {
    certify(&MeshElements::of_surface(mesh, positions, linear), settings)
}

/// Certifies all elements of a source. The certificate does not depend on the number of threads.
#[must_use]
pub fn certify(elements: &impl Elements, settings: &Settings) -> Certificate {
    let chunks = elements.count().div_ceil(CHUNK);
    let mut all = Summary::default();
    for first in (0..chunks).step_by(BATCH) {
        let summaries: Vec<Summary> = (first..chunks.min(first + BATCH))
            .into_par_iter()
            .map_init(Bench::default, |bench, chunk| {
                let last = elements.count().min((chunk + 1) * CHUNK);
                bench.summary(elements, chunk * CHUNK..last, settings)
            })
            .collect();
        summaries.into_iter().for_each(|summary| all.merge(summary));
        all.trim();
    }
    all.certificate(elements, settings)
}

/// A judge with its buffer.
#[derive(Default)]
pub(super) struct Bench {
    judge: Judge,
    buffer: Buffer,
}

impl Bench {
    /// Reads an element and has something done with its shape.
    pub(super) fn with<R>(
        &mut self,
        elements: &impl Elements,
        element: ElementId,
        work: impl FnOnce(&mut Judge, &Shape) -> R,
    ) -> R {
        self.buffer.points.clear();
        self.buffer.corners.clear();
        self.buffer.normal = None;
        let (cell, order) = elements.read(element, &mut self.buffer);
        let corners = (!self.buffer.corners.is_empty()).then_some(self.buffer.corners.as_slice());
        let upright = self.buffer.normal.as_slice();
        work(&mut self.judge, &Shape { cell, order, points: &self.buffer.points, corners, upright })
    }

    fn summary(&mut self, elements: &impl Elements, range: std::ops::Range<usize>, settings: &Settings) -> Summary {
        let mut summary = Summary::default();
        for element in range.map(|place| elements.id(place)) {
            let judged = self.with(elements, element, |judge, shape| {
                let finding = judge.examine(shape, settings);
                Judged { element, cell: shape.cell, order: shape.order, finding, place: DVec3::NAN }
            });
            summary.add(judged);
        }
        summary.trim();
        summary
    }
}

/// What a run of elements amounts to.
struct Summary {
    tallies: [Tally; Cell::ALL.len()],
    minima: Vec<f64>,
    failures: Vec<Judged>,
    relative: Contest,
    scaled: Contest,
}

impl Default for Summary {
    fn default() -> Summary {
        Summary {
            tallies: Default::default(),
            minima: Vec::new(),
            failures: Vec::new(),
            relative: Contest::new(Measure::Relative),
            scaled: Contest::new(Measure::Scaled),
        }
    }
}

impl Summary {
    fn add(&mut self, judged: Judged) {
        let finding = &judged.finding;
        let tally = &mut self.tallies[judged.cell as usize];
        tally.elements += 1;
        tally.straight += usize::from(finding.method == Method::Straight);
        tally.double += usize::from(finding.method == Method::Double);
        tally.without_reference += usize::from(finding.relative == Bounds::UNKNOWN);
        match finding.verdict {
            Verdict::Valid => tally.valid += 1,
            Verdict::Invalid { .. } => tally.invalid += 1,
            Verdict::Undecided => tally.undecided += 1,
        }
        self.minima.push(finding.relative.lower);
        if !finding.verdict.is_valid() {
            self.failures.push(judged);
        }
        self.relative.add(judged);
        self.scaled.add(judged);
    }

    /// Lets go of what cannot be among the worst.
    fn trim(&mut self) {
        self.relative.trim();
        self.scaled.trim();
    }

    fn merge(&mut self, other: Summary) {
        for (tally, more) in self.tallies.iter_mut().zip(other.tallies) {
            tally.merge(more);
        }
        self.minima.extend(other.minima);
        self.failures.extend(other.failures);
        self.relative.merge(other.relative);
        self.scaled.merge(other.scaled);
    }

    /// Sharpens the minima and finds the places.
    fn certificate(mut self, elements: &impl Elements, settings: &Settings) -> Certificate {
        let sharp = Settings { gap: settings.gap.min(SHARP), ..*settings };
        for contest in [&mut self.relative, &mut self.scaled] {
            contest.trim();
            let measure = contest.measure();
            contest.sharpen(|judged, bench: &mut Bench| {
                bench.with(elements, judged.element, |judge, shape| measure.sharpened(judge, shape, &sharp))
            });
        }
        let mut bench = Bench::default();
        let mut place = |judged: &mut Judged| {
            judged.place = bench.with(elements, judged.element, |_, shape| place(shape, &judged.finding));
        };
        self.failures.iter_mut().for_each(&mut place);
        for (element, lower) in self.relative.lower_bounds() {
            self.minima[elements.place(element)] = lower;
        }
        for failure in &mut self.failures {
            failure.finding.relative.lower = self.minima[elements.place(failure.element)];
        }
        let (relative, mut worst_relative) = self.relative.end();
        let (scaled, mut worst_scaled) = self.scaled.end();
        worst_relative.iter_mut().chain(&mut worst_scaled).for_each(place);
        Certificate {
            normal: None,
            tallies: self.tallies,
            failures: self.failures,
            minima: self.minima,
            relative,
            scaled,
            worst_relative,
            worst_scaled,
        }
    }
}

/// The place of an element's smallest known determinant.
fn place(shape: &Shape, finding: &Finding) -> DVec3 {
    let at = match finding.verdict {
        Verdict::Invalid { at, .. } => at,
        _ if finding.relative.upper.is_finite() => finding.relative.at,
        _ => finding.scaled.at,
    };
    let weights = basis::values(shape.cell, shape.order, at);
    shape.points.iter().zip(weights).map(|(&x, weight)| x * weight).sum()
}

impl Tally {
    fn merge(&mut self, more: Tally) {
        self.elements += more.elements;
        self.straight += more.straight;
        self.double += more.double;
        self.valid += more.valid;
        self.invalid += more.invalid;
        self.undecided += more.undecided;
        self.without_reference += more.without_reference;
    }
}
