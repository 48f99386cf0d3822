//! Where a stage stands between two rounds, and what the next one is to be.

use super::ElementCost;
use super::engine::Engine;

/// A round gains something where it raises the score of the smallest costs by at least this.
const PROGRESS: f64 = 2e-3;
/// Rings of neighbours that are activated around the elements below the threshold.
pub(super) const RINGS: usize = 2;
/// Most rings around elements nearly inverted that do not come out of it.
const MOST_RINGS: usize = 8;
/// Idle rounds after which a focused stage ends.
pub(super) const PATIENCE: usize = 4;

/// A sweep over few of the mesh's nodes counts as less than one, at least as one part in so many: what is worth going on with is not to
/// end because of sweeps that cost next to nothing.
const QUARTERS: usize = 4;
/// A sweep over one node in so many counts as a whole one.
const MANY: f64 = 20.0;

/// What a stage works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Shape alone.
    Shape,
    /// Shape and Jacobian.
    Full,
}

/// Where a stage stands between two rounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pace {
    pub(crate) stage: Stage,
    /// Rounds in a row that gained next to nothing.
    pub(crate) idle: usize,
    /// Rings around elements nearly inverted.
    pub(crate) low_rings: usize,
    /// Whether a round gained something since there were that many.
    pub(crate) gained: bool,
    /// Whether the worst elements are worked on alone.
    pub(crate) focused: bool,
    /// Most sweeps of the next round.
    pub(crate) round: usize,
    /// What the sweeps so far come to, in quarters of a sweep over a large part of the mesh.
    pub(crate) spent: usize,
}

impl Stage {
    /// The cost that the stage works on.
    pub(super) fn cost(self, cost: &ElementCost) -> f64 {
        if self == Stage::Shape { cost.c_wcn } else { cost.worst() }
    }
}

impl Pace {
    /// That of the next stage.
    pub(super) fn next(self, engine: Engine) -> Pace {
        Pace { spent: self.spent, ..Pace::new(Stage::Full, engine) }
    }

    /// Takes sweeps into account that moved this many of the mesh's nodes.
    pub(super) fn spend(&mut self, sweeps: usize, active: usize, nodes: usize) {
        let share = MANY * active as f64 / nodes.max(1) as f64;
        let quarters = sweeps * ((QUARTERS as f64 * share).ceil() as usize).clamp(1, QUARTERS);
        self.spent = self.spent.saturating_add(quarters);
    }

    /// Sweeps that are left of so many.
    pub(super) fn left(self, max_sweeps: usize) -> usize {
        QUARTERS.saturating_mul(max_sweeps).saturating_sub(self.spent).div_ceil(QUARTERS)
    }

    /// That of a stage that begins.
    pub(super) fn new(stage: Stage, engine: Engine) -> Pace {
        Pace {
            stage,
            idle: 0,
            low_rings: RINGS,
            gained: false,
            focused: false,
            round: *engine.rounds().start(),
            spent: 0,
        }
    }

    /// After a round: where it gained next to nothing and its descent was cut off, the next one is longer.
    pub(super) fn after(&mut self, gained: f64, sweeps: usize, engine: Engine) {
        if gained >= PROGRESS {
            (self.idle, self.gained) = (0, true);
        } else if sweeps == self.round && self.round < *engine.rounds().end() {
            self.round *= 2;
        } else {
            self.idle += 1;
        }
    }

    /// Whether more rings are worth trying around elements nearly inverted: not where the last ones made no difference.
    pub(super) fn may_widen(&self) -> bool {
        self.low_rings < MOST_RINGS && (self.gained || self.low_rings == RINGS)
    }

    /// Takes more rings.
    pub(super) fn widen(&mut self) {
        self.low_rings *= 2;
        self.gained = false;
    }

    /// Without numbers beyond what a run reaches: they come from a forged file, and must not cost more than the work does.
    pub(super) fn limited(self, engine: Engine) -> Pace {
        let (idle, low_rings) = (self.idle.min(PATIENCE), self.low_rings.clamp(RINGS, MOST_RINGS));
        let rounds = engine.rounds();
        Pace { idle, low_rings, round: self.round.clamp(*rounds.start(), *rounds.end()), ..self }
    }
}
