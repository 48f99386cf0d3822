//! Keeps the state of the smoothing in a file while it goes on.

use std::path::PathBuf;

use super::checkpoint::{self, Work};
use super::observer::{Observer, Step};
use crate::element::Order;
use crate::formats;
use crate::smooth::{Checkpoint, Progress};

/// Writes a checkpoint every so many sweeps, and passes everything on to another observer.
pub struct Checkpointing<'a> {
    observer: &'a mut dyn Observer,
    file: Option<PathBuf>,
    every: usize,
    /// Sweeps at the last checkpoint of this order.
    last: usize,
    failure: Option<formats::Error>,
}

impl<'a> Checkpointing<'a> {
    /// Writes to `file` at least `every` sweeps apart, nothing where there is no file; passes on to `observer`.
    pub fn new(observer: &'a mut dyn Observer, file: Option<PathBuf>, every: usize) -> Checkpointing<'a> {
        Checkpointing { observer, file, every, last: 0, failure: None }
    }

    /// What went wrong at the last checkpoint; the work went on.
    pub fn failure(self) -> Option<formats::Error> {
        self.failure
    }
}

impl Observer for Checkpointing<'_> {
    fn order(&mut self, order: Order) {
        self.last = 0;
        self.observer.order(order);
    }

    fn step(&mut self, step: Step) {
        self.observer.step(step);
    }

    fn may_recover(&mut self) -> bool {
        self.observer.may_recover()
    }

    fn progress(&mut self, progress: &Progress) -> bool {
        self.observer.progress(progress)
    }

    fn checkpoint(&mut self, work: &Work, checkpoint: &Checkpoint) {
        if let Some(file) = self.file.as_ref().filter(|_| checkpoint.sweeps() >= self.last.saturating_add(self.every)) {
            self.last = checkpoint.sweeps();
            self.failure = checkpoint::write(file, work, checkpoint).err();
        }
        self.observer.checkpoint(work, checkpoint);
    }
}
