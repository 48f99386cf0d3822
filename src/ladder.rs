//! What is done where elements are not proven valid, or faces on the CAD not free of folds, after smoothing (design §7): never a worse
//! mesh.
//!
//! 1. Smooth again, with surveys twice as dense, where elements fail.
//! 2. Take the displacement back around the failing elements, at first by half, more from round to round, with a share that
//!    falls smoothly with the distance, and smooth again; wall nodes that are off the CAD stay where they were put.
//! 3. [`retreat`], element by element, which ends in a valid mesh whatever came before.
//!
//! Back means to the curved mesh of the order below, where that is proven valid: on it the wall follows the CAD as well as that order
//! can, and all nodes go back together. Otherwise it means the straight mesh: the wall goes back, and the volume is carried along as
//! by the first perturbation, so that layers move whole. The torus at scale 0.5, whose prisms lean by up to 88 degrees off their own
//! faces, ended at P3 with C_JAC 0.48 and 100 of its 200 faces between their curves of P2 and P3, before regularisation by element
//! made it valid on the CAD; back to the straight mesh it ended at 0.02, with all faces at a quarter of their curve.

use glam::DVec3;
use rayon::prelude::*;

use crate::ascent::Fall;
use crate::associate::{Association, Boundary, Host};
use crate::element::Order;
use crate::elevate::Elevated;
use crate::mesh::NodeId;
use crate::periodic::Ties;
use crate::perturb::perturb;
use crate::project::{CadConstraint, Projected};
use crate::proof::Proof;
use crate::retreat::{Fallback, GivenUp, given_up, retreat};
use crate::smooth::{self, Anchor, Constraint, Freedom, Image, Problem, Smoothed, smooth};

/// Rounds of the second rung; the share that stays is halved from one to the next, and none is left in the last.
const ROUNDS: usize = 4;
/// Reach of the first round, in distances to the wall plus the failing element's size.
const REACH: f64 = 2.0;
/// Sweeps of one smoothing on the ladder.
const SWEEPS: usize = 60;

/// The mesh on its way to a proof.
pub(crate) struct Ladder<'a> {
    /// The straight mesh of order p.
    pub elevated: &'a mut Elevated,
    /// Its boundary.
    pub boundary: &'a Boundary,
    /// What lies on which CAD group.
    pub association: &'a Association,
    /// Periodic pairs.
    pub ties: &'a Ties,
    /// Hosts and displacements of the boundary nodes.
    pub projected: &'a mut Projected,
    /// The smoother's settings.
    pub settings: &'a smooth::Settings,
    /// Hold nodes on curved walls.
    pub freeze_walls: bool,
    /// Hold linear nodes.
    pub freeze_linear: bool,
    /// The curved mesh of the order below.
    pub below: Option<Fall<'a>>,
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

