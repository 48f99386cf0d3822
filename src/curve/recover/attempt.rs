//! Attempts: what does not end in a proof is undone.

use glam::DVec3;

use super::recovery::Recovery;
use crate::curve::proof::Proof;
use crate::curve::wall_state::Wall;
use crate::mesh::ElementId;
use crate::smooth::Smoothed;

/// The state of a recovery before an attempt.
pub(super) struct Kept {
    curved: Vec<DVec3>,
    wall: Wall,
    smoothed: Smoothed,
    proof: Proof,
}

impl Recovery<'_, '_> {
    /// Does what is asked, or, where the mesh is not proven valid after it or a cost is below `floor`, nothing; then the elements that fail
    /// are returned.
    pub(super) fn attempt(&mut self, floor: f64, attempt: impl FnOnce(&mut Self)) -> Result<(), Vec<ElementId>> {
        let kept = self.kept();
        attempt(self);
        let failing = self.below(floor);
        if failing.is_empty() && self.proof.holds() {
            return Ok(());
        }
        self.restore(kept);
        Err(failing)
    }

    /// What an attempt may change.
    pub(super) fn kept(&self) -> Kept {
        let (curved, wall) = (self.level.curved.clone(), self.level.wall.clone());
        Kept { curved, wall, smoothed: self.smoothed.clone(), proof: self.proof.clone() }
    }

    /// Takes back all but the count of sweeps.
    pub(super) fn restore(&mut self, kept: Kept) {
        self.level.curved = kept.curved;
        self.level.wall = kept.wall;
        self.proof = kept.proof;
        let tried = std::mem::replace(self.smoothed, kept.smoothed);
        self.smoothed.sweeps = tried.sweeps;
        self.smoothed.stopped = tried.stopped;
    }
}
