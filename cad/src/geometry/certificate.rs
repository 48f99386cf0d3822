//! When is the foot in a leaf the only one? Where `½|S − x|²` is convex over the leaf's parameters.
//!
//! In parameters scaled so that the tangents at the leaf's centre `c` are orthonormal, the Hessian is `G + (S − x)·S''` with `G = I` at the
//! centre. Over the leaf it differs from `I + (c − x)·S''(c)` by no more than `dg + q + |c − x|·df`, where `dg` bounds the change of
//! `G`, `q` the products `(S − c)·S''` and `df` the change of `S''`. `S''` is sampled (4 × 4 points), `S` ranges over the hull, and the
//! three are widened by [`BOUND_SAFETY`]; the leaf is certified while the smallest eigenvalue at the centre exceeds their sum.

use crate::geometry::chart::{Chart, Jet, Rect};
use crate::geometry::curve::{Curve, Hull};
use crate::tolerance::BOUND_SAFETY;
use glam::DVec3;

/// What [`Certificate::modulus`] needs to know about a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Certificate {
    /// Point and derivatives at the centre; a curve fills 0, 1 and 3.
    jet: Jet,
    /// Columns of `T`, see [`scaling`].
    scaling: [f64; 3],
    /// `S''` at the centre in scaled parameters: 11, 12, 22 (a curve uses the first alone).
    second: [DVec3; 3],
    dg: f64,
    q: f64,
    df: f64,
    radius: f64,
}

/// Scaled derivatives: tangents and second derivatives after `u' = T⁻¹ u`, `T` lower triangular by Gram–Schmidt.
struct Scaled {
    first: [DVec3; 2],
    second: [DVec3; 3],
}

/// Columns of `T`: `S_u' = t0 S_u`, `S_v' = t1 S_u + t2 S_v`. `None` where the tangents are dependent.
fn scaling(jet: &Jet) -> Option<[f64; 3]> {
    let t0 = jet[1].length().recip();
    let a = jet[1] * t0;
    let b = jet[2] - jet[2].dot(a) * a;
    let t2 = b.length().recip();
    let sound = t0.is_finite() && t2.is_finite() && b.length() > 1e-9 * jet[2].length();
    sound.then(|| [t0, -jet[2].dot(a) * t0 * t2, t2])
}

fn scaled(jet: &Jet, [t0, t1, t2]: [f64; 3]) -> Scaled {
    let [_, a, b, aa, ab, bb] = *jet;
    Scaled {
        first: [t0 * a, t1 * a + t2 * b],
        second: [t0 * t0 * aa, t0 * (t1 * aa + t2 * ab), t1 * t1 * aa + 2.0 * t1 * t2 * ab + t2 * t2 * bb],
    }
}

/// Smallest eigenvalue of `I + [[a, b], [b, c]]`.
fn smallest([a, b, c]: [f64; 3]) -> f64 {
    1.0 + 0.5 * ((a + c) - ((a - c) * (a - c) + 4.0 * b * b).sqrt())
}

/// A leaf over which `½|S − x|²` is strictly convex: its Hessian in scaled parameters is at least `modulus`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bowl {
    scaling: [f64; 3],
    modulus: f64,
}

impl Bowl {
    /// Whether, seen from this `x` alone, `½|S − x|²` is strictly convex over `rect`: the Hessian at the centre against its change, sampled
    /// at 3 × 3 points and widened by [`BOUND_SAFETY`].
    pub(crate) fn over(chart: &Chart, rect: &Rect, x: DVec3, center: &Jet) -> Option<Self> {
        let t = scaling(center)?;
        let hessian = |jet: &Jet| {
            let Scaled { first: [a, b], second } = scaled(jet, t);
            let [aa, ab, bb] = second.map(|s| s.dot(jet[0] - x));
            [a.dot(a) - 1.0 + aa, a.dot(b) + ab, b.dot(b) - 1.0 + bb]
        };
        let middle = hessian(center);
        let least = smallest(middle);
        let mut change = 0.0_f64;
        for k in [0, 1, 2, 3, 5, 6, 7, 8] {
            let here = hessian(&chart.d2_within(rect, rect.at(f64::from(k / 3) / 2.0, f64::from(k % 3) / 2.0)));
            let d = [0, 1, 2].map(|i| here[i] - middle[i]);
            change = change.max((d[0] * d[0] + 2.0 * d[1] * d[1] + d[2] * d[2]).sqrt());
            if least <= BOUND_SAFETY * change {
                return None;
            }
        }
        let modulus = least - BOUND_SAFETY * change;
        (modulus > 0.0).then_some(Self { scaling: t, modulus })
    }

    /// Lower bound of `|S − x|²` over `rect` from one point `p` of it: a convex function lies above its tangent, and above the
    /// paraboloid that the least curvature allows.
    pub(crate) fn floor(&self, rect: &Rect, p: [f64; 2], jet: &Jet, x: DVec3) -> f64 {
        let r = jet[0] - x;
        let g = [r.dot(jet[1]), r.dot(jet[2])];
        let fall = |i: usize, range: [f64; 2]| (g[i] * (range[0] - p[i])).min(g[i] * (range[1] - p[i]));
        let tangent = fall(0, rect.u) + fall(1, rect.v);
        let [t0, t1, t2] = self.scaling;
        let (a, b) = (t0 * g[0], t1 * g[0] + t2 * g[1]);
        let paraboloid = -(a * a + b * b) / (2.0 * self.modulus);
        // the differences of large numbers are rounded
        r.length_squared() * (1.0 - FLOOR_ROUNDING) + 2.0 * tangent.max(paraboloid)
    }
}

