//! Curves as the search sees them: plain arrays with OCCT's own parameters, and control hulls.

use crate::boxes::Aabb;
use crate::geometry::bezier::{Bernstein, Knots, amplification, project, quotient, restrict};
use crate::tolerance::BOUND_SAFETY;
use glam::{DVec3, DVec4};
use opencascade_sys as sys;
use std::f64::consts::{FRAC_PI_4, TAU};
use std::sync::Arc;

/// Handle of one of OCCT's curves, shared by threads.
pub(crate) type CurveHandle = Arc<sys::UniquePtr<sys::Curve>>;

/// Point, first and second derivative.
pub(crate) type CurveJet = [DVec3; 3];

/// Points whose convex hull, grown by `pad`, holds a piece of a curve or surface; `sound` where that is a theorem, not an estimate.
#[derive(Clone, Debug)]
pub(crate) struct Hull {
    pub(crate) points: Vec<DVec3>,
    pub(crate) pad: f64,
    pub(crate) sound: bool,
}

impl Hull {
    pub(crate) fn of(points: Vec<DVec3>) -> Self {
        Self { points, pad: 0.0, sound: true }
    }

    /// Of a span's `poles`, restricted to `points`, which enlarged rounding errors by `amplified`. `None` where a weight is not positive, as it may be
    /// beyond the ends of a span: the points bound nothing then.
    pub(crate) fn of_span(points: &[DVec4], poles: &[DVec4], amplified: f64) -> Option<Self> {
        let least = points.iter().map(|p| p.w).fold(f64::INFINITY, f64::min);
        let hull = Self::of(points.iter().copied().map(project).collect());
        let large = || poles.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let pad = if amplified > 1.0 { 2.0 * f64::EPSILON * amplified * large() / least } else { 0.0 };
        (least > 0.0).then_some(Self { pad, ..hull })
    }

    /// How far the hull is from `x` at least: seen along the line to `p`.
    pub(crate) fn distance_towards(&self, x: DVec3, p: DVec3) -> f64 {
        let Some(n) = (p - x).try_normalize() else { return 0.0 };
        self.points.iter().map(|h| (*h - x).dot(n)).fold(f64::INFINITY, f64::min) - self.pad
    }

    pub(crate) fn bounds(&self) -> Aabb {
        Aabb::of_points(self.points.iter().copied()).grown(self.pad)
    }
}

/// A curve by its form.
pub(crate) enum Curve {
    /// `o + t d`.
    Line { o: DVec3, d: DVec3 },
    /// `o + cos t x + sin t y`: circles and ellipses.
    Conic { o: DVec3, x: DVec3, y: DVec3 },
    /// Bezier spans between knots.
    Spline(Spline),
    /// `basis` moved sideways by at most `distance`; evaluated by OCCT.
    Offset { basis: Box<Curve>, distance: f64, handle: CurveHandle },
    /// Anything else, evaluated by OCCT, hull by sampling.
    Opaque { handle: CurveHandle },
}

/// Piecewise rational Bezier curve.
pub(crate) struct Spline {
    degree: usize,
    knots: Knots,
    period: f64,
    poles: Vec<DVec4>,
}

/// OCCT's poles (x, y, z, weight) as homogeneous points.
pub(crate) fn homogeneous(poles: &[f64]) -> Vec<DVec4> {
    poles.as_chunks::<4>().0.iter().map(|&[x, y, z, w]| DVec4::new(x * w, y * w, z * w, w)).collect()
}

pub(crate) fn axes(form: &sys::Form) -> [DVec3; 4] {
    let at = |i: usize| DVec3::from_slice(&form.axes[3 * i..]);
    [at(0), at(1), at(2), at(3)]
}

impl Spline {
    pub(crate) fn new(spans: &sys::Spans) -> Self {
        Self {
            degree: spans.degree_u as usize,
            knots: Knots(spans.knots_u.clone()),
            period: spans.period_u,
            poles: homogeneous(&spans.poles),
        }
    }

    /// Whole periods to take off `t` so that it falls between the knots.
    fn shift(&self, t: f64) -> f64 {
        shift_into(t, self.knots.ends(), self.period)
    }

