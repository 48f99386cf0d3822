//! Rational Bezier spans: evaluation, restriction to a sub-range, control hulls.
//!
//! Control points are homogeneous, `(w x, w y, w z, w)`, weights positive (OCCT refuses others), so a span lies in the convex
//! hull of its projected control points (Farin, *Curves and Surfaces for CAGD*). Parameters may reach beyond the outer knots, as trims do:
//! the polynomials of the outer spans go on there, in OCCT as here.

use glam::{DVec3, DVec4};

/// OCCT's largest degree.
pub(crate) const MAX_DEGREE: usize = 25;

/// Values, first and second derivatives of the Bernstein polynomials of one degree below `N` at one `t` in 0..=1.
pub(crate) struct Bernstein<const N: usize = { MAX_DEGREE + 1 }> {
    pub(crate) b: [[f64; N]; 3],
}

impl<const N: usize> Bernstein<N> {
    #[inline(always)] // degrees are constants where it matters
    pub(crate) fn at(degree: usize, t: f64) -> Self {
        let mut b = [[0.0; N]; 3];
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
#[inline(always)]
fn first_difference<const N: usize>(b: &[f64; N], k: usize, scale: f64) -> [f64; N] {
    let mut d = [0.0; N];
    for i in 0..=k {
        d[i] -= scale * b[i];
        d[i + 1] += scale * b[i];
    }
    d
}

#[inline(always)]
fn second_difference<const N: usize>(b: &[f64; N], k: usize, scale: f64) -> [f64; N] {
    let mut d = [0.0; N];
    for i in 0..=k {
        d[i] += scale * b[i];
        d[i + 1] -= 2.0 * scale * b[i];
        d[i + 2] += scale * b[i];
    }
    d
}

/// Homogeneous point and derivatives `[p, p_a, p_b, p_aa, p_ab, p_bb]` of a patch of degrees `N − 1`, `M − 1`, poles `b` fastest.
#[inline(always)]
fn blend<const N: usize, const M: usize>(patch: &[DVec4], [da, db]: [usize; 2], a: f64, b: f64) -> [DVec4; 6] {
    let (ba, bb) = (Bernstein::<N>::at(da, a), Bernstein::<M>::at(db, b));
    let mut h = [DVec4::ZERO; 6];
    for i in 0..=da {
        let row = &patch[i * (db + 1)..][..=db];
        let mut r = [DVec4::ZERO; 3];
        for j in 0..=db {
            r[0] += bb.b[0][j] * row[j];
            r[1] += bb.b[1][j] * row[j];
            r[2] += bb.b[2][j] * row[j];
        }
        h[0] += ba.b[0][i] * r[0];
        h[1] += ba.b[1][i] * r[0];
        h[2] += ba.b[0][i] * r[1];
        h[3] += ba.b[2][i] * r[0];
        h[4] += ba.b[1][i] * r[1];
        h[5] += ba.b[0][i] * r[2];
    }
    h
}

/// [`blend`] with the degrees as constants where they are usual.
pub(crate) fn patch_d2(patch: &[DVec4], degree: [usize; 2], a: f64, b: f64) -> [DVec4; 6] {
    const ANY: usize = MAX_DEGREE + 1;
    match degree {
        [1, 1] => blend::<2, 2>(patch, [1, 1], a, b),
        [1, 3] => blend::<2, 4>(patch, [1, 3], a, b),
        [3, 1] => blend::<4, 2>(patch, [3, 1], a, b),
        [2, 2] => blend::<3, 3>(patch, [2, 2], a, b),
        [2, 3] => blend::<3, 4>(patch, [2, 3], a, b),
        [3, 2] => blend::<4, 3>(patch, [3, 2], a, b),
        [3, 3] => blend::<4, 4>(patch, [3, 3], a, b),
        [3, 5] => blend::<4, 6>(patch, [3, 5], a, b),
        [5, 3] => blend::<6, 4>(patch, [5, 3], a, b),
        [5, 5] => blend::<6, 6>(patch, [5, 5], a, b),
        _ if degree[0].max(degree[1]) < 10 => blend::<10, 10>(patch, degree, a, b),
        _ => blend::<ANY, ANY>(patch, degree, a, b),
    }
}

/// The part of a span over `[a, b]` in its own parameter, in place: `degree + 1` points from `start`, `stride` apart. Beyond 0..=1 the polynomial
/// goes on, as it does in OCCT; weights may come to zero or below there.
pub(crate) fn restrict(points: &mut [DVec4], start: usize, stride: usize, degree: usize, a: f64, b: f64) {
    // whichever cut is taken first, the other is found in what it leaves: the longer part
    if b >= 1.0 - a {
        keep_left(points, start, stride, degree, b);
        keep_right(points, start, stride, degree, a / b);
    } else {
        keep_right(points, start, stride, degree, a);
        keep_left(points, start, stride, degree, (b - a) / (1.0 - a));
    }
}

/// The part up to `t`, by de Casteljau's scheme.
fn keep_left(points: &mut [DVec4], start: usize, stride: usize, degree: usize, t: f64) {
    let at = |i: usize| start + i * stride;
    if t != 1.0 {
        for level in 1..=degree {
            for i in (level..=degree).rev() {
                points[at(i)] = points[at(i - 1)].lerp(points[at(i)], t);
            }
        }
    }
}

/// The part from `t` on.
fn keep_right(points: &mut [DVec4], start: usize, stride: usize, degree: usize, t: f64) {
    let at = |i: usize| start + i * stride;
    if t != 0.0 {
        for level in 1..=degree {
            for i in 0..=degree - level {
                points[at(i)] = points[at(i)].lerp(points[at(i + 1)], t);
            }
        }
    }
}

/// By how much [`restrict`] to `[a, b]` may enlarge rounding errors: 1 within 0..=1.
pub(crate) fn amplification(degree: usize, [a, b]: [f64; 2]) -> f64 {
    let step = 1.0 + 2.0 * (-a).max(b - 1.0).max(0.0);
    step.powi(2 * degree as i32)
}

/// Projected point of a homogeneous one.
pub(crate) fn project(p: DVec4) -> DVec3 {
    p.truncate() / p.w
}

/// Position and derivatives in space from homogeneous ones: `[p, p_a, p_b, p_aa, p_ab, p_bb]` (quotient rule).
pub(crate) fn quotient(h: [DVec4; 6]) -> [DVec3; 6] {
    let [p, a, b, aa, ab, bb] = h;
    if p.w == 1.0 && [a, b, aa, ab, bb].iter().all(|d| d.w == 0.0) {
        return h.map(DVec4::truncate);
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Over parts within, across and wholly beyond an end, the part's own points give the same curve.
    #[test]
    fn a_part_is_the_same_polynomial_also_beyond_the_ends() {
        let point =
            |i: i32| DVec4::new(f64::from(i), f64::from(i * i % 5), f64::from(3 - i), 1.0 + 0.1 * f64::from(i % 3));
        let whole: Vec<DVec4> = (0..5).map(point).collect();
        let at = |points: &[DVec4], t: f64| {
            let basis: Bernstein = Bernstein::at(4, t);
            points.iter().zip(basis.b[0]).map(|(p, b)| b * *p).sum::<DVec4>()
        };
        for (a, b) in
            [(0.0, 1.0), (0.2, 0.7), (-0.3, 0.0), (-1.0, 1e-9), (1.0, 1.4), (-0.2, 1.3), (-2.0, -1.0), (2.0, 2.5)]
        {
            let mut part = whole.clone();
            restrict(&mut part, 0, 1, 4, a, b);
            for k in 0..=8 {
                let t = f64::from(k) / 8.0;
                let (here, there) = (at(&part, t), at(&whole, a + t * (b - a)));
                let slack = 1e-15 * 10.0 * amplification(4, [a, b]);
                assert!(here.distance(there) <= slack, "{a} to {b}, {t}: {here} and {there}");
            }
        }
    }
}
