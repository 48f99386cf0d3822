//! The local problem: the nearest point within one leaf, by Newton's method on `½|S − x|²` with the leaf's range as bounds.

use crate::geometry::chart::{Chart, Jet, Rect};
use crate::geometry::curve::{Curve, CurveJet};
use crate::tolerance::{NEWTON_LIMIT, NEWTON_STEP};
use glam::DVec3;

/// Nearest point of one leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local {
    pub(crate) parameters: [f64; 2],
    pub(crate) distance_squared: f64,
}

/// Relative steps below this are taken without asking whether the distance fell: rounding decides there.
const TRUSTED_STEP: f64 = 1e-7;

/// A relative step below this is the last one: the next would be about its square.
const LAST_STEP: f64 = 1e-6;

/// Growth of the squared distance that rounding alone may cause.
pub(crate) const ROUNDING: f64 = 1.0 + 1e-14;

/// Newton's step for the surface; a direction held at its bound does not move, and where the Hessian is not
/// positive definite the Gauss–Newton matrix takes its place.
fn step(jet: &Jet, x: DVec3, held: impl Fn(usize, f64) -> bool) -> [f64; 2] {
    let r = jet[0] - x;
    let g = [r.dot(jet[1]), r.dot(jet[2])];
    let [a, b, c] = [jet[1].length_squared(), jet[1].dot(jet[2]), jet[2].length_squared()];
    let full = [a + r.dot(jet[3]), b + r.dot(jet[4]), c + r.dot(jet[5])];
    match [held(0, g[0]), held(1, g[1])] {
        [true, true] => [0.0; 2],
        [false, true] => [-g[0] / if full[0] > 1e-3 * a { full[0] } else { a.max(f64::MIN_POSITIVE) }, 0.0],
        [true, false] => [0.0, -g[1] / if full[2] > 1e-3 * c { full[2] } else { c.max(f64::MIN_POSITIVE) }],
        [false, false] => {
            let definite = |h: &[f64; 3]| h[0] > 0.0 && h[0] * h[2] - h[1] * h[1] > 1e-6 * a * c;
            let shift = 1e-9 * (a + c) + f64::MIN_POSITIVE;
            let h = if definite(&full) { full } else { [a + shift, b, c + shift] };
            let d = (h[0] * h[2] - h[1] * h[1]).recip();
            [(h[1] * g[1] - h[2] * g[0]) * d, (h[1] * g[0] - h[0] * g[1]) * d]
        }
    }
}

/// Gradients of the foot's parameters by the query point: `H⁻¹ (S_u, S_v)`, `H` the Hessian of half the squared distance; zero where
/// that is not positive definite.
pub(crate) fn response(jet: &Jet, x: DVec3) -> [DVec3; 2] {
    let r = jet[0] - x;
    let (su, sv) = (jet[1], jet[2]);
    let [a, b, c] =
        [su.length_squared() + r.dot(jet[3]), su.dot(sv) + r.dot(jet[4]), sv.length_squared() + r.dot(jet[5])];
    let d = a * c - b * b;
    if a > 0.0 && d > 1e-6 * a * c { [(c * su - b * sv) / d, (a * sv - b * su) / d] } else { [DVec3::ZERO; 2] }
}

/// Squared distance after a small step, by Taylor's formula: no evaluation is spent on the last step.
fn ahead(jet: &Jet, x: DVec3, [a, b]: [f64; 2]) -> f64 {
    let second = 0.5 * a * a * jet[3] + a * b * jet[4] + 0.5 * b * b * jet[5];
    (jet[0] - x + a * jet[1] + b * jet[2] + second).length_squared()
}

/// Where Newton's step leads from `p`, whatever the bounds.
pub(crate) fn surface_target(jet: &Jet, x: DVec3, p: [f64; 2]) -> [f64; 2] {
    let [a, b] = step(jet, x, |_, _| false);
    [p[0] + a, p[1] + b]
}

/// Nearest point over `rect` as Newton finds it from `start`.
pub(crate) fn on_surface(chart: &Chart, rect: &Rect, x: DVec3, start: [f64; 2]) -> Local {
    let p = rect.clamp(start);
    let never = |_: [f64; 2], _: &Jet| 0.0;
    match from_jet(chart, rect, x, p, chart.d2_within(rect, p), f64::INFINITY, never) {
        Found::Minimum(local) => local,
        Found::TooFar(distance_squared) => Local { parameters: p, distance_squared },
    }
}