    fn d2(&self, t: f64) -> CurveJet {
        let t = t - self.shift(t);
        let span = self.knots.span(t);
        let (local, scale) = self.knots.local(span, t);
        let n = self.degree + 1;
        let basis: Bernstein = Bernstein::at(self.degree, local);
        let mut h = [DVec4::ZERO; 6];
        for (i, &p) in self.poles[span * n..][..n].iter().enumerate() {
            h[0] += basis.b[0][i] * p;
            h[1] += basis.b[1][i] * p;
            h[3] += basis.b[2][i] * p;
        }
        let d = quotient(h);
        [d[0], d[1] * scale, d[3] * scale * scale]
    }

    fn hull(&self, t0: f64, t1: f64) -> Option<Hull> {
        let middle = 0.5 * (t0 + t1);
        let shift = self.shift(middle);
        let span = self.knots.span(middle - shift);
        let n = self.degree + 1;
        let poles = &self.poles[span * n..][..n];
        let mut points = poles.to_vec();
        let [a, b] = [t0, t1].map(|t| self.knots.local(span, t - shift).0);
        restrict(&mut points, 0, 1, self.degree, a, b);
        Hull::of_span(&points, poles, amplification(self.degree, [a, b]))
    }
}

/// Whole periods between `t` and its image within `ends`; 0 where not periodic or within.
pub(crate) fn shift_into(t: f64, ends: (f64, f64), period: f64) -> f64 {
    if period > 0.0 && !(ends.0..=ends.1).contains(&t) { period * ((t - ends.0) / period).floor() } else { 0.0 }
}

/// Parameters strictly within `(t0, t1)` where knots, moved by whole periods, stand.
pub(crate) fn knots_within(knots: &[f64], period: f64, t0: f64, t1: f64) -> Vec<f64> {
    let slack = 1e-12 * (t1 - t0);
    let (first, last) = match (knots.first(), period > 0.0) {
        (Some(&k), true) => (((t0 - k) / period).floor() as i64 - 1, ((t1 - k) / period).ceil() as i64 + 1),
        _ => (0, 0),
    };
    let mut cuts: Vec<f64> = (first..=last)
        .flat_map(|turn| knots.iter().map(move |&k| k + turn as f64 * period))
        .filter(|&k| k > t0 + slack && k < t1 - slack)
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|a, b| (*a - *b).abs() <= slack);
    cuts
}

/// `t0`, the cuts, `t1`, each range then divided so that none is longer than `longest`.
pub(crate) fn ranges(t0: f64, t1: f64, cuts: &[f64], longest: f64) -> Vec<[f64; 2]> {
    let ends: Vec<f64> = std::iter::once(t0).chain(cuts.iter().copied()).chain(std::iter::once(t1)).collect();
    let mut all = Vec::new();
    for pair in ends.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let parts = ((b - a) / longest).ceil().clamp(1.0, 1024.0) as usize;
        let at = |i: usize| if i == parts { b } else { a + (b - a) * (i as f64 / parts as f64) };
        all.extend((0..parts).map(|i| [at(i), at(i + 1)]));
    }
    all
}

impl Curve {
    /// Copies a curve of OCCT, used over `first..=last`, into plain arrays.
    ///
    /// # Errors
    /// What OCCT threw.
    pub(crate) fn new(handle: CurveHandle, first: f64, last: f64) -> Result<Self, sys::Exception> {
        let form = handle.form()?;
        Ok(match form.kind {
            sys::Kind::Line => {
                let [o, _, _, d] = axes(&form);
                Self::Line { o, d }
            }
            sys::Kind::Circle | sys::Kind::Ellipse => {
                let [o, x, y, _] = axes(&form);
                Self::Conic { o, x: form.a * x, y: form.b * y }
            }
            sys::Kind::Bezier | sys::Kind::Bspline => Self::Spline(Spline::new(&handle.spans(first, last)?)),
            sys::Kind::Offset => {
                let basis = Self::new(Arc::new(handle.basis_curve()?), first, last)?;
                Self::Offset { basis: Box::new(basis), distance: form.a, handle }
            }
            _ => Self::Opaque { handle },
        })
    }

