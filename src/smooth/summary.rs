//! What smoothing came to: the costs of the elements, and the smallest of them.

use glam::DVec3;

use super::{ElementCost, Problem};

/// What smoothing did.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// Sweeps, all stages together.
    pub sweeps: usize,
    /// Whether `watch` ended it.
    pub stopped: bool,
    /// Costs of every cell, by the closing survey.
    pub costs: Vec<ElementCost>,
    /// Smallest costs before the first sweep, by the closing survey.
    pub start: Summary,
    /// Smallest costs at the end.
    pub end: Summary,
}

/// The smallest costs of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Smallest `C_WCN`.
    pub c_wcn: f64,
    /// Smallest `C_JAC`.
    pub c_jac: f64,
    /// Elements with a cost of 0 or less.
    pub inverted: usize,
}

impl Smoothed {
    /// Takes the costs anew, after nodes were moved by others.
    pub fn survey(&mut self, problem: &Problem, x: &[DVec3], survey_factor: usize) {
        self.costs = problem.survey(x, survey_factor);
        self.end = Summary::of(&self.costs);
    }
}

impl Summary {
    pub(super) fn of(costs: &[ElementCost]) -> Summary {
        let worst = |f: fn(&ElementCost) -> f64| costs.iter().map(f).fold(1.0, f64::min);
        let inverted = costs.iter().filter(|c| c.worst() <= 0.0).count();
        Summary { c_wcn: worst(|c| c.c_wcn), c_jac: worst(|c| c.c_jac), inverted }
    }

    /// The smaller of the two.
    #[must_use]
    pub fn worst(self) -> f64 {
        self.c_wcn.min(self.c_jac)
    }

    /// One figure for both costs, in which the smaller counts more and yet the larger counts: where the CAD itself bounds the one
    /// (a prism whose straight column leans on its wall cannot keep its shape on a curved one), the other still gains.
    pub(super) fn score(self) -> f64 {
        if self.worst() > 0.0 { 2.0 / (1.0 / self.c_wcn + 1.0 / self.c_jac) } else { self.worst() }
    }

    pub(super) fn beats(self, other: Summary) -> bool {
        self.inverted < other.inverted || (self.inverted == other.inverted && self.score() > other.score())
    }
}
