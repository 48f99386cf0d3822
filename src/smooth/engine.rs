//! What moves the nodes of a patch.

use std::fmt;

/// An engine of the smoother; stages, patches and surveys are the same for all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engine {
    /// Preconditioned L-BFGS on a smooth objective over the whole patch.
    #[default]
    QuasiNewton,
    /// The paper's: each node up the gradient of its own cost, at most a share of the inscribed radius.
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

    /// Sweeps between two surveys.
    pub(super) fn round(self) -> usize {
        match self {
            Engine::QuasiNewton => 10,
            Engine::Gradient => 20, // its sweeps are short and many
        }
    }
}

impl fmt::Display for Engine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