    /// Point and derivatives; NaN where OCCT finds none.
    pub(crate) fn d2(&self, t: f64) -> CurveJet {
        match self {
            Self::Line { o, d } => [*o + t * *d, *d, DVec3::ZERO],
            Self::Conic { o, x, y } => {
                let (sin, cos) = t.sin_cos();
                let p = cos * *x + sin * *y;
                [*o + p, cos * *y - sin * *x, -p]
            }
            Self::Spline(spline) => spline.d2(t),
            Self::Offset { handle, .. } | Self::Opaque { handle } => curve_d2(handle, t),
        }
    }

    /// Its period, 0 for none.
    pub(crate) fn period(&self) -> f64 {
        match self {
            Self::Conic { .. } => TAU,
            Self::Spline(spline) => spline.period,
            Self::Offset { basis, .. } => basis.period(),
            Self::Line { .. } | Self::Opaque { .. } => 0.0,
        }
    }

    /// Ranges of `t0..=t1` in which the curve is smooth and [`Curve::hull`] holds.
    pub(crate) fn pieces(&self, t0: f64, t1: f64) -> Vec<[f64; 2]> {
        match self {
            Self::Line { .. } => vec![[t0, t1]],
            Self::Conic { .. } => ranges(t0, t1, &[], FRAC_PI_4),
            Self::Spline(s) => ranges(t0, t1, &knots_within(&s.knots.0, s.period, t0, t1), f64::INFINITY),
            Self::Offset { basis, .. } => basis.pieces(t0, t1),
            Self::Opaque { .. } => ranges(t0, t1, &[], (t1 - t0) / 8.0),
        }
    }

    /// Hull of the part over `t0..=t1`, which must lie in one of [`Curve::pieces`].
    pub(crate) fn hull(&self, t0: f64, t1: f64) -> Hull {
        match self {
            Self::Line { .. } => Hull::of(vec![self.d2(t0)[0], self.d2(t1)[0]]),
            Self::Conic { o, x, y } => {
                let (sin, cos) = (0.5 * (t0 + t1)).sin_cos();
                let tip = *o + (cos * *x + sin * *y) / (0.5 * (t1 - t0)).cos();
                Hull::of(vec![self.d2(t0)[0], tip, self.d2(t1)[0]])
            }
            Self::Spline(spline) => spline.hull(t0, t1).unwrap_or_else(|| self.sampled_hull(t0, t1)),
            Self::Offset { basis, distance, .. } => self.offset_hull(basis, *distance, t0, t1),
            Self::Opaque { .. } => self.sampled_hull(t0, t1),
        }
    }

    fn sampled_hull(&self, t0: f64, t1: f64) -> Hull {
        let points: Vec<DVec3> = (0..=8).map(|i| self.d2(t0 + (t1 - t0) * f64::from(i) / 8.0)[0]).collect();
        let bend = points.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).length()).fold(0.0, f64::max);
        Hull { points, pad: bend, sound: false }
    }
}

impl Curve {
    /// The hull of the basis under the affine map that comes nearest to the offset, padded by how far the map is off: sampled and widened by
    /// [`BOUND_SAFETY`], as the derivatives of certificates are.
    fn offset_hull(&self, basis: &Self, distance: f64, t0: f64, t1: f64) -> Hull {
        let mut hull = basis.hull(t0, t1);
        let at = |k: u32| {
            // inside by a hair: at a knot the neighbouring span would answer
            let t = t0 + (t1 - t0) * (f64::from(k) / 7.0).clamp(1e-9, 1.0 - 1e-9);
            let on = basis.d2(t)[0];
            (on, self.d2(t)[0] - on)
        };
        let [(a, first), (b, last)] = [at(0), at(7)];
        let along = (b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE);
        let map = |x: DVec3| first + (x - a).dot(along) * (last - first);
        let off = (1..7).map(at).map(|(on, lift)| lift.distance(map(on))).fold(0.0, f64::max);
        if BOUND_SAFETY * off < distance.abs() {
            hull.points.iter_mut().for_each(|x| *x += map(*x));
            hull.pad += BOUND_SAFETY * off;
        } else {
            hull.pad += distance.abs();
        }
        hull
    }
}

/// OCCT's own evaluation; NaN where it throws.
pub(crate) fn curve_d2(handle: &CurveHandle, t: f64) -> CurveJet {
    let mut jet = [0.0; 9];
    match handle.d2(t, &mut jet) {
        Ok(()) => [0, 3, 6].map(|i| DVec3::from_slice(&jet[i..])),
        Err(_) => [DVec3::NAN; 3],
    }
}
