//! Forward again, from a mesh that is proven valid: what was taken back goes towards the CAD step by step, and is smoothed after each.
//!
//! A step begins at a valid mesh and moves its walls a little, so few elements are inverted after it, and by little: the smoother need
//! not find its way from far. The torus at scale 0.5, P4, does not come out of one element at `J = -12 J_c` by smoothing alone; from
//! part of the way between P3 and P4 it goes to the CAD.
//!
//! A step that is not proven valid is undone, and the next one is half as long. Where the shortest is undone too, the walls around the
//! elements that failed stay, and the others go on.

use super::{Ladder, SWEEPS, Standing};
use crate::smooth::{self, Progress};

/// The first step, as a share of the whole way.
const STEP: f64 = 0.25;
/// No step is shorter.
const SHORTEST: f64 = 1.0 / 32.0;
/// Steps in a row that hold after one that did not, before steps grow again.
const STEADY: usize = 3;
/// Most steps, those that are undone included.
const MOST: usize = 48;
/// Costs good enough to take the next step.
const ENOUGH: f64 = 0.3;

impl Ladder<'_, '_> {
    /// Takes the walls forward as far as the mesh stays proven.
    pub(super) fn advance(&mut self, now: &mut Standing, watch: &mut impl FnMut(Progress) -> bool) {
        if !now.proof.holds() || now.way.is_done() {
            return;
        }
        let sweeps = SWEEPS.min(self.settings.max_sweeps);
        let enough = self.settings.threshold.min(ENOUGH);
        let enough = smooth::Settings { max_sweeps: sweeps, threshold: enough, ..self.settings.clone() };
        let mut pull = vec![1.0; now.places.len()];
        let (mut step, mut row, mut moved) = (STEP, STEADY - 1, false);
        for _ in 0..MOST {
            if now.smoothed.stopped {
                return;
            }
            if now.way.least(&pull).is_none() && std::mem::take(&mut moved) {
                pull.fill(1.0); // with the others where they are now, those that stayed may come after
                step = STEP;
            }
            let Some(least) = now.way.least(&pull) else { break };
            let share = (step / (1.0 - least)).min(1.0);
            let tried = self.attempt(now, |ladder, tried| {
                ladder.go_forward(share, &pull, tried);
                ladder.smooth_again(&enough, tried, watch);
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
        let settings = self.settings.clone();
        let _ = self.attempt(now, |ladder, tried| ladder.smooth_again(&settings, tried, watch));
    }

    /// Does what is asked, or, where the mesh is not proven valid after it, nothing; then the elements that fail are returned.
    fn attempt(
        &mut self,
        now: &mut Standing,
        attempt: impl FnOnce(&mut Ladder, &mut Standing),
    ) -> Result<(), Vec<usize>> {
        let displacement = self.projected.displacement.clone();
        let mut tried = now.clone();
        attempt(self, &mut tried);
        if tried.proof.holds() {
            *now = tried;
            return Ok(());
        }
        self.projected.displacement = displacement;
        now.smoothed.sweeps = tried.smoothed.sweeps;
        now.smoothed.stopped = tried.smoothed.stopped;
        Err(tried.proof.failing(&self.elevated.mesh, self.boundary))
    }

    /// Takes wall nodes this share of what is left of their way, times their pull, and carries the others along.
    fn go_forward(&mut self, share: f64, pull: &[f64], now: &mut Standing) {
        let carried = self.carried();
        let nodes: Vec<usize> = (0..pull.len()).filter(|&n| now.way.shares[n] < 1.0 && pull[n] > 0.0).collect();
        for &n in &nodes {
            let own = &mut now.way.shares[n];
            *own += share * pull[n] * (1.0 - *own);
        }
        self.follow(&nodes, Some(carried), now);
    }

    /// The walls around some elements go no farther.
    fn stay(&self, elements: &[usize], pull: &mut [f64]) {
        let mut own = self.shares_around(elements, 1, 0.0);
        self.periodic.least(&mut own);
        pull.iter_mut().zip(own).for_each(|(pull, own)| *pull = pull.min(own));
    }
}
