//! Who is told how the smoothing goes on.

use super::{Checkpoint, Progress};

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
