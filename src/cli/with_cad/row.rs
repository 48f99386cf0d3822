//! A row of the table of progress.

use std::fmt::{self, Display};
use std::time::Duration;

use crate::curve::Step;
use crate::element::Order;
use crate::smooth::Progress;

/// What a curving is doing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// The order, which of how many it is.
    pub(super) order: Option<(Order, usize, usize)>,
    pub(super) step: Step,
    pub(super) sweep: Option<Sweep>,
}

/// The sweep that the smoother has finished.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub(super) number: usize,
    /// How many there are at most.
    pub(super) most: usize,
    pub(super) active: usize,
    pub(super) inverted: usize,
    pub(super) worst: f64,
    /// How long the rest of them would take at the pace of the last.
    pub(super) left: Duration,
}

impl Sweep {
    pub(super) fn new(progress: &Progress, left: Duration) -> Sweep {
        Sweep {
            number: progress.sweep,
            most: progress.max_sweeps,
            active: progress.active_nodes,
            inverted: progress.inverted,
            worst: progress.worst,
            left,
        }
    }
}

impl Row {
    /// The names of all columns, of which the last two are the time that has passed and [`Row::estimate`].
    pub(super) fn heads() -> String {
        let [order, step, sweep, active, inverted, worst] = ["order", "step", "sweep", "active", "inverted", "worst"];
        let [elapsed, estimate] = ["elapsed", "estimate"];
        format!("{order:<9}{step:<13}{sweep:>8}{active:>9}{inverted:>9}{worst:>9}{elapsed:>10}{estimate:>9}")
    }

    /// The time that smoothing at this order may still take; it mostly ends earlier.
    pub(super) fn estimate(&self) -> String {
        self.sweep.map_or_else(String::new, |sweep| format!("< {:.0} s", sweep.left.as_secs_f64().ceil().max(1.0)))
    }
}

/// All columns but the last two.
impl Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let order = self.order.map_or_else(String::new, |(order, n, all)| format!("{order} {n}/{all}"));
        let step = match Step::ALL.iter().position(|step| *step == self.step) {
            Some(n) => format!("{}/{} {}", n + 1, Step::ALL.len(), self.step.name()),
            None => self.step.name().to_owned(),
        };
        write!(f, "{order:<9}{step:<13}")?;
        let Some(sweep) = self.sweep else { return write!(f, "{:35}", "") };
        let Sweep { number, most, active, inverted, worst, .. } = sweep;
        write!(f, "{:>8}{active:>9}{inverted:>9}{worst:>9.4}", format!("{number}/{most}"))
    }
}
