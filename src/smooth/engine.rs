//! What moves the nodes of a patch.

use std::fmt;
use std::ops::RangeInclusive;

/// An engine of the smoother; stages, patches and surveys are the same for all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// Preconditioned L-BFGS on a smooth objective over the whole patch.
    #[default]
    QuasiNewton,
    /// The paper's: each node up the gradient of its own cost, at most a fraction of the inscribed radius.
    Gradient,
}

impl Engine {
    /// All engines.
    pub const ALL: [Engine; 2] = [Engine::QuasiNewton, Engine::Gradient];

    /// The engine's word on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Engine::QuasiNewton => "quasi-newton",
            Engine::Gradient => "gradient",
        }
    }

    /// Sweeps between two surveys: of the first rounds, and at most.
    ///
    /// L-BFGS lowers the objective from the first sweep, but not the worst of its elements: on a large patch that falls at
    /// first and recovers as the descent converges (weeble P3, `--threshold 0.95`, 117 000 active nodes: C_JAC 0.72, 0.52
    /// after 10 sweeps, 0.80 after 100). Rounds of 10 alone forgot what they had learned each time and ended where they had
    /// begun, at 0.72; with rounds that grow to 40 that mesh ends at 0.86, weeble P4 at 0.80 rather than 0.79 and in two
    /// thirds of the time. Rounds of 160 give no more.
    pub(super) fn rounds(self) -> RangeInclusive<usize> {
        match self {
            Engine::QuasiNewton => 10..=40,
            Engine::Gradient => 20..=20, // it remembers nothing
        }
    }
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
