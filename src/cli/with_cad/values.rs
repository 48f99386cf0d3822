//! Values of options.

use clap::ValueEnum;
use clap::builder::PossibleValue;

use crate::element::Order;
use crate::smooth::Engine;

/// A finite number above 0.
pub(in crate::cli) fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| v.is_finite() && *v > 0.0);
    value.ok_or_else(|| format!("{text:?} is not a positive number"))
}

/// A number from 0 to 1.
pub(super) fn fraction(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| (0.0..=1.0).contains(v));
    value.ok_or_else(|| format!("{text:?} is not between 0 and 1"))
}

/// The order of a curved mesh.
pub(super) fn order(text: &str) -> Result<Order, String> {
    let wrong = || format!("{text:?} is not an order: give 2, 3 or 4");
    let order = text.trim_start_matches(['P', 'p']).parse::<usize>().ok().and_then(|p| Order::new(p).ok());
    order.filter(|&order| order > Order::LINEAR).ok_or_else(wrong)
}

impl ValueEnum for Engine {
    fn value_variants<'a>() -> &'a [Engine] {
        &Engine::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}
