//! The state of a recovery, and its way back.

use glam::DVec3;
use rayon::prelude::*;

use super::backtrack::{Fallback, backtrack};
use super::off_cad::{OffCadFace, off_cad_faces};
use super::spot::Spot;
use crate::curve::below::Below;
use crate::curve::curvability::impossible_corners;
use crate::curve::level::Level;
use crate::curve::perturb::perturb;
use crate::curve::proof::Proof;
use crate::curve::smoothing::smooth_level;
use crate::element::Order;
use crate::mesh::ElementId;
use crate::smooth::{self, Begin, Known, Problem, Smoothed, Watch};

/// Rounds in which the displacement is reduced; the fraction that stays is halved from one to the next, and none is left in the
/// last.
const ROUNDS: usize = 4;
/// Sweeps of one smoothing in recovery.
pub(super) const SWEEPS: usize = 60;

/// What recovery led to.
#[derive(Clone, Debug)]
pub struct Recovered {
    /// Wall faces that are off the CAD.
    pub off_cad: Vec<OffCadFace>,
    /// What is proven of the mesh.
    pub proof: Proof,
}

/// A mesh on its way to a proof.
pub(super) struct Recovery<'l, 'a> {
    pub(super) level: &'l mut Level<'a>,
    pub(super) smoothed: &'l mut Smoothed,
    /// What is proven of the level as it is.
    pub(super) proof: Proof,
    /// The curved mesh of the order below, where there is one.
    pub(super) below: Option<&'l Below>,
    /// Where walls go back to.
    pub(super) fallback: Fallback,
    /// Costs of states that the level was in, one of each density.
    known: Vec<Known>,
    pub(super) watch: &'l mut dyn Watch,
}

/// Makes a smoothed level valid, and better where a cost is below the floor; `proof` is that of the level as it is, `below` the curved
/// mesh of the order below, where there is one.
pub fn recover<'l>(
    level: &'l mut Level,
    smoothed: &'l mut Smoothed,
    below: Option<&'l Below>,
    proof: Proof,
    watch: &'l mut dyn Watch,
) -> Recovered {
    let fallback = fallback(level, below);
    let order = fallback.order;
    let mut recovery = Recovery { level, smoothed, proof, below, fallback, known: Vec::new(), watch };
    let own = recovery.level.case.settings;
    recovery.know(&own.smoothing);
    recovery.again();
    recovery.release_or_round_trip();
    recovery.back();
    let untouched = recovery.proof.holds() && recovery.level.wall.is_all_the_way();
    recovery.backtrack();
    recovery.forward();
    let Recovery { level, smoothed, proof, .. } = recovery;
    if !untouched {
        let problem = Problem::new(level.mesh(), level.straight());
        smoothed.survey(&problem, &level.curved, level.case.settings.smoothing.survey_factor);
    }
    let off_cad = off_cad_faces(level, order, |n| level.wall.fraction(n));
    Recovered { off_cad, proof }
}

/// The curved mesh of the order below where it is proven valid, otherwise the straight one.
fn fallback(level: &mut Level, below: Option<&Below>) -> Fallback {
    let straight = level.straight();
    if let Some(below) = below {
        let mut positions = below.raised(level.mesh());
        positions.iter_mut().zip(straight).for_each(|(position, straight)| *position += *straight);
        level.periodic.apply(&mut positions);
        let curved = std::mem::replace(&mut level.curved, positions);
        let holds = Proof::of(level).holds();
        let positions = std::mem::replace(&mut level.curved, curved);
        if holds {
            return Fallback { order: below.order, positions };
        }
    }
    Fallback { order: Order::LINEAR, positions: level.straight().to_vec() }
}

impl Recovery<'_, '_> {
    /// Settings of a smoothing that looks closer.
    pub(super) fn closer(&self) -> smooth::Settings {
        let own = &self.level.case.settings.smoothing;
        let max_sweeps = SWEEPS.min(own.max_sweeps);
        smooth::Settings { survey_factor: 2 * own.survey_factor, max_sweeps, ..own.clone() }
    }

    /// Smooths again where elements fail; smoothing does not look at folds of faces.
    fn again(&mut self) {
        if !self.proof.certificate.holds() && !self.smoothed.stopped {
            self.smooth_again(&self.closer());
        }
    }

    /// Releases wall nodes; where some end off the CAD though no corner of the wall is impossible, the way back and forward again is tried
    /// instead.
    fn release_or_round_trip(&mut self) {
        let kept = (!self.proof.holds() && impossible_corners(self.level).is_empty()).then(|| self.kept());
        self.release();
        let Some(kept) = kept.filter(|_| self.proof.holds() && self.level.wall.released().next().is_some()) else {
            return;
        };
        let released = self.kept();
        self.restore(kept);
        self.back();
        self.forward();
        let is_on_cad = self.proof.holds() && self.level.wall.is_all_the_way();
        if !is_on_cad || self.smoothed.end.worst() < self.level.case.settings.floor {
            self.restore(released);
        }
    }

