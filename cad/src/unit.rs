//! Units of length that are mixed up: CAD files name theirs wrongly often enough.

/// Factors between units of length: m and mm, inch and mm, foot and mm, foot and inch, m and cm, cm and mm, m and inch.
const FACTORS: [f64; 7] = [1000.0, 25.4, 304.8, 12.0, 100.0, 10.0, 39.370_078_740_157_48];

/// How far a ratio may be off a factor, as the logarithm of their quotient: two measures of one shape differ by so much at most.
const SLACK: f64 = 0.1;

/// The factor between units of length by which something of size `theirs` has to be multiplied to be of size `ours`; `None` where the ratio
/// is near none (as when both are in the same unit).
pub fn unit_factor(ours: f64, theirs: f64) -> Option<f64> {
    let near = |factor: &f64| (ours / theirs / factor).ln().abs() < SLACK;
    FACTORS.into_iter().flat_map(|factor| [factor, factor.recip()]).find(near)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_found_and_not_guessed() {
        for (ours, theirs, factor) in
            [(117.0, 117_000.0, Some(0.001)), (2.54, 0.1, Some(25.4)), (1.0, 12.3, Some(1.0 / 12.0))]
        {
            assert_eq!(unit_factor(ours, theirs), factor);
        }
        for ratio in [1.0, 1.05, 2.0, 50.0, 1e6, 0.0, f64::NAN, f64::INFINITY] {
            assert_eq!(unit_factor(ratio, 1.0), None, "{ratio}");
        }
    }
}
