//! What is done where elements are not proven valid, or faces on the CAD not free of folds, after smoothing (`docs/theory.md`, section 11): never a worse
//! mesh.
//!
//! 1. Smooth again, with surveys twice as dense, where elements fail.
//! 2. Take the displacement back around the failing elements, at first by half, more from round to round, with a share that
//!    falls smoothly with the distance, and smooth again; wall nodes that are off the CAD stay where they were put.
//! 3. [`backtrack`], element by element, which ends in a valid mesh whatever came before.
//! 4. Forward again what was taken back, step by step, as far as the mesh stays proven ([`forward`]).
//!
//! Back means to the curved mesh of the order below, where that is proven valid: on it the wall follows the CAD as well as that order
//! can, and all nodes go back together. Otherwise it means the straight mesh: the wall goes back, and the volume is carried along as
//! by the first perturbation, so that layers move whole. The torus at scale 0.5, whose prisms lean by up to 88 degrees off their own
//! faces, is inverted at P3 after 20 sweeps; by way of P2 it then comes to the CAD with C_JAC 0.35, by way of the straight mesh with
//! 0.08 (`tests/fallback.rs`).

pub mod backtrack;
mod forward;
mod spot;
mod way;

use glam::DVec3;
use rayon::prelude::*;

use crate::associate::{Association, Classification};
use crate::curve::Job;
use crate::curve::orders::{Fall, Ready};
use crate::curve::periodic::PeriodicConstraint;
use crate::curve::perturb::perturb;
use crate::curve::proof::Proof;
use crate::curve::recover::backtrack::{Fallback, GivenUp, given_up, retreat};
use crate::curve::wall::{CadConstraint, Projected};
use crate::element::Order;
use crate::mesh::Boundary;
use crate::mesh::elevate::Elevated;
use crate::smooth::{self, Problem, Progress, Smoothed, smooth};
use spot::Spot;
use way::{Held, Way};

/// Rounds of the second rung; the share that stays is halved from one to the next, and none is left in the last.
const ROUNDS: usize = 4;
/// Sweeps of one smoothing on the ladder.
const SWEEPS: usize = 60;

/// The mesh on its way to a proof.
pub(crate) struct Ladder<'a, 'f> {
    /// The straight mesh of order p.
    elevated: &'a mut Elevated,
    boundary: &'a Boundary,
    association: &'a Association,
    periodic: &'a PeriodicConstraint,
    projected: &'a mut Projected,
    settings: &'a smooth::Settings,
    freeze_walls: bool,
    freeze_linear: bool,
    /// The curved mesh of the order below.
    below: &'a mut Fall<'f>,
}

/// What the ladder led to.
pub(crate) struct Climbed {
    /// Wall faces that are off the CAD.
    pub given_up: Vec<GivenUp>,
    /// What is proven of the mesh.
    pub proof: Proof,
    /// The straight places of all nodes.
    pub straight: Vec<DVec3>,
}

/// Where the nodes are, and what is proven of the mesh there.
#[derive(Clone)]
struct Standing {
    places: Vec<DVec3>,
    way: Way,
    proof: Proof,
    smoothed: Smoothed,
}

impl<'a, 'f> Ladder<'a, 'f> {
    /// For the mesh of one order of a job.
    pub(crate) fn new(
        job: &'a Job,
        boundary: &'a Boundary,
        association: &'a Association,
        ready: &'a mut Ready,
        below: &'a mut Fall<'f>,
    ) -> Ladder<'a, 'f> {
        let Ready { elevated, periodic, projected, .. } = ready;
        let Job { smoothing: settings, freeze_walls, freeze_linear, .. } = job;
        let (freeze_walls, freeze_linear) = (*freeze_walls, *freeze_linear);
        Ladder { elevated, boundary, association, periodic, projected, settings, freeze_walls, freeze_linear, below }
    }

