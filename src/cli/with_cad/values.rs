//! Values of options.

/// A finite number above 0.
pub(in crate::cli) fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|v| v.is_finite() && *v > 0.0);
    value.ok_or_else(|| format!("{text:?} is not a positive number"))
}
