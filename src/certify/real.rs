//! The two arithmetics of the certificate: `f64`, and pairs of `f64` for what that leaves open.

use std::ops::{Add, Mul, Sub};

/// A number type whose sums and products have a known relative error.
pub(super) trait Real: Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// Largest relative error of one sum, difference or product (barring underflow).
    const ROUNDOFF: f64;
    /// Largest relative error of [`Real::difference`].
    const SHIFT_ROUNDOFF: f64;

    /// A number that `f64` holds.
    fn of(x: f64) -> Self;

    /// `x - y` of coordinates.
    fn difference(x: f64, y: f64) -> Self;

    /// The nearest `f64`, to within [`UNIT`] of its size.
    fn rounded(self) -> f64;
}

/// `u = 2^-53`, the unit roundoff of `f64`.
pub(super) const UNIT: f64 = f64::EPSILON / 2.0;

impl Real for f64 {
    const ROUNDOFF: f64 = UNIT;
    const SHIFT_ROUNDOFF: f64 = UNIT;

    fn of(x: f64) -> f64 {
        x
    }

    fn difference(x: f64, y: f64) -> f64 {
        x - y
    }

    fn rounded(self) -> f64 {
        self
    }
}

/// An unevaluated sum `high + low` with `|low| <= u |high|`.
///
/// Sums after Knuth and Dekker (error `3 u^2 + 13 u^3`), products by Veltkamp's splitting (`7 u^2` at most): Joldes,
/// Muller, Popescu, *Tight and rigorous error bounds for basic building blocks of double-word arithmetic*, 2017.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Double {
    high: f64,
    low: f64,
}

/// `a + b` exactly, as sum and error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_a = sum - b;
    let of_b = sum - of_a;
    (sum, (a - of_a) + (b - of_b))
}

/// `a + b` exactly where `|a| >= |b|` or `a = 0`.
fn fast_two_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

/// `a * b` exactly, as product and error (Dekker); coordinates are scaled so that nothing overflows.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let c = 134_217_729.0 * x; // 2^27 + 1
        let high = c - (c - x);
        (high, x - high)
    };
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    let product = a * b;
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

impl Add for Double {
    type Output = Double;
    fn add(self, other: Double) -> Double {
        let (sh, sl) = two_sum(self.high, other.high);
        let (th, tl) = two_sum(self.low, other.low);
        let v = fast_two_sum(sh, sl + th);
        fast_two_sum(v.high, tl + v.low)
    }
}

impl Sub for Double {
    type Output = Double;
    fn sub(self, other: Double) -> Double {
        self + Double { high: -other.high, low: -other.low }
    }
}

impl Mul for Double {
    type Output = Double;
    fn mul(self, other: Double) -> Double {
        let (high, error) = two_product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        fast_two_sum(high, error + cross)
    }
}

impl Real for Double {
    const ROUNDOFF: f64 = 8.0 * UNIT * UNIT;
    const SHIFT_ROUNDOFF: f64 = 0.0;

    fn of(x: f64) -> Double {
        Double { high: x, low: 0.0 }
    }

    fn difference(x: f64, y: f64) -> Double {
        let (high, low) = two_sum(x, -y);
        Double { high, low }
    }

    fn rounded(self) -> f64 {
        self.high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_keep_what_f64_drops() {
        let third = Double::difference(1.0, 1e-25) - Double::of(1.0);
        assert!((third.rounded() + 1e-25).abs() < 1e-40);
        let x = Double::of(1.0 + f64::EPSILON);
        let square = x * x - Double::of(1.0) - Double::of(2.0 * f64::EPSILON);
        assert_eq!(square.rounded(), f64::EPSILON * f64::EPSILON);
    }
}