    /// Makes the smoothed places valid, and leaves them in `elevated.mesh.points`.
    pub(crate) fn climb(
        mut self,
        mut places: Vec<DVec3>,
        smoothed: &mut Smoothed,
        mut watch: impl FnMut(Progress) -> bool,
    ) -> Climbed {
        let proof = self.proof(&mut places);
        if proof.holds() {
            let straight = std::mem::replace(&mut self.elevated.mesh.points, places);
            return Climbed { given_up: Vec::new(), proof, straight };
        }
        let fallback = self.fallback(&mut watch);
        let way = Way::new(fallback, &places, &self.projected.displacement);
        let mut now = Standing { places, way, proof, smoothed: smoothed.clone() };
        self.down(&mut now, &mut watch);
        let untouched = now.proof.holds() && now.way.is_done();
        self.retreat(&mut now);
        self.advance(&mut now, &mut watch);
        let Standing { places, way, proof, smoothed: ended } = now;
        *smoothed = ended;
        let mesh = &mut self.elevated.mesh;
        let straight = std::mem::replace(&mut mesh.points, places);
        if !untouched {
            smoothed.survey(&Problem::new(mesh, &straight), &mesh.points, self.settings.survey_factor);
        }
        let given_up = given_up(mesh, self.boundary, self.association, &way.shares, way.fallback.order);
        Climbed { given_up, proof, straight }
    }

    /// The first two rungs.
    fn down(&mut self, now: &mut Standing, watch: &mut impl FnMut(Progress) -> bool) {
        let settings = smooth::Settings {
            survey_factor: 2 * self.settings.survey_factor,
            max_sweeps: SWEEPS.min(self.settings.max_sweeps),
            ..self.settings.clone()
        };
        for rung in 0..=ROUNDS {
            let failing = now.proof.failing(&self.elevated.mesh, self.boundary);
            if failing.is_empty() || now.smoothed.stopped {
                break; // a face may fail that no element stands on
            }
            if rung > 0 {
                self.take_back(rung, &failing, now);
            } else if now.proof.certificate.holds() {
                continue; // smoothing does not look at folds of faces
            }
            self.smooth_again(&settings, now, watch);
        }
    }

    /// What is proven of the mesh with its nodes at `places`.
    fn proof(&mut self, places: &mut Vec<DVec3>) -> Proof {
        let mesh = &mut self.elevated.mesh;
        std::mem::swap(&mut mesh.points, places);
        let proof = Proof::of(mesh, &places[..self.elevated.linear_nodes], self.boundary, self.association);
        std::mem::swap(&mut mesh.points, places);
        proof
    }

    /// Smooths with the wall nodes held that are off the CAD, and judges what comes out.
    fn smooth_again(
        &mut self,
        settings: &smooth::Settings,
        now: &mut Standing,
        watch: &mut impl FnMut(Progress) -> bool,
    ) {
        let (mesh, linear) = (&self.elevated.mesh, self.elevated.linear_nodes);
        let wall = CadConstraint::new(
            self.association,
            &mesh.points,
            self.projected,
            self.periodic,
            linear,
            self.freeze_walls,
            self.freeze_linear,
        );
        let held = Held { wall, shares: &now.way.shares };
        let again = smooth(&Problem::new(mesh, &mesh.points), &held, settings, &mut now.places, None, watch);
        let smoothed = &mut now.smoothed;
        smoothed.sweeps += again.sweeps;
        smoothed.stopped |= again.stopped;
        smoothed.costs = again.costs;
        smoothed.end = again.end;
        now.proof = self.proof(&mut now.places);
    }

    /// The curved mesh of the order below where it is proven valid, otherwise the straight one.
    fn fallback(&mut self, watch: &mut dyn FnMut(Progress) -> bool) -> Fallback {
        let straight = self.elevated.mesh.points.clone();
        if let Some(below) = self.below.below(watch) {
            let mut places = below.raised(&self.elevated.mesh);
            places.iter_mut().zip(&straight).for_each(|(place, straight)| *place += *straight);
            let order = below.order;
            self.periodic.apply(&mut places);
            if self.proof(&mut places).holds() {
                return Fallback { order, places };
            }
        }
        Fallback { order: Order::LINEAR, places: straight }
    }

