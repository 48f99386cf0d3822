//! The smallest value of a measure over a mesh: which elements may have it, and which is it.

use rayon::prelude::*;

use super::judged::Judged;
use super::{Bounds, Finding, Judge, Settings, Shape};
use crate::mesh::ElementId;

/// How many of the worst elements are listed.
const LISTED: usize = 10;

/// Wanted distance of the bounds of a mesh's minima.
pub(super) const SHARP: f64 = 1e-3;

/// What is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    /// The minimum of `J / J_c`.
    Relative,
    /// The scaled Jacobian.
    Scaled,
}

impl Measure {
    fn of(self, finding: &mut Finding) -> &mut Bounds {
        match self {
            Measure::Relative => &mut finding.relative,
            Measure::Scaled => &mut finding.scaled,
        }
    }

    /// An element's bounds to a finer gap.
    pub(super) fn sharpened(self, judge: &mut Judge, shape: &Shape, settings: &Settings) -> Bounds {
        match self {
            Measure::Relative => judge.examine(shape, settings).relative,
            Measure::Scaled => judge.scaled(shape, settings),
        }
    }
}

/// The elements that may have the smallest value, and the [`LISTED`] lowest of the others.
#[derive(Clone, Debug)]
pub(super) struct Contest {
    measure: Measure,
    entries: Vec<(Bounds, Judged)>,
    /// The smallest attained value.
    best: Bounds,
    /// Smallest lower bound of all that were left out.
    left_out: f64,
    /// Lower bounds from here on are of no interest.
    cutoff: f64,
    /// Number of entries at which to trim.
    room: usize,
}

impl Contest {
    pub(super) fn new(measure: Measure) -> Contest {
        let best = Bounds { lower: f64::INFINITY, ..Bounds::UNKNOWN };
        Contest { measure, entries: Vec::new(), best, left_out: f64::INFINITY, cutoff: f64::INFINITY, room: 8 * LISTED }
    }

    pub(super) fn measure(&self) -> Measure {
        self.measure
    }

    /// Enters an element, unless nothing is known of it.
    pub(super) fn add(&mut self, mut judged: Judged) {
        let bounds = *self.measure.of(&mut judged.finding);
        if bounds == Bounds::UNKNOWN {
            return;
        }
        self.attain(bounds);
        if bounds.lower >= self.cutoff {
            self.left_out = self.left_out.min(bounds.lower);
            return;
        }
        self.entries.push((bounds, judged));
        if self.entries.len() >= self.room {
            self.trim();
        }
    }

    fn attain(&mut self, bounds: Bounds) {
        if bounds.upper < self.best.upper {
            self.best = bounds;
        }
    }

    pub(super) fn merge(&mut self, other: Contest) {
        self.entries.extend(other.entries);
        self.attain(other.best);
        self.left_out = self.left_out.min(other.left_out);
        if self.entries.len() >= self.room {
            self.trim();
        }
    }

    /// Leaves out what cannot have the smallest value, nor is among the lowest.
    pub(super) fn trim(&mut self) {
        self.sort();
        let able = self.entries.partition_point(|(bounds, _)| bounds.lower < self.best.upper - SHARP);
        let kept = able.max(LISTED).min(self.entries.len());
        for (bounds, _) in self.entries.drain(kept..) {
            self.left_out = self.left_out.min(bounds.lower);
        }
        if let Some((last, _)) = self.entries.get(LISTED - 1) {
            self.cutoff = last.lower.max(self.best.upper - SHARP);
        }
        self.room = 2 * self.entries.len() + 8 * LISTED;
    }

    fn sort(&mut self) {
        self.entries.sort_by(|(a, x), (b, y)| a.lower.total_cmp(&b.lower).then(x.element.cmp(&y.element)));
    }

    /// Narrows the bounds of all entries.
    pub(super) fn sharpen<B: Default>(&mut self, bounds_of: impl Fn(&Judged, &mut B) -> Bounds + Sync) {
        let measure = self.measure;
        self.entries.par_iter_mut().for_each_init(B::default, |bench, (bounds, judged)| {
            let new = bounds_of(judged, bench);
            bounds.lower = bounds.lower.max(new.lower);
            if new.upper < bounds.upper {
                (bounds.upper, bounds.at) = (new.upper, new.at);
            }
            *measure.of(&mut judged.finding) = *bounds;
        });
        for place in 0..self.entries.len() {
            self.attain(self.entries[place].0);
        }
        self.sort();
    }

    /// The elements that were sharpened, with the lower bounds of their values.
    pub(super) fn lower_bounds(&self) -> impl Iterator<Item = (ElementId, f64)> {
        self.entries.iter().map(|(bounds, judged)| (judged.element, bounds.lower))
    }

    /// Bounds of the smallest value, and the worst elements.
    pub(super) fn end(self) -> (Bounds, Vec<Judged>) {
        let lower = self.entries.first().map_or(f64::INFINITY, |(bounds, _)| bounds.lower).min(self.left_out);
        let worst = self.entries.into_iter().take(LISTED).map(|(_, judged)| judged).collect();
        (Bounds { lower, ..self.best }, worst)
    }
}
