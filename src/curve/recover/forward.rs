//! Forward again, from a mesh that is proven valid: what went back goes towards the CAD step by step, and is smoothed after each.
//!
//! A step begins at a valid mesh and moves its walls a little, so few elements are inverted after it, and by little: the smoother need
//! not find its way from far. The torus at scale 0.5, P4, does not come out of one element at `J = -12 J_c` by smoothing alone; from
//! part of the way between P3 and P4 it goes to the CAD.
//!
//! A step that is not proven valid is undone, and the next one is half as long. Where the shortest is undone too, the walls around the
//! elements that failed stay, and the others go on.

use super::recovery::{Recovery, SWEEPS};
use crate::curve::wall_state::Wall;
use crate::mesh::ElementId;
use crate::smooth;

/// The first step, as a fraction of the whole way.
const STEP: f64 = 0.25;
/// No step is shorter.
const SHORTEST: f64 = 1.0 / 32.0;
/// Steps in a row that hold after one that did not, before steps grow again.
const STEADY: usize = 3;
/// Most steps, those that are undone included.
const MOST: usize = 48;
/// Costs good enough to take the next step.
const ENOUGH: f64 = 0.3;

impl Recovery<'_, '_> {
    /// Takes the walls forward as far as the mesh stays proven.
    pub(super) fn forward(&mut self) {
        if !self.proof.holds() || self.level.wall.is_all_the_way() {
            return;
        }
        let settings = &self.level.case.settings.smoothing;
        let enough = smooth::Settings {
            max_sweeps: SWEEPS.min(settings.max_sweeps),
            threshold: settings.threshold.min(ENOUGH),
            ..settings.clone()
        };
        let mut pull = vec![1.0; self.level.curved.len()];
        let (mut step, mut row, mut moved) = (STEP, STEADY - 1, false);
        for _ in 0..MOST {
            if self.smoothed.stopped {
                return;
            }
            if farthest_back(&self.level.wall, &pull).is_none() && std::mem::take(&mut moved) {
                pull.fill(1.0); // with the others where they are now, those that stayed may come after
                step = STEP;
            }
            let Some(least) = farthest_back(&self.level.wall, &pull) else { break };
            let fraction = (step / (1.0 - least)).min(1.0);
            let tried = self.attempt(self.floor(), |recovery| {
                recovery.go_forward(fraction, &pull);
                recovery.smooth_again(&enough);
            });
            moved |= tried.is_ok();
            match tried {
                Ok(()) if row + 1 >= STEADY => step *= 2.0,
                Ok(()) => row += 1,
                Err(failing) if failing.is_empty() => break, // a face failed that no element stands on
                Err(failing) => {
                    row = 0;
                    step *= 0.5;
                    if step < SHORTEST {
                        self.stay(&failing, &mut pull);
                        step = STEP;
                    }
                }
            }
        }
        let settings = self.level.case.settings;
        let _ = self.attempt(self.floor(), |recovery| recovery.smooth_again(&settings.smoothing));
    }

    /// Takes wall nodes this fraction of what is left of their way, times their pull, and carries the others along.
    fn go_forward(&mut self, fraction: f64, pull: &[f64]) {
        let carried = self.carried();
        let wall = &mut self.level.wall;
        let nodes: Vec<usize> = wall.off_cad().map(|(n, _)| n).filter(|&n| pull[n] > 0.0).collect();
        nodes.iter().for_each(|&n| wall.advance(n, fraction * pull[n]));
        self.follow(&nodes, Some(carried));
    }

    /// The walls around some elements go no farther.
    fn stay(&self, elements: &[ElementId], pull: &mut [f64]) {
        let mut own = self.fractions_around(elements, 1, 0.0);
        self.level.periodic.least(&mut own);
        pull.iter_mut().zip(own).for_each(|(pull, own)| *pull = pull.min(own));
    }
}

/// How far along the last of the nodes is that are not on the CAD and are pulled with full strength.
fn farthest_back(wall: &Wall, pull: &[f64]) -> Option<f64> {
    let left = wall.off_cad().filter(|(n, _)| pull[*n] >= 1.0);
    left.map(|(_, fraction)| fraction).min_by(f64::total_cmp)
}