    /// Takes the displacement back around the elements that fail.
    fn take_back(&mut self, round: usize, failing: &[usize], now: &mut Standing) {
        let keep = if round == ROUNDS { 0.0 } else { 0.5 };
        let mut own = self.shares_around(failing, round, keep);
        self.periodic.least(&mut own);
        let carried = (now.way.fallback.order == Order::LINEAR).then(|| self.carried());
        let on_wall = |n: usize| self.on_wall(n);
        let changed: Vec<(usize, f64)> = own.into_iter().enumerate().filter(|(_, share)| *share < 1.0).collect();
        let mut back = Vec::new();
        for (n, share) in changed {
            if on_wall(n) {
                now.way.take_back(n, share, now.places[n]);
                back.push(n);
            } else if carried.is_none() {
                now.places[n] = now.way.fallback.places[n].lerp(now.places[n], share);
            }
        }
        self.follow(&back, carried, now);
    }

    /// [`backtrack`], where the proof does not hold.
    fn retreat(&mut self, now: &mut Standing) {
        if now.proof.holds() {
            return;
        }
        let curved = now.places.clone();
        let mesh = &mut self.elevated.mesh;
        let straight = std::mem::replace(&mut mesh.points, std::mem::take(&mut now.places));
        let linear = &straight[..self.elevated.linear_nodes];
        let (fallback, before) = (&now.way.fallback, now.proof.clone());
        let (shares, proof) = retreat(mesh, fallback, linear, self.boundary, self.association, self.periodic, before);
        now.places = std::mem::replace(&mut mesh.points, straight);
        now.proof = proof;
        let back: Vec<usize> = (0..shares.len()).filter(|&n| shares[n] < 1.0 && self.on_wall(n)).collect();
        back.iter().for_each(|&n| now.way.take_back(n, shares[n], curved[n]));
        self.displace(&back, &now.way); // the places stay those that were proven, to the bit
    }

    /// Puts wall nodes where they are on their way; the others go with them from where the walls `carried` them before, or stay.
    fn follow(&mut self, nodes: &[usize], carried: Option<Vec<DVec3>>, now: &mut Standing) {
        nodes.iter().for_each(|&n| now.places[n] = now.way.place(n));
        self.displace(nodes, &now.way);
        if let Some(before) = carried {
            let after = self.carried();
            for n in (0..after.len()).filter(|&n| !self.on_wall(n)) {
                now.places[n] += after[n] - before[n];
            }
        }
        self.periodic.apply(&mut now.places);
    }

    /// Takes the displacements of nodes from their way.
    fn displace(&mut self, nodes: &[usize], way: &Way) {
        for &n in nodes {
            if let Some(displacement) = self.projected.displacement.get_mut(n) {
                *displacement = way.displacement(n, self.elevated.mesh.points[n]);
            }
        }
    }

    /// Places of all nodes as the walls' displacement carries them.
    fn carried(&self) -> Vec<DVec3> {
        perturb(self.elevated, self.boundary, self.association, self.projected, self.periodic)
    }

    fn on_wall(&self, node: usize) -> bool {
        let classification = self.projected.classification(node);
        matches!(classification, Classification::Surface(_) | Classification::Curve(_) | Classification::Vertex(_))
            && self.association.plane_of(classification).is_none()
    }

    /// What each node keeps where `keep` is kept around some elements.
    fn shares_around(&self, elements: &[usize], times: usize, keep: f64) -> Vec<f64> {
        let straight = &self.elevated.mesh.points;
        let wall: Vec<DVec3> = (0..straight.len()).filter(|&n| self.on_wall(n)).map(|n| straight[n]).collect();
        let spots = Spot::around(elements, &self.elevated.mesh, &wall, times);
        let share = |x: &DVec3| spots.iter().map(|spot| spot.share(*x, keep)).fold(1.0, f64::min);
        straight.par_iter().map(share).collect()
    }
}