/// Relative rounding of [`Bowl::floor`].
const FLOOR_ROUNDING: f64 = 1e-13;

fn norm(second: &[DVec3; 3]) -> f64 {
    (second[0].length_squared() + 2.0 * second[1].length_squared() + second[2].length_squared()).sqrt()
}

/// Largest products of hull points, seen from the centre, with second derivatives (Frobenius norm of a symmetric 2 × 2 matrix).
fn products(hull: &Hull, center: DVec3, second: &[DVec3; 3]) -> f64 {
    let [a, b, c] = second.map(|s| {
        let reach = hull.points.iter().map(|p| (*p - center).dot(s).abs()).fold(0.0, f64::max);
        reach + hull.pad * s.length()
    });
    (a * a + 2.0 * b * b + c * c).sqrt()
}

fn radius(hull: &Hull, center: DVec3) -> f64 {
    hull.points.iter().map(|p| p.distance(center)).fold(0.0, f64::max) + hull.pad
}

impl Certificate {
    /// Of a surface over `rect`; `None` where the tangents vanish (poles) or OCCT finds no derivatives.
    pub(crate) fn of_surface(chart: &Chart, rect: &Rect, hull: &Hull) -> Option<Self> {
        let jet = chart.d2_within(rect, rect.center());
        let t = scaling(&jet)?;
        let center = scaled(&jet, t);
        let (mut dg, mut q, mut df) = (0.0_f64, products(hull, jet[0], &center.second), 0.0_f64);
        for k in 0..16 {
            let at = rect.at(f64::from(k / 4) / 3.0, f64::from(k % 4) / 3.0);
            let here = scaled(&chart.d2_within(rect, at), t);
            let [a, b] = here.first;
            let g = [a.dot(a) - 1.0, a.dot(b), b.dot(b) - 1.0];
            dg = dg.max((g[0] * g[0] + 2.0 * g[1] * g[1] + g[2] * g[2]).sqrt());
            q = q.max(products(hull, jet[0], &here.second));
            df = df.max(norm(&[0, 1, 2].map(|i| here.second[i] - center.second[i])));
        }
        let certificate = Self {
            jet,
            scaling: t,
            second: center.second,
            dg: BOUND_SAFETY * dg,
            q: BOUND_SAFETY * q,
            df: BOUND_SAFETY * df,
            radius: radius(hull, jet[0]),
        };
        (dg + q + df).is_finite().then_some(certificate)
    }

    /// Of a curve over `t0..=t1`.
    pub(crate) fn of_curve(curve: &Curve, [t0, t1]: [f64; 2], hull: &Hull) -> Option<Self> {
        let [p, a, aa] = curve.d2(0.5 * (t0 + t1));
        let t = a.length().recip();
        let second = t * t * aa;
        let along = |s: DVec3| products(hull, p, &[s, DVec3::ZERO, DVec3::ZERO]);
        let (mut dg, mut q, mut df) = (0.0_f64, along(second), 0.0_f64);
        for k in 0..7 {
            // inside by a hair: at a knot the neighbouring span would answer
            let fraction = (f64::from(k) / 6.0).clamp(1e-9, 1.0 - 1e-9);
            let [_, b, bb] = curve.d2(t0 + (t1 - t0) * fraction);
            dg = dg.max((t * t * b.length_squared() - 1.0).abs());
            q = q.max(along(t * t * bb));
            df = df.max((t * t * bb - second).length());
        }
        let zero = DVec3::ZERO;
        let certificate = Self {
            jet: [p, a, zero, aa, zero, zero],
            scaling: [t, 0.0, 0.0],
            second: [second, DVec3::ZERO, DVec3::ZERO],
            dg: BOUND_SAFETY * dg,
            q: BOUND_SAFETY * q,
            df: BOUND_SAFETY * df,
            radius: radius(hull, p),
        };
        (dg + q + df).is_finite().then_some(certificate)
    }

    /// Lower bound of the eigenvalues of the scaled Hessian of `½|S − x|²` over the leaf. Where it is positive, the distance from `x`
    /// has one minimum only.
    pub(crate) fn modulus(&self, x: DVec3) -> f64 {
        let r = self.jet[0] - x;
        smallest(self.second.map(|s| s.dot(r))) - (self.dg + self.q + r.length() * self.df)
    }

    /// Point and derivatives at the centre; those of a curve at 0, 1 and 3.
    pub(crate) fn jet(&self) -> &Jet {
        &self.jet
    }

    /// Where the Hessian is at least `modulus`.
    pub(crate) fn bowl(&self, modulus: f64) -> Bowl {
        Bowl { scaling: self.scaling, modulus }
    }

    /// Turn of the tangents over the leaf, about, in radians (their stretch counts in part); leaves are cut until it is small.
    pub(crate) fn turn(&self) -> f64 {
        (0.6 * self.dg).max(self.q)
    }

    /// Largest distance of a point of the leaf from its centre.
    pub(crate) fn radius(&self) -> f64 {
        self.radius
    }
}
