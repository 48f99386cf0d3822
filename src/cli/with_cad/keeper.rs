//! Keeps the state of the smoothing in a file while it goes on.

use std::path::PathBuf;

use super::trace::Trace;
use crate::curve::checkpoint::{self, Work};
use crate::curve::{Observer, Step};
use crate::element::Order;
use crate::formats;
use crate::smooth::{Checkpoint, Progress};

/// Writes a checkpoint every so many sweeps, and hands everything on.
pub(super) struct Keeper<'a, 't> {
    trace: &'a mut Trace<'t>,
    file: Option<PathBuf>,
    every: usize,
    /// Sweeps at the last checkpoint of this order.
    last: usize,
    /// What went wrong at the last one; the work goes on.
    pub(super) failure: Option<formats::Error>,
}

impl<'a, 't> Keeper<'a, 't> {
    pub(super) fn new(trace: &'a mut Trace<'t>, file: Option<PathBuf>, every: usize) -> Keeper<'a, 't> {
        Keeper { trace, file, every, last: 0, failure: None }
    }
}

impl Observer for Keeper<'_, '_> {
    fn order(&mut self, order: Order) {
        self.last = 0;
        self.trace.order(order);
    }

    fn step(&mut self, step: Step) {
        self.trace.step(step);
    }

    fn progress(&mut self, progress: &Progress) -> bool {
        self.trace.progress(progress)
    }

    fn checkpoint(&mut self, work: &Work, checkpoint: &Checkpoint) {
        let Some(file) = self.file.as_ref().filter(|_| checkpoint.sweeps() >= self.last + self.every) else { return };
        self.last = checkpoint.sweeps();
        self.failure = checkpoint::write(file, work, checkpoint).err();
    }
}
