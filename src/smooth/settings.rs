//! What the user can set of the smoothing.

use super::Engine;

/// What the user can set.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Elements whose cost is below are worked on, with their neighbours; in a plane mesh those 0.05 above it as well. Default 0.8
    /// (paper §2.3).
    pub threshold: f64,
    /// Weight of shape in equation (2), 0 to 1; `None` is `(p - 1) / p`.
    pub alpha: Option<f64>,
    /// Most sweeps over the active nodes, all stages together; those over few of the nodes count as less. Default 200.
    pub max_sweeps: usize,
    /// Density of the closing survey: this many times `p` divisions an edge. Default 4.
    pub survey_factor: usize,
    /// What moves the nodes.
    pub engine: Engine,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { threshold: 0.8, alpha: None, max_sweeps: 200, survey_factor: 4, engine: Engine::default() }
    }
}
