//! Release: wall nodes that make elements impossible leave the CAD, as few and as little as it takes.
//!
//! An element with two faces on one smooth wall cannot be valid while all its edges there follow it, whatever the volume does: at their
//! common corner `det J` goes to zero, and its sign is that of the wall's curvature. To free the one node between the ends of the edge
//! that the two faces share is enough: it is drawn back to its place by a spring, and the smoother finds the least it must give.

use glam::DVec3;

use super::offending::{Offending, Reach};
use super::recovery::Recovery;
use crate::curve::start::start;
use crate::mesh::ElementId;
use crate::smooth;

/// Costs good enough where the order begins anew.
const CALM: f64 = 0.5;
/// Costs good enough beside nodes that are drawn to the CAD or put back.
const ENOUGH: f64 = 0.35;
/// Share of their way to the CAD that released nodes are drawn at first, and its share where that is too far.
const DRAW: f64 = 0.5;
/// Shorter ones are not tried.
const SHORTEST_DRAW: f64 = 0.1;
/// Times that they are drawn at most.
const DRAWS: usize = 6;
/// Spots of released nodes, the farthest off first, that are drawn by themselves after that, and times that each is.
const SPOTS: usize = 4;
/// See [`SPOTS`].
const SPOT_DRAWS: usize = 3;
/// Released nodes that are no farther from their place than this share of their displacement are put back, fewer where that fails.
const HARDLY: [f64; 3] = [0.5, 0.1, 0.02];

/// Where more elements fail than this, and than that fraction of all, the trouble is not local.
const MOST: usize = 200;
/// See [`MOST`].
const MOST_OF_ALL: f64 = 2e-3;
/// Rings of elements around released nodes, and elements that fail, in which the order begins anew.
const RINGS: usize = 6;

impl Recovery<'_, '_> {
    /// Releases wall nodes at the elements that fail or are below the floor, and takes what is released as near to the CAD as it goes; where
    /// that does not end in a proof, nothing is changed.
    pub(super) fn release(&mut self) {
        let floor = self.level.case.settings.floor;
        let poor = self.below(floor).len();
        let local = MOST.max((MOST_OF_ALL * self.smoothed.costs.len() as f64) as usize);
        let nothing = poor == 0 && self.level.wall.released().next().is_none();
        if nothing || poor > local || self.smoothed.stopped {
            return;
        }
        let had = if self.proof.holds() { self.smoothed.end.worst().min(floor) } else { 0.0 };
        let _ = self.attempt(had.max(0.0), |recovery| {
            recovery.release_step_by_step();
            recovery.draw();
            recovery.reattach();
        });
    }

    fn release_step_by_step(&mut self) {
        let own = &self.level.case.settings.smoothing;
        let settings = smooth::Settings { threshold: own.threshold.min(CALM), ..own.clone() };
        for reach in [Reach::Edge, Reach::Edge, Reach::Edge, Reach::Faces, Reach::Around] {
            let poor = self.below(self.level.case.settings.floor);
            if poor.is_empty() || self.smoothed.stopped {
                break;
            }
            let offending = Offending { level: self.level };
            let nodes = offending.nodes(&offending.culprits(&poor, reach, &self.smoothed.costs), reach);
            if !nodes.is_empty() {
                nodes.iter().for_each(|&n| self.level.wall.release(n));
                self.begin_anew(&poor);
                self.smooth_again(&settings);
            }
        }
    }

    /// Draws released nodes nearer to their places on the CAD, as far as the costs beside them stay good enough: all together, then those of
    /// the spots that are farthest off by themselves.
    fn draw(&mut self) {
        let nodes: Vec<usize> = self.level.wall.released().collect();
        self.draw_nodes(&nodes, DRAWS);
        let mut spots = self.spots(&nodes);
        if spots.len() < 2 {
            return;
        }
        spots.sort_by(|a, b| self.farthest_off(b).total_cmp(&self.farthest_off(a)));
        spots.iter().take(SPOTS).for_each(|spot| self.draw_nodes(spot, SPOT_DRAWS));
    }

    fn draw_nodes(&mut self, nodes: &[usize], draws: usize) {
        let settings = self.calmly();
        let least = self.smoothed.end.worst().min(ENOUGH).max(self.floor());
        let mut step = DRAW;
        for _ in 0..draws {
            if step < SHORTEST_DRAW || !self.proof.holds() || self.smoothed.stopped {
                break;
            }
            let tried = self.attempt(least, |recovery| {
                recovery.move_to_cad(nodes, step);
                recovery.level.wall.hold(nodes); // left to themselves they may go back, or farther
                recovery.smooth_again(&settings);
                recovery.level.wall.hold(&[]);
            });
            if tried.is_err() {
                step *= DRAW;
            }
        }
    }

    /// Settings that smooth until the costs beside nodes that are drawn or put back are good enough.
    fn calmly(&self) -> smooth::Settings {
        let own = &self.level.case.settings.smoothing;
        smooth::Settings { threshold: ENOUGH.min(own.threshold), ..self.closer() }
    }

