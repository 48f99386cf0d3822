//! Who follows the smoothing.

use glam::DVec3;

use super::Checkpoint;

/// Where the smoother stands after a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Stage, from 1.
    pub stage: usize,
    /// Sweeps so far, all stages.
    pub sweep: usize,
    /// Most sweeps there can be.
    pub max_sweeps: usize,
    /// Nodes that move.
    pub active_nodes: usize,
    /// Smallest cost at the last survey, either component.
    pub worst: f64,
    /// Smallest costs of all elements at the last survey, `C_WCN` and `C_JAC`.
    pub costs: [f64; 2],
    /// Middle of the element that has it.
    pub at: DVec3,
    /// Elements with a cost of 0 or less at the last survey.
    pub inverted: usize,
}

/// Told after every sweep and between rounds.
pub trait Watch {
    /// A sweep is done; false ends the smoothing.
    fn progress(&mut self, progress: Progress) -> bool;

    /// A state from which the same work can go on.
    fn checkpoint(&mut self, _checkpoint: &Checkpoint) {}
}

impl<F: FnMut(Progress) -> bool> Watch for F {
    fn progress(&mut self, progress: Progress) -> bool {
        self(progress)
    }
}
