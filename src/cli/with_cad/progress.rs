//! The progress of a curving, and what ends its smoothing early.

use std::time::{Duration, Instant};

use super::live::Live;
use super::row::{Row, Sweep};
use crate::cli::signals;
use crate::curve::{Deadline, Observer, Step};
use crate::element::Order;
use crate::smooth::Progress;

/// Plain lines come no more often than this.
pub(super) const INTERVAL: Duration = Duration::from_secs(2);

/// Why smoothing ended before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    Interrupted,
    TimeLimit(Duration),
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Stop::Interrupted => f.write_str("stopped early: interrupted"),
            Stop::TimeLimit(limit) => write!(f, "stopped early: the time limit of {} s is over", limit.as_secs_f64()),
        }
    }
}

/// Shows how the work goes on, and may end the smoothing on an interrupt or after a time limit.
pub(super) struct Monitor {
    deadline: Deadline,
    /// Why smoothing was ended, once it was.
    pub(super) stop: Option<Stop>,
    live: Live,
    /// The order that is worked at, which it is of how many.
    order: Option<(Order, usize, usize)>,
    /// How many orders there are at most.
    orders: usize,
    step: Step,
    pace: Pace,
    last: Option<Instant>,
}

/// How long a sweep takes in the stage that the smoother is in.
#[derive(Clone, Copy, Debug)]
struct Pace {
    stage: usize,
    /// When it began, and after how many sweeps.
    since: Instant,
    done: usize,
    /// When the last sweep ended.
    last: Instant,
}

impl Pace {
    /// A step begins.
    fn new() -> Pace {
        let now = Instant::now();
        Pace { stage: 0, since: now, done: 0, last: now }
    }

    /// A sweep has ended: how long all take that there may still be, by those of its stage.
    fn left(&mut self, progress: &Progress) -> Duration {
        let Progress { stage, sweep, max_sweeps, .. } = *progress;
        if self.stage != stage || sweep <= self.done {
            *self = Pace { stage, since: self.last, done: sweep.saturating_sub(1), last: self.last };
        }
        self.last = Instant::now();
        let spent = self.last.duration_since(self.since).as_secs_f64();
        let each = spent / sweep.saturating_sub(self.done).max(1) as f64;
        Duration::from_secs_f64(each * max_sweeps.saturating_sub(sweep) as f64)
    }
}

impl Monitor {
    /// Begins to count the time. Smoothing ends after a time limit, where there is one, and that at the first of `orders` orders up to
    /// `order` after their share of it.
    pub(super) fn new(quiet: bool, limit: Option<Duration>, order: Order, orders: usize) -> Monitor {
        Monitor {
            deadline: Deadline::new(limit, order),
            stop: None,
            live: Live::new(quiet),
            order: None,
            orders,
            step: Step::Read,
            pace: Pace::new(),
            last: None,
        }
    }

    /// Takes the live lines away.
    pub(super) fn finish(&self) {
        self.live.finish();
    }

    fn show(&mut self, sweep: Option<Sweep>) {
        let Monitor { order, step, .. } = *self;
        self.live.row(&Row { order, step, sweep });
    }
}

impl Observer for Monitor {
    fn order(&mut self, order: Order) {
        let n = self.order.map_or(1, |(_, n, _)| n + 1).min(self.orders);
        self.order = Some((order, n, self.orders));
        self.deadline.order(order);
    }

    fn step(&mut self, step: Step) {
        if step >= Step::Elevate {
            signals::heed(); // from here on there will be a mesh to keep
        }
        self.step = step;
        self.pace = Pace::new();
        self.deadline.step(step);
        self.show(None);
    }

    fn progress(&mut self, progress: &Progress) -> bool {
        let left = self.pace.left(progress);
        let due = self.live.is_redrawn() || self.last.is_none_or(|last| last.elapsed() >= INTERVAL);
        if due {
            self.last = Some(Instant::now());
            self.show(Some(Sweep::new(progress, left)));
        }
        let over = self.deadline.is_over(progress.inverted);
        let over = self.deadline.limit.filter(|_| over).map(Stop::TimeLimit);
        let stop = if signals::wished() { Some(Stop::Interrupted) } else { over };
        self.stop = stop.or(self.stop);
        stop.is_none()
    }

    fn may_recover(&mut self) -> bool {
        !signals::wished() && self.deadline.leaves_time()
    }
}
