//! Rational Bezier spans: evaluation, restriction to a sub-range, control hulls.
//!
//! Control points are homogeneous, `(w x, w y, w z, w)`, weights positive (OCCT refuses others), so a span lies in the convex
//! hull of its projected control points (Farin, *Curves and Surfaces for CAGD*).

use glam::{DVec3, DVec4};

/// OCCT's largest degree.
pub(crate) const MAX_DEGREE: usize = 25;

/// Values, first and second derivatives of the Bernstein polynomials of one degree at one `t` in 0..=1.
pub(crate) struct Bernstein {
    pub(crate) b: [[f64; MAX_DEGREE + 1]; 3],
}

impl Bernstein {
    pub(crate) fn at(degree: usize, t: f64) -> Self {
        let mut b = [[0.0; MAX_DEGREE + 1]; 3];
        let s = 1.0 - t;
        b[0][0] = 1.0;
        let n = degree as f64;
        for k in 0..degree {
            if k + 2 == degree {
                b[2] = second_difference(&b[0], k, n * (n - 1.0));
            }
            if k + 1 == degree {
                b[1] = first_difference(&b[0], k, n);
            }
            let mut carry = 0.0;
            for value in b[0].iter_mut().take(k + 2) {
                let old = *value;
                *value = s * old + t * carry;
                carry = old;
            }
        }
        Self { b }
    }
}

/// `n (B_{i-1} − B_i)` from the polynomials of degree `k`.
fn first_difference(b: &[f64; MAX_DEGREE + 1], k: usize, scale: f64) -> [f64; MAX_DEGREE + 1] {
    let mut d = [0.0; MAX_DEGREE + 1];
    for i in 0..=k {
        d[i] -= scale * b[i];
        d[i + 1] += scale * b[i];
    }
    d
}

fn second_difference(b: &[f64; MAX_DEGREE + 1], k: usize, scale: f64) -> [f64; MAX_DEGREE + 1] {
    let mut d = [0.0; MAX_DEGREE + 1];
    for i in 0..=k {
        d[i] += scale * b[i];
        d[i + 1] -= 2.0 * scale * b[i];
        d[i + 2] += scale * b[i];
    }
    d
}

/// The part of a span over `[a, b]` (in its 0..=1), in place. `stride` apart, `degree + 1` points from `start`.
pub(crate) fn restrict(points: &mut [DVec4], start: usize, stride: usize, degree: usize, a: f64, b: f64) {
    let at = |i: usize| start + i * stride;
    if b < 1.0 {
        for level in 1..=degree {
            for i in (level..=degree).rev() {
                points[at(i)] = points[at(i - 1)].lerp(points[at(i)], b);
            }
        }
    }
    let a = if b > 0.0 { a / b } else { 0.0 };
    if a > 0.0 {
        for level in 1..=degree {
            for i in 0..=degree - level {
                points[at(i)] = points[at(i)].lerp(points[at(i + 1)], a);
            }
        }
    }
}

/// Projected point of a homogeneous one.
pub(crate) fn project(p: DVec4) -> DVec3 {
    p.truncate() / p.w
}

/// Position and derivatives in space from homogeneous ones: `[p, p_a, p_b, p_aa, p_ab, p_bb]` (quotient rule).
pub(crate) fn quotient(h: [DVec4; 6]) -> [DVec3; 6] {
    let [p, a, b, aa, ab, bb] = h;
    let w = p.w.recip();
    let s = p.truncate() * w;
    let sa = (a.truncate() - s * a.w) * w;
    let sb = (b.truncate() - s * b.w) * w;
    let second = |d: DVec4, s1: DVec3, w1: f64, s2: DVec3, w2: f64| (d.truncate() - s1 * w2 - s2 * w1 - s * d.w) * w;
    [s, sa, sb, second(aa, sa, a.w, sa, a.w), second(ab, sa, a.w, sb, b.w), second(bb, sb, b.w, sb, b.w)]
}

/// Knots that bound Bezier spans and the span of a parameter.
#[derive(Clone, Debug)]
pub(crate) struct Knots(pub(crate) Vec<f64>);

impl Knots {
    /// Span that holds `t`; the outer spans extend beyond the ends.
    pub(crate) fn span(&self, t: f64) -> usize {
        self.0.partition_point(|&k| k <= t).clamp(1, self.0.len() - 1) - 1
    }

    /// `t` in the span's own 0..=1 and the factor `d(local)/dt`.
    pub(crate) fn local(&self, span: usize, t: f64) -> (f64, f64) {
        let (a, b) = (self.0[span], self.0[span + 1]);
        let scale = (b - a).recip();
        ((t - a) * scale, scale)
    }

    pub(crate) fn ends(&self) -> (f64, f64) {
        (self.0[0], self.0[self.0.len() - 1])
    }
}