    /// Released nodes that hang together by wall faces.
    fn spots(&self, nodes: &[usize]) -> Vec<Vec<usize>> {
        let (boundary, mesh) = (self.level.case.boundary, self.level.mesh());
        let mut spots: Vec<Vec<usize>> = Vec::new();
        for face in 0..boundary.faces.len() {
            let on_face = boundary.nodes(face, mesh).iter().map(|n| n.index());
            let mut spot: Vec<usize> = on_face.filter(|n| nodes.binary_search(n).is_ok()).collect();
            if spot.is_empty() {
                continue;
            }
            let (near, apart) = spots.into_iter().partition(|own| own.iter().any(|n| spot.contains(n)));
            spots = apart;
            let near: Vec<Vec<usize>> = near;
            spot.extend(near.into_iter().flatten());
            spot.sort_unstable();
            spot.dedup();
            spots.push(spot);
        }
        spots
    }

    fn farthest_off(&self, nodes: &[usize]) -> f64 {
        nodes.iter().map(|&n| self.level.curved[n].distance(self.level.displaced(n))).fold(0.0, f64::max)
    }

    /// Moves released nodes this share of their way to their places on the CAD, and carries the volume along.
    fn move_to_cad(&mut self, nodes: &[usize], share: f64) {
        let places: Vec<DVec3> = nodes.iter().map(|&n| self.level.wall.displacement(n)).collect();
        nodes.iter().for_each(|&n| self.level.wall.displace(n, self.level.curved[n] - self.level.straight()[n]));
        let before = self.carried();
        for (&n, &place) in nodes.iter().zip(&places) {
            let moved = self.level.wall.displacement(n).lerp(place, share);
            self.level.wall.displace(n, moved);
            self.level.curved[n] = self.level.displaced(n);
        }
        self.carry_on(&before);
        nodes.iter().zip(places).for_each(|(&n, place)| self.level.wall.displace(n, place));
    }

    /// Puts released nodes back on the CAD: spot by spot where nodes that slide make room for them, then those that hardly left it, as many as
    /// can be.
    fn reattach(&mut self) {
        let released: Vec<usize> = self.level.wall.released().collect();
        let spots = self.spots(&released);
        if spots.len() <= SPOTS {
            for spot in &spots {
                self.put_back(spot);
            }
        }
        for share in HARDLY {
            if !self.proof.holds() || self.smoothed.stopped {
                break;
            }
            let left = |n: &usize| {
                let place = self.level.displaced(*n);
                self.level.curved[*n].distance(place) < share * self.level.wall.displacement(*n).length()
            };
            let nodes: Vec<usize> = self.level.wall.released().filter(left).collect();
            if nodes.is_empty() || self.put_back(&nodes) {
                break;
            }
        }
    }

    /// Puts released nodes back on the CAD; whether they could stay there.
    fn put_back(&mut self, nodes: &[usize]) -> bool {
        let settings = self.calmly();
        let tried = self.attempt(self.floor(), |recovery| {
            recovery.move_to_cad(nodes, 1.0);
            nodes.iter().for_each(|&n| recovery.level.wall.reattach(n));
            recovery.smooth_again(&settings);
        });
        tried.is_ok()
    }

    /// The floor, or what the smallest cost is where that is less.
    pub(super) fn floor(&self) -> f64 {
        self.level.case.settings.floor.min(self.smoothed.end.worst())
    }

    /// Elements that fail, or have a cost below the floor; rising.
    pub(super) fn below(&self, floor: f64) -> Vec<ElementId> {
        let mut poor = self.proof.failing(self.level);
        let costs = self.level.mesh().cells().ids().zip(&self.smoothed.costs);
        poor.extend(costs.filter(|(_, cost)| cost.worst() < floor).map(|(e, _)| e));
        poor.sort_unstable();
        poor.dedup();
        poor
    }

    /// Begins the order anew around the elements that fail, released nodes where they are in the fallback mesh: they come towards the CAD
    /// from a valid mesh, not from one that was bent to make room for what cannot be.
    fn begin_anew(&mut self, poor: &[ElementId]) {
        let released: Vec<usize> = self.level.wall.released().collect();
        let begin = start(self.level, self.below);
        let near = self.nodes_around(poor, &released);
        for ((x, begin), _) in self.level.curved.iter_mut().zip(begin).zip(near).filter(|(_, near)| *near) {
            *x = begin;
        }
    }

    /// Marks the nodes within some rings of elements around elements and nodes.
    fn nodes_around(&self, elements: &[ElementId], nodes: &[usize]) -> Vec<bool> {
        let cells = self.level.mesh().cells();
        let mut near = vec![false; self.level.curved.len()];
        nodes.iter().for_each(|&n| near[n] = true);
        elements.iter().flat_map(|&e| cells.nodes(e)).for_each(|n| near[n.index()] = true);
        for _ in 0..RINGS {
            let touched = cells.iter().filter(|own| own.nodes.iter().any(|n| near[n.index()]));
            let more: Vec<usize> = touched.flat_map(|own| own.nodes.iter().map(|n| n.index())).collect();
            more.into_iter().for_each(|n| near[n] = true);
            self.level.periodic.spread(&mut near);
        }
        near
    }
}
