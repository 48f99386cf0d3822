//! Who follows the work, and the clock of its steps.

use std::time::Instant;

use super::checkpoint::Work;
use crate::element::Order;
use crate::smooth::{self, Checkpoint, Watch};

/// Steps of a curving, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are those of the modules
pub enum Step {
    Read,
    Associate,
    Elevate,
    Project,
    Perturb,
    Smooth,
    Certify,
    Recover,
}

impl Step {
    /// The steps that every curving takes, in order; [`Step::Recover`] follows where it is needed.
    pub const ALL: [Step; 7] =
        [Step::Read, Step::Associate, Step::Elevate, Step::Project, Step::Perturb, Step::Smooth, Step::Certify];

    /// The step's word in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Step::Read => "read",
            Step::Associate => "associate",
            Step::Elevate => "elevate",
            Step::Project => "project",
            Step::Perturb => "perturb",
            Step::Smooth => "smooth",
            Step::Certify => "certify",
            Step::Recover => "recover",
        }
    }
}

/// Who follows the work. Every method has a default that does nothing and goes on, so that `()` is an observer.
pub trait Observer {
    /// The steps from [`Step::Elevate`] to [`Step::Smooth`] begin, for a mesh of this order.
    fn order(&mut self, _order: Order) {}
    /// A step begins.
    fn step(&mut self, _step: Step) {}
    /// The smoother finished a sweep; false ends it.
    fn progress(&mut self, _progress: &smooth::Progress) -> bool {
        true
    }
    /// Whether recovery may go on after the smoothing before it was ended by this observer.
    fn may_recover(&mut self) -> bool {
        false
    }
    /// A state from which [`Settings::resume`](super::settings::Settings::resume) goes on.
    fn checkpoint(&mut self, _work: &Work, _checkpoint: &Checkpoint) {}
}

impl Observer for () {}

/// Hands the smoother's progress and checkpoints on to the observer.
pub(super) struct Relay<'a> {
    pub(super) observer: &'a mut dyn Observer,
    pub(super) work: Work,
}

impl Watch for Relay<'_> {
    fn progress(&mut self, progress: smooth::Progress) -> bool {
        self.observer.progress(&progress)
    }

    fn checkpoint(&mut self, checkpoint: &Checkpoint) {
        self.observer.checkpoint(&self.work, checkpoint);
    }
}

/// Times the steps and tells the observer.
pub(super) struct Clock<'a> {
    pub(super) observer: &'a mut dyn Observer,
    current: Option<(Step, Instant)>,
    seconds: Vec<(Step, f64)>,
}

impl<'a> Clock<'a> {
    pub(super) fn new(observer: &'a mut dyn Observer) -> Clock<'a> {
        Clock { observer, current: None, seconds: Vec::new() }
    }

    pub(super) fn step(&mut self, step: Step) {
        self.close();
        self.current = Some((step, Instant::now()));
        self.observer.step(step);
    }

    fn close(&mut self) {
        if let Some((step, start)) = self.current.take() {
            let spent = start.elapsed().as_secs_f64();
            match self.seconds.iter_mut().find(|(own, _)| *own == step) {
                Some((_, seconds)) => *seconds += spent,
                None => self.seconds.push((step, spent)),
            }
        }
    }

    /// Seconds a step, all orders together.
    pub(super) fn finish(mut self) -> Vec<(Step, f64)> {
        self.close();
        self.seconds
    }
}
