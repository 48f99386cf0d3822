//! Who ends the work at one order.

use sagitta::curve::{Observer, Step};
use sagitta::element::Order;
use sagitta::smooth::Progress;

/// Ends smoothing at the order `at` after so many sweeps there, and lets it go on at all others.
pub struct Impatient {
    at: usize,
    patience: usize,
    order: Order,
}

impl Impatient {
    pub fn new(at: usize, patience: usize) -> Impatient {
        Impatient { at, patience, order: Order::LINEAR }
    }
}

impl Observer for Impatient {
    fn order(&mut self, order: Order) {
        self.order = order;
    }

    fn step(&mut self, _: Step) {}

    fn progress(&mut self, _: &Progress) -> bool {
        if self.order.get() != self.at {
            return true;
        }
        self.patience = self.patience.saturating_sub(1);
        self.patience > 0
    }
}