impl Ladder<'_> {
    /// Makes the smoothed places valid, and leaves them in `elevated.mesh.points`.
    pub(crate) fn climb(
        mut self,
        mut places: Vec<DVec3>,
        smoothed: &mut Smoothed,
        mut watch: impl FnMut(smooth::Progress) -> bool,
    ) -> Climbed {
        let mut proof = self.proof(&mut places);
        if proof.holds() {
            let straight = std::mem::replace(&mut self.elevated.mesh.points, places);
            return Climbed { given_up: Vec::new(), proof, straight };
        }
        let straight = self.elevated.mesh.points.clone();
        let fallback = self.fallback(&straight, &mut watch);
        let mut shares = vec![1.0; straight.len()];
        for rung in 0..=ROUNDS {
            let failing = proof.failing(&self.elevated.mesh, self.boundary);
            if failing.is_empty() || smoothed.stopped {
                break; // a face may fail that no element stands on
            }
            if rung > 0 {
                self.take_back(rung, &failing, &fallback, &mut places, &mut shares);
            } else if proof.certificate.holds() {
                continue; // smoothing does not look at folds of faces
            }
            self.smooth_again(smoothed, &straight, &shares, &mut places, &mut watch);
            proof = self.proof(&mut places);
        }
        self.elevated.mesh.points = places;
        let mesh = &mut self.elevated.mesh;
        let untouched = proof.holds() && shares.iter().all(|&s| s == 1.0);
        let (boundary, association) = (self.boundary, self.association);
        let mut off = given_up(mesh, boundary, association, &shares, fallback.order);
        let linear = &straight[..self.elevated.linear_nodes];
        let (more, proof) = retreat(mesh, &fallback, linear, boundary, association, self.ties, proof);
        off.retain(|own| more.iter().all(|other| other.face != own.face));
        off.extend(more);
        off.sort_by_key(|own| own.face);
        if !untouched {
            smoothed.survey(&Problem::new(mesh, &straight), &mesh.points, self.settings.survey_factor);
        }
        Climbed { given_up: off, proof, straight }
    }

    /// What is proven of the mesh with its nodes at `places`.
    fn proof(&mut self, places: &mut Vec<DVec3>) -> Proof {
        let mesh = &mut self.elevated.mesh;
        std::mem::swap(&mut mesh.points, places);
        let proof = Proof::of(mesh, &places[..self.elevated.linear_nodes], self.boundary, self.association);
        std::mem::swap(&mut mesh.points, places);
        proof
    }

    fn smooth_again(
        &self,
        smoothed: &mut Smoothed,
        straight: &[DVec3],
        shares: &[f64],
        places: &mut Vec<DVec3>,
        watch: &mut impl FnMut(smooth::Progress) -> bool,
    ) {
        let (association, projected, linear) = (self.association, &*self.projected, self.elevated.linear_nodes);
        let wall = CadConstraint::new(
            association,
            straight,
            projected,
            self.ties,
            linear,
            self.freeze_walls,
            self.freeze_linear,
        );
        let settings = smooth::Settings {
            survey_factor: 2 * self.settings.survey_factor,
            max_sweeps: SWEEPS.min(self.settings.max_sweeps),
            ..self.settings.clone()
        };
        let problem = Problem::new(&self.elevated.mesh, straight);
        let again = smooth(&problem, &Held { wall, shares }, &settings, places, None, watch);
        smoothed.sweeps += again.sweeps;
        smoothed.stopped |= again.stopped;
        smoothed.costs = again.costs;
        smoothed.end = again.end;
    }

    /// The curved mesh of the order below where it is proven valid, otherwise the straight one.
    fn fallback(&mut self, straight: &[DVec3], watch: &mut dyn FnMut(smooth::Progress) -> bool) -> Fallback {
        if let Some(below) = self.below.take().and_then(|fall| fall.below(watch)) {
            let mut places = below.raised(&self.elevated.mesh);
            places.iter_mut().zip(straight).for_each(|(place, straight)| *place += *straight);
            self.ties.apply(&mut places);
            if self.proof(&mut places).holds() {
                return Fallback { order: below.order, places };
            }
        }
        Fallback { order: Order::LINEAR, places: straight.to_vec() }
    }

    /// Takes the displacement back around the elements that fail.
    fn take_back(
        &mut self,
        round: usize,
        failing: &[usize],
        fallback: &Fallback,
        places: &mut [DVec3],
        shares: &mut [f64],
    ) {
        let straight = &self.elevated.mesh.points;
        let spots = self.spots(failing, straight, round);
        let keep = if round == ROUNDS { 0.0 } else { 0.5 };
        let moves = |n: usize| fallback.order > Order::LINEAR || self.on_wall(n);
        let share = |n: usize| spots.iter().map(|spot| spot.share(straight[n], keep)).fold(1.0, f64::min);
        let own = (0..straight.len()).into_par_iter().map(|n| if moves(n) { share(n) } else { 1.0 });
        let mut own: Vec<f64> = own.collect();
        self.ties.least(&mut own);
        let carried = |ladder: &Ladder| {
            perturb(ladder.elevated, ladder.boundary, ladder.association, ladder.projected, ladder.ties)
        };
        let before = (fallback.order == Order::LINEAR).then(|| carried(self));
        for (n, share) in own.into_iter().enumerate().filter(|(_, share)| *share < 1.0) {
            let back = fallback.places[n];
            places[n] = back.lerp(places[n], share);
            if self.on_wall(n) {
                shares[n] *= share;
                let back = back - self.elevated.mesh.points[n];
                if let Some(displacement) = self.projected.displacement.get_mut(n) {
                    *displacement = back.lerp(*displacement, share);
                }
            }
        }
        if let Some(before) = before {
            let after = carried(self);
            for n in (0..places.len()).filter(|&n| !self.on_wall(n)) {
                places[n] += after[n] - before[n];
            }
        }
        self.ties.apply(places);
    }

    fn on_wall(&self, node: usize) -> bool {
        let host = self.projected.host(node);
        matches!(host, Host::Surface(_) | Host::Curve(_)) && self.association.plane_of(host).is_none()
    }

    fn spots(&self, failing: &[usize], straight: &[DVec3], round: usize) -> Vec<Spot> {
        let mesh = &self.elevated.mesh;
        let elements: Vec<&[NodeId]> = mesh.blocks_of(3).flat_map(|(_, block)| block.elements(mesh.order)).collect();
        let wall: Vec<DVec3> = (0..straight.len()).filter(|&n| self.on_wall(n)).map(|n| straight[n]).collect();
        let spot = |&element: &usize| {
            let nodes = elements[element];
            let middle = nodes.iter().map(|n| straight[n.index()]).sum::<DVec3>() / nodes.len() as f64;
            let size = nodes.iter().map(|n| straight[n.index()].distance(middle)).fold(0.0, f64::max);
            let nearest = wall.iter().map(|w| w.distance_squared(middle)).fold(f64::INFINITY, f64::min).sqrt();
            Spot { middle, reach: REACH * round as f64 * (nearest + size) }
        };
        failing.par_iter().map(spot).collect()
    }
}

/// A place around which the wall is taken back.
struct Spot {
    middle: DVec3,
    reach: f64,
}

impl Spot {
    /// What stays of the displacement at `x`: `keep` within half the reach, all beyond it, smooth between.
    fn share(&self, x: DVec3, keep: f64) -> f64 {
        let t = (2.0 * x.distance(self.middle) / self.reach - 1.0).clamp(0.0, 1.0);
        keep + (1.0 - keep) * t * t * (3.0 - 2.0 * t)
    }
}

/// The CAD's constraint, and nodes off the CAD held where they are.
struct Held<'a> {
    wall: CadConstraint<'a>,
    shares: &'a [f64],
}

impl Constraint for Held<'_> {
    fn freedom(&self, node: NodeId, at: DVec3) -> Freedom {
        if self.shares[node.index()] < 1.0 { Freedom::Fixed } else { self.wall.freedom(node, at) }
    }

    fn restrict(&self, node: NodeId, from: DVec3, wish: DVec3) -> DVec3 {
        self.wall.restrict(node, from, wish)
    }

    fn images(&self) -> &[Image] {
        self.wall.images()
    }

    fn anchor(&self, node: NodeId) -> Option<Anchor> {
        self.wall.anchor(node).filter(|_| self.shares[node.index()] >= 1.0)
    }
}