    /// Takes back around what fails.
    fn back(&mut self) {
        let settings = self.closer();
        for round in 1..=ROUNDS {
            let failing = self.proof.failing(self.level);
            if failing.is_empty() || self.smoothed.stopped {
                break; // a face may fail that no element stands on
            }
            self.take_back(round, &failing);
            self.smooth_again(&settings);
        }
    }

    /// Smooths with the wall nodes held that are off the CAD, and judges what comes out.
    pub(super) fn smooth_again(&mut self, settings: &smooth::Settings) {
        let dense = self.known.iter().filter(|known| known.factor() <= settings.survey_factor);
        let known = dense.max_by_key(|known| known.factor());
        let again = smooth_level(self.level, settings, known.map_or(Begin::Anew, Begin::Knowing), self.watch);
        self.smoothed.sweeps += again.sweeps;
        self.smoothed.stopped |= again.stopped;
        self.smoothed.costs = again.costs;
        self.smoothed.end = again.end;
        self.know(settings);
        self.proof = Proof::of(self.level);
    }

    /// Keeps the costs of the level as it is, which were smoothed to with these settings.
    fn know(&mut self, settings: &smooth::Settings) {
        let problem = Problem::new(self.level.mesh(), self.level.straight());
        let known = Known::of(&problem, settings, self.level.curved.clone(), self.smoothed.costs.clone());
        self.known.retain(|own| own.factor() != known.factor());
        self.known.push(known);
    }

    /// Takes the displacement back around the elements that fail.
    fn take_back(&mut self, round: usize, failing: &[ElementId]) {
        let keep = if round == ROUNDS { 0.0 } else { 0.5 };
        let mut fractions = self.fractions_around(failing, round, keep);
        self.level.periodic.least(&mut fractions);
        let carried = (self.fallback.order == Order::LINEAR).then(|| self.carried());
        let mut back = Vec::new();
        for (n, fraction) in fractions.into_iter().enumerate().filter(|(_, fraction)| *fraction < 1.0) {
            if self.level.on_curved_wall(n) {
                self.level.wall.take_back(n, fraction, self.level.curved[n]);
                back.push(n);
            } else if carried.is_none() {
                self.level.curved[n] = self.fallback.positions[n].lerp(self.level.curved[n], fraction);
            }
        }
        self.follow(&back, carried);
    }

    /// [`backtrack`](super::backtrack), where the proof does not hold.
    fn backtrack(&mut self) {
        if self.proof.holds() {
            return;
        }
        let curved = self.level.curved.clone();
        let (fractions, proof) = backtrack(self.level, &self.fallback, self.proof.clone());
        self.proof = proof;
        for (n, &fraction) in fractions.iter().enumerate().filter(|(_, fraction)| **fraction < 1.0) {
            if self.level.on_curved_wall(n) {
                self.level.wall.take_back(n, fraction, curved[n]);
                self.place(n); // its position stays the one that was proven, to the bit
            }
        }
        let problem = Problem::new(self.level.mesh(), self.level.straight());
        self.smoothed.survey(&problem, &self.level.curved, self.level.case.settings.smoothing.survey_factor);
    }

    /// Puts wall nodes where they are on their way; the others go with them from where the walls `carried` them before, or stay.
    pub(super) fn follow(&mut self, nodes: &[usize], carried: Option<Vec<DVec3>>) {
        for &n in nodes {
            if let Some(position) = self.place(n) {
                self.level.curved[n] = position;
            }
        }
        match carried {
            Some(before) => self.carry_on(&before),
            None => self.level.periodic.apply(&mut self.level.curved),
        }
    }

    /// Moves the nodes off curved walls by what the walls' displacement carries them farther than `before`.
    pub(super) fn carry_on(&mut self, before: &[DVec3]) {
        let after = self.carried();
        for n in 0..after.len() {
            if !self.level.on_curved_wall(n) {
                self.level.curved[n] += after[n] - before[n];
            }
        }
        self.level.periodic.apply(&mut self.level.curved);
    }

    /// Takes the displacement of a wall node from its way; its position there.
    fn place(&mut self, node: usize) -> Option<DVec3> {
        let straight = self.level.straight()[node];
        self.level.wall.place(node, self.fallback.positions[node], straight)
    }

    /// Positions of all nodes as the walls' displacement carries them.
    pub(super) fn carried(&self) -> Vec<DVec3> {
        perturb(self.level, self.level.wall.displacements())
    }

    /// What each node keeps where `keep` is kept around some elements.
    pub(super) fn fractions_around(&self, elements: &[ElementId], times: usize, keep: f64) -> Vec<f64> {
        let straight = self.level.straight();
        let on_wall = (0..straight.len()).filter(|&n| self.level.on_curved_wall(n));
        let wall: Vec<DVec3> = on_wall.map(|n| straight[n]).collect();
        let spots = Spot::around(elements, self.level.mesh(), &wall, times);
        let fraction = |x: &DVec3| spots.iter().map(|spot| spot.fraction(*x, keep)).fold(1.0, f64::min);
        straight.par_iter().map(fraction).collect()
    }
}
