//! Progress on stderr: a live line on a terminal, plain lines elsewhere; and what ends the smoothing early.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::output::message;
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
    deadline: Option<Deadline>,
    /// Why smoothing was ended, once it was.
    pub(super) stop: Option<Stop>,
    bar: Option<ProgressBar>,
    quiet: bool,
    order: Option<Order>,
    step: Option<Step>,
    start: Instant,
    smoothing: Option<Instant>,
    last: Option<Instant>,
}

impl Monitor {
    /// Begins to count the time.
    pub(super) fn new(quiet: bool) -> Monitor {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(spinner);
        Monitor {
            deadline: None,
            stop: None,
            bar,
            quiet,
            order: None,
            step: None,
            start: Instant::now(),
            smoothing: None,
            last: None,
        }
    }

    /// Ends smoothing after a time limit, too, and that at orders below `order` after their share of it.
    pub(super) fn stoppable(self, limit: Option<Duration>, order: Order) -> Monitor {
        Monitor { deadline: Some(Deadline::new(limit, order)), ..self }
    }

    /// Takes the live line away.
    pub(super) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    /// Shows what is being done.
    pub(super) fn show(&self, text: String) {
        match &self.bar {
            Some(bar) => bar.set_message(text),
            None if self.quiet => {}
            None => message(format_args!("[{:7.1} s] {text}", self.start.elapsed().as_secs_f64())),
        }
    }
}

fn spinner() -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} [{elapsed}] {wide_msg}") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

impl Observer for Monitor {
    fn order(&mut self, order: Order) {
        self.order = Some(order);
        self.deadline.iter_mut().for_each(|deadline| deadline.order(order));
    }

    fn step(&mut self, step: Step) {
        if step >= Step::Elevate {
            signals::heed(); // from here on there will be a mesh to keep
        }
        if step == Step::Smooth {
            self.smoothing = Some(Instant::now());
        }
        self.step = Some(step);
        self.deadline.iter_mut().for_each(|deadline| deadline.step(step));
        let order = self.order.map_or(String::new(), |order| format!(", {order}"));
        if step == Step::Recover {
            return self.show(format!("{}{order}", step.name()));
        }
        self.show(format!("step {} of {}: {}{order}", step as usize + 1, Step::ALL.len(), step.name()));
    }

    fn progress(&mut self, progress: &Progress) -> bool {
        let due = self.bar.is_some() || self.last.is_none_or(|last| last.elapsed() >= INTERVAL);
        if due {
            self.last = Some(Instant::now());
            let spent = self.smoothing.map_or(0.0, |start| start.elapsed().as_secs_f64());
            let left = spent / progress.sweep.max(1) as f64 * (progress.max_sweeps - progress.sweep) as f64;
            self.show(format!(
                "{}{}: stage {}, sweep {} of at most {}, {} active nodes, worst cost {:.4} near ({:.4}, {:.4}, {:.4}), \
                 {} inverted, at most {left:.0} s left",
                self.step.map_or("smooth", Step::name),
                self.order.map_or(String::new(), |order| format!(" {order}")),
                progress.stage,
                progress.sweep,
                progress.max_sweeps,
                progress.active_nodes,
                progress.worst,
                progress.at.x,
                progress.at.y,
                progress.at.z,
                progress.inverted
            ));
        }
        let over = self.deadline.as_ref().filter(|deadline| deadline.is_over(progress.inverted));
        let over = over.and_then(|deadline| deadline.limit).map(Stop::TimeLimit);
        let stop = if signals::wished() { Some(Stop::Interrupted) } else { over };
        self.stop = stop.or(self.stop);
        stop.is_none()
    }

    fn may_recover(&mut self) -> bool {
        !signals::wished() && self.deadline.as_ref().is_none_or(Deadline::leaves_time)
    }
}
