//! Values of options.

use clap::ValueEnum;
use clap::builder::PossibleValue;

use crate::element::Order;
use crate::smooth::Engine;

/// Seconds at most: more than 30 years.
const LONGEST: f64 = 1e9;

/// A time in seconds.
pub(in crate::cli) fn seconds(text: &str) -> Result<f64, String> {
    up_to(LONGEST, text).ok_or_else(|| format!("{text:?} is no number of seconds above 0 and up to {LONGEST:e}"))
}

/// Lengths and their ratios at most: more than there is between any two units.
const LARGEST: f64 = 1e15;

/// A length.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    up_to(LARGEST, text).ok_or_else(|| format!("{text:?} is not a positive number up to {LARGEST:e}"))
}

/// What lengths are multiplied by.
pub(super) fn factor(text: &str) -> Result<f64, String> {
    let value = positive(text).ok().filter(|v| *v >= LARGEST.recip());
    value.ok_or_else(|| format!("{text:?} is not a positive number from {:e} to {LARGEST:e}", LARGEST.recip()))
}

fn up_to(largest: f64, text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|v| *v > 0.0 && *v <= largest)
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
