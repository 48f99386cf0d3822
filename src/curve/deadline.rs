//! The time that a curving may take, and how the orders and recovery share it.

use std::time::{Duration, Instant};

use super::observer::Step;
use crate::element::Order;

/// The share of the time after which smoothing ends while elements are inverted; the rest is left to recovery. The orders below end, one
/// after the other, within this share as well, so that the order asked for has its time.
const SMOOTHING: f64 = 0.6;

/// A limit of time, told by an observer of each order and step that begins.
#[derive(Clone, Debug)]
pub struct Deadline {
    /// The limit; `None` never ends.
    pub limit: Option<Duration>,
    last_order: Order,
    order: Option<Order>,
    step: Option<Step>,
    start: Instant,
}

impl Deadline {
    /// Begins to count the time of a curving to an order.
    #[must_use]
    pub fn new(limit: Option<Duration>, order: Order) -> Deadline {
        Deadline { limit, last_order: order, order: None, step: None, start: Instant::now() }
    }

    /// An order begins.
    pub fn order(&mut self, order: Order) {
        self.order = Some(order);
    }

    /// A step begins.
    pub fn step(&mut self, step: Step) {
        self.step = Some(step);
    }

    /// Whether the sweeps of the step in work have to end, while so many elements are inverted.
    #[must_use]
    pub fn is_over(&self, inverted: usize) -> bool {
        let share = self.share(inverted);
        self.limit.is_some_and(|limit| self.start.elapsed() >= limit.mul_f64(share))
    }

    /// Whether there is time left at all.
    #[must_use]
    pub fn leaves_time(&self) -> bool {
        self.limit.is_none_or(|limit| self.start.elapsed() < limit)
    }

    /// The share of the limit at which the order in work has to end its smoothing.
    fn share(&self, inverted: usize) -> f64 {
        let steps = |order: Order| order.get().saturating_sub(1).max(1) as f64;
        if let Some(order) = self.order.filter(|&order| order < self.last_order) {
            return SMOOTHING * steps(order) / steps(self.last_order);
        }
        if self.step == Some(Step::Smooth) && inverted > 0 { SMOOTHING } else { 1.0 }
    }
}
