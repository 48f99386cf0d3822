//! Tables that are computed once for each cell and order.

use std::sync::OnceLock;

use super::{Cell, Order};

/// One table for each cell and order, computed when it is first asked for.
#[derive(Debug)]
pub struct Tables<T>([[OnceLock<T>; Order::MAX.get()]; Cell::ALL.len()]);

impl<T> Tables<T> {
    /// Tables that are all still to be computed.
    #[must_use]
    pub const fn new() -> Tables<T> {
        Tables([const { [const { OnceLock::new() }; Order::MAX.get()] }; Cell::ALL.len()])
    }

    /// The table of a cell and order, by `build` where it is asked for the first time.
    pub fn get(&self, cell: Cell, order: Order, build: impl FnOnce() -> T) -> &T {
        self.0[cell as usize][order.get() - 1].get_or_init(build)
    }
}

impl<T> Default for Tables<T> {
    fn default() -> Tables<T> {
        Tables::new()
    }
}