/// What [`from_jet`] found.
pub(crate) enum Found {
    /// The nearest point.
    Minimum(Local),
    /// No point is nearer than this squared distance, which is beyond the limit.
    TooFar(f64),
}

/// [`on_surface`] from a point whose derivatives are known, given up as soon as `floor`, a lower bound of the squared distance, exceeds
/// `limit`.
pub(crate) fn from_jet(
    chart: &Chart,
    rect: &Rect,
    x: DVec3,
    mut p: [f64; 2],
    mut jet: Jet,
    limit: f64,
    floor: impl Fn([f64; 2], &Jet) -> f64,
) -> Found {
    let mut f = (jet[0] - x).length_squared();
    let size = rect.size().map(|s| s.max(f64::MIN_POSITIVE));
    let bounds = [rect.u, rect.v];
    for _ in 0..NEWTON_LIMIT {
        if f > limit {
            let floor = floor(p, &jet);
            if floor > limit {
                return Found::TooFar(floor);
            }
        }
        let held = |i: usize, g: f64| (p[i] <= bounds[i][0] && g >= 0.0) || (p[i] >= bounds[i][1] && g <= 0.0);
        let mut s = step(&jet, x, held);
        let relative = |q: [f64; 2]| ((q[0] - p[0]).abs() / size[0]).max((q[1] - p[1]).abs() / size[1]);
        let last = rect.clamp([p[0] + s[0], p[1] + s[1]]);
        if relative(last) < LAST_STEP {
            return Found::Minimum(Local {
                parameters: last,
                distance_squared: ahead(&jet, x, [last[0] - p[0], last[1] - p[1]]),
            });
        }
        let (mut next, mut next_jet, mut next_f);
        loop {
            next = rect.clamp([p[0] + s[0], p[1] + s[1]]);
            next_jet = chart.d2_within(rect, next);
            next_f = (next_jet[0] - x).length_squared();
            if next_f <= f * ROUNDING || relative(next) < TRUSTED_STEP || !s[0].is_finite() || !s[1].is_finite() {
                break;
            }
            s = s.map(|d| 0.25 * d);
        }
        let moved = relative(next);
        if !next_f.is_finite() {
            break;
        }
        let converging = moved < TRUSTED_STEP;
        if next_f <= f * ROUNDING || converging {
            (p, jet, f) = (next, next_jet, next_f);
        }
        if converging {
            break;
        }
    }
    Found::Minimum(Local { parameters: p, distance_squared: f })
}

fn curve_step([p, d, dd]: &CurveJet, x: DVec3) -> (f64, f64) {
    let g = (*p - x).dot(*d);
    let a = d.length_squared();
    let full = a + (*p - x).dot(*dd);
    (g, -g / if full > 1e-3 * a { full } else { a.max(f64::MIN_POSITIVE) })
}

/// Nearest point over a range of a curve as Newton finds it from `start`.
pub(crate) fn on_curve(curve: &Curve, range: [f64; 2], x: DVec3, start: f64) -> Local {
    let mut t = start.clamp(range[0], range[1]);
    let mut jet = curve.d2(t);
    let mut f = (jet[0] - x).length_squared();
    let size = (range[1] - range[0]).max(f64::MIN_POSITIVE);
    for _ in 0..NEWTON_LIMIT {
        let (g, mut s) = curve_step(&jet, x);
        if (t <= range[0] && g >= 0.0) || (t >= range[1] && g <= 0.0) || !s.is_finite() {
            break;
        }
        let (mut next, mut next_jet, mut next_f, mut moved);
        loop {
            next = (t + s).clamp(range[0], range[1]);
            next_jet = curve.d2(next);
            next_f = (next_jet[0] - x).length_squared();
            moved = (next - t).abs() / size;
            if next_f <= f * ROUNDING || moved < TRUSTED_STEP || !next_f.is_finite() {
                break;
            }
            s *= 0.25;
        }
        if !next_f.is_finite() {
            break;
        }
        let converging = moved < TRUSTED_STEP;
        (t, jet, f) = (next, next_jet, next_f);
        if moved < NEWTON_STEP || (converging && moved * moved < NEWTON_STEP) {
            break;
        }
    }
    Local { parameters: [t, 0.0], distance_squared: f }
}
