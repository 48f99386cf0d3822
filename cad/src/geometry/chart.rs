//! Surfaces as the search sees them: plain arrays with OCCT's own parameters, and control hulls.
//!
//! No conversion to NURBS takes place: elementary and swept surfaces keep their closed forms and B-splines are cut into Bezier
//! spans, so that parameters, pcurves and trims are those of the file.

use crate::geometry::bezier::{Knots, amplification, patch_d2, quotient, restrict};
use crate::geometry::curve::{Curve, Hull, axes, homogeneous, knots_within, ranges, shift_into};
use crate::tolerance::BOUND_SAFETY;
use glam::{DVec3, DVec4};
use opencascade_sys as sys;
use std::f64::consts::{FRAC_PI_4, TAU};
use std::sync::Arc;

/// Share of a range within which its border is near.
const HAIR: f64 = 1e-9;

/// Handle of one of OCCT's surfaces, shared by threads.
pub(crate) type SurfaceHandle = Arc<sys::UniquePtr<sys::Surface>>;

/// `S, S_u, S_v, S_uu, S_uv, S_vv`.
pub(crate) type Jet = [DVec3; 6];

/// A range of parameters `[u0, u1, v0, v1]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rect {
    pub(crate) u: [f64; 2],
    pub(crate) v: [f64; 2],
}

impl Rect {
    pub(crate) fn center(&self) -> [f64; 2] {
        self.at(0.5, 0.5)
    }

    /// Parameters at fractions of the two ranges.
    pub(crate) fn at(&self, a: f64, b: f64) -> [f64; 2] {
        [self.u[0] + a * (self.u[1] - self.u[0]), self.v[0] + b * (self.v[1] - self.v[0])]
    }

    pub(crate) fn size(&self) -> [f64; 2] {
        [self.u[1] - self.u[0], self.v[1] - self.v[0]]
    }

    pub(crate) fn clamp(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [u.clamp(self.u[0], self.u[1]), v.clamp(self.v[0], self.v[1])]
    }

    /// Four parts that meet at parameters inside.
    pub(crate) fn quarters(&self, [u, v]: [f64; 2]) -> [Self; 4] {
        let (us, vs) = ([[self.u[0], u], [u, self.u[1]]], [[self.v[0], v], [v, self.v[1]]]);
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| Self { u: us[i], v: vs[j] })
    }

    /// Two halves, cut across direction 0 (u) or 1 (v).
    pub(crate) fn halves(&self, direction: usize) -> [Self; 2] {
        let [u, v] = self.center();
        if direction == 0 {
            [Self { u: [self.u[0], u], ..*self }, Self { u: [u, self.u[1]], ..*self }]
        } else {
            [Self { v: [self.v[0], v], ..*self }, Self { v: [v, self.v[1]], ..*self }]
        }
    }
}

/// Axis of a surface of revolution: `turn` is 1 where `u` turns by the right hand, else -1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    pub(crate) o: DVec3,
    pub(crate) z: DVec3,
    /// Direction of `u = 0` of elementary surfaces.
    pub(crate) x: DVec3,
    pub(crate) turn: f64,
}

impl Axis {
    /// Height, radial part, and the direction in which `u` moves it (unit turn).
    pub(crate) fn split(&self, p: DVec3) -> (f64, DVec3, DVec3) {
        let h = (p - self.o).dot(self.z);
        let r = p - self.o - h * self.z;
        (h, r, self.turn * self.z.cross(r))
    }
}

/// Tensor-product piecewise rational Bezier surface.
pub(crate) struct Net {
    degree: [usize; 2],
    u: Knots,
    v: Knots,
    period: [f64; 2],
    poles: Vec<DVec4>,
}

/// A surface by its form.
pub(crate) enum Chart {
    /// `o + u x + v y`.
    Plane { o: DVec3, x: DVec3, y: DVec3 },
    /// `meridian(v)` turned by `u`; `flat` where the meridian is a line or circular arc in a half plane of the axis.
    Spun { axis: Axis, meridian: Curve, flat: bool },
    /// `profile(u) + v d`.
    Swept { profile: Curve, d: DVec3 },
    /// Bezier spans.
    Net(Net),
    /// Offset of a basis surface by `distance`; evaluated by OCCT.
    Offset { basis: Box<Chart>, distance: f64, handle: SurfaceHandle },
    /// Anything else, evaluated by OCCT, hull by sampling.
    Opaque { handle: SurfaceHandle },
}

impl Net {
    fn new(spans: &sys::Spans) -> Self {
        Self {
            degree: [spans.degree_u as usize, spans.degree_v as usize],
            u: Knots(spans.knots_u.clone()),
            v: Knots(spans.knots_v.clone()),
            period: [spans.period_u, spans.period_v],
            poles: homogeneous(&spans.poles),
        }
    }

    fn shift(&self, u: f64, v: f64) -> [f64; 2] {
        [shift_into(u, self.u.ends(), self.period[0]), shift_into(v, self.v.ends(), self.period[1])]
    }

    /// Spans that hold the parameters: `[i, j]`.
    fn span(&self, u: f64, v: f64) -> [usize; 2] {
        [self.u.span(u), self.v.span(v)]
    }

    fn patch(&self, [i, j]: [usize; 2]) -> &[DVec4] {
        let count = (self.degree[0] + 1) * (self.degree[1] + 1);
        &self.poles[(i * (self.v.0.len() - 1) + j) * count..][..count]
    }

    fn d2_in(&self, span: [usize; 2], u: f64, v: f64) -> Jet {
        let (a, su) = self.u.local(span[0], u);
        let (b, sv) = self.v.local(span[1], v);
        let h = patch_d2(self.patch(span), self.degree, a, b);
        let d = quotient(h);
        [d[0], d[1] * su, d[2] * sv, d[3] * su * su, d[4] * su * sv, d[5] * sv * sv]
    }

    fn hull(&self, rect: Rect) -> Option<Hull> {
        let [u, v] = rect.center();
        let shift = self.shift(u, v);
        let span = self.span(u - shift[0], v - shift[1]);
        let poles = self.patch(span);
        let mut points = poles.to_vec();
        let [a, b] = rect.u.map(|u| self.u.local(span[0], u - shift[0]).0);
        let [c, d] = rect.v.map(|v| self.v.local(span[1], v - shift[1]).0);
        let stride = self.degree[1] + 1;
        for j in 0..stride {
            restrict(&mut points, j, stride, self.degree[0], a, b);
        }
        for i in 0..=self.degree[0] {
            restrict(&mut points, i * stride, 1, self.degree[1], c, d);
        }
        let amplified = amplification(self.degree[0], [a, b]) * amplification(self.degree[1], [c, d]);
        Hull::of_span(&points, poles, amplified)
    }
}

impl Chart {
    /// Copies a surface of OCCT, used over `rect`, into plain arrays.
    ///
    /// # Errors
    /// What OCCT threw.
    pub(crate) fn new(handle: SurfaceHandle, rect: Rect) -> Result<Self, sys::Exception> {
        let form = handle.form()?;
        Ok(match form.kind {
            sys::Kind::Plane => {
                let [o, x, y, _] = axes(&form);
                Self::Plane { o, x, y }
            }
            sys::Kind::Cylinder | sys::Kind::Cone | sys::Kind::Sphere | sys::Kind::Torus => Self::elementary(&form),
            sys::Kind::Revolution => {
                let [o, x, _, z] = axes(&form);
                let meridian = Curve::new(Arc::new(handle.basis_curve()?), rect.v[0], rect.v[1])?;
                Self::Spun { axis: Axis { o, z, x, turn: 1.0 }, meridian, flat: false }
            }
            sys::Kind::Extrusion => {
                let [.., d] = axes(&form);
                Self::Swept { profile: Curve::new(Arc::new(handle.basis_curve()?), rect.u[0], rect.u[1])?, d }
            }
            sys::Kind::Bezier | sys::Kind::Bspline => Self::Net(Net::new(&handle.spans()?)),
            sys::Kind::Offset => {
                let basis = Self::new(Arc::new(handle.basis_surface()?), rect)?;
                Self::Offset { basis: Box::new(basis), distance: form.a, handle }
            }
            _ => Self::Opaque { handle },
        })
    }

    /// Cylinder, cone, sphere and torus, as `ElSLib` parametrises them.
    fn elementary(form: &sys::Form) -> Self {
        let [o, x, y, z] = axes(form);
        let (a, b) = (form.a, form.b);
        let meridian = match form.kind {
            sys::Kind::Cylinder => Curve::Line { o: o + a * x, d: z },
            sys::Kind::Cone => Curve::Line { o: o + a * x, d: b.sin() * x + b.cos() * z },
            sys::Kind::Sphere => Curve::Conic { o, x: a * x, y: a * z },
            _ => Curve::Conic { o: o + a * x, x: b * x, y: b * z },
        };
        Self::Spun { axis: Axis { o, z, x, turn: x.cross(y).dot(z).signum() }, meridian, flat: true }
    }

    /// Point and derivatives; NaN where OCCT finds none.
    pub(crate) fn d2(&self, u: f64, v: f64) -> Jet {
        match self {
            Self::Plane { o, x, y } => [*o + u * *x + v * *y, *x, *y, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO],
            Self::Spun { axis, meridian, .. } => spin(axis, meridian.d2(v), u),
            Self::Swept { profile, d } => {
                let c = profile.d2(u);
                [c[0] + v * *d, c[1], *d, c[2], DVec3::ZERO, DVec3::ZERO]
            }
            Self::Net(net) => {
                let [su, sv] = net.shift(u, v);
                net.d2_in(net.span(u - su, v - sv), u - su, v - sv)
            }
            Self::Offset { handle, .. } | Self::Opaque { handle } => surface_d2(handle, u, v),
        }
    }

    /// [`Chart::d2`] by the span that holds `rect`, so that derivatives at a knot are those of the side of `rect`.
    pub(crate) fn d2_within(&self, rect: &Rect, [u, v]: [f64; 2]) -> Jet {
        let net = match self {
            Self::Net(net) => net,
            Self::Offset { .. } => return self.d2_inside(rect, [u, v]),
            _ => return self.d2(u, v),
        };
        let center = rect.center();
        let [su, sv] = net.shift(center[0], center[1]);
        net.d2_in(net.span(center[0] - su, center[1] - sv), u - su, v - sv)
    }

    /// [`Chart::d2`] where OCCT evaluates and second derivatives jump at the borders of `rect` (as those of the offset of a spline do at knots):
    /// from a point inside by a hair, led on by Taylor's formula.
    fn d2_inside(&self, rect: &Rect, [u, v]: [f64; 2]) -> Jet {
        let inside = |t: f64, [a, b]: [f64; 2]| t.clamp(a + HAIR * (b - a), b - HAIR * (b - a));
        let (p, q) = (inside(u, rect.u), inside(v, rect.v));
        let (du, dv) = (u - p, v - q);
        let [s, su, sv, suu, suv, svv] = self.d2(p, q);
        let at = s + du * su + dv * sv + 0.5 * du * du * suu + du * dv * suv + 0.5 * dv * dv * svv;
        [at, su + du * suu + dv * suv, sv + du * suv + dv * svv, suu, suv, svv]
    }

    /// Cuts `rect` into parts in each of which the surface is smooth and [`Chart::hull`] holds.
    pub(crate) fn pieces(&self, rect: Rect) -> Vec<Rect> {
        let [u, v] = self.cuts(rect);
        u.iter().flat_map(|&u| v.iter().map(move |&v| Rect { u, v })).collect()
    }

    /// The ranges of both parameters between the lines along which the surface may not be smooth.
    pub(crate) fn cuts(&self, rect: Rect) -> [Vec<[f64; 2]>; 2] {
        let ([u0, u1], [v0, v1]) = (rect.u, rect.v);
        match self {
            Self::Plane { .. } => [vec![rect.u], vec![rect.v]],
            Self::Spun { axis, meridian, flat } => {
                let mut v = meridian.pieces(v0, v1);
                if *flat {
                    v = v.into_iter().flat_map(|piece| cut_at_axis(axis, meridian, piece)).collect();
                }
                [ranges(u0, u1, &[], FRAC_PI_4), v]
            }
            Self::Swept { profile, .. } => [profile.pieces(u0, u1), vec![rect.v]],
            Self::Net(net) => {
                let cut = |k: &Knots, period, a, b| ranges(a, b, &knots_within(&k.0, period, a, b), f64::INFINITY);
                [cut(&net.u, net.period[0], u0, u1), cut(&net.v, net.period[1], v0, v1)]
            }
            Self::Offset { basis, .. } => basis.cuts(rect),
            Self::Opaque { .. } => [ranges(u0, u1, &[], (u1 - u0) / 8.0), ranges(v0, v1, &[], (v1 - v0) / 8.0)],
        }
    }

    /// Hull of the part over `rect`, which must lie in one of [`Chart::pieces`].
    pub(crate) fn hull(&self, rect: Rect) -> Hull {
        match self {
            Self::Plane { .. } => {
                Hull::of([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(a, b)| self.at(rect.at(a, b))).to_vec())
            }
            Self::Spun { axis, meridian, .. } => {
                let hull = meridian.hull(rect.v[0], rect.v[1]);
                let points = hull.points.iter().flat_map(|&p| arc_hull(axis, p, rect.u)).collect();
                Hull { points, ..hull }
            }
            Self::Swept { profile, d } => {
                let hull = profile.hull(rect.u[0], rect.u[1]);
                let points = hull.points.iter().flat_map(|&p| rect.v.map(|v| p + v * *d)).collect();
                Hull { points, ..hull }
            }
            Self::Net(net) => net.hull(rect).unwrap_or_else(|| sampled_hull(self, rect)),
            Self::Offset { basis, distance, .. } => offset_hull(basis, *distance, rect),
            Self::Opaque { .. } => sampled_hull(self, rect),
        }
    }

    fn at(&self, [u, v]: [f64; 2]) -> DVec3 {
        self.d2(u, v)[0]
    }

    /// Periods in the two directions, 0 for none.
    pub(crate) fn periods(&self) -> [f64; 2] {
        match self {
            Self::Spun { meridian, .. } => [TAU, meridian.period()],
            Self::Swept { profile, .. } => [profile.period(), 0.0],
            Self::Net(net) => net.period,
            Self::Offset { basis, .. } => basis.periods(),
            Self::Plane { .. } | Self::Opaque { .. } => [0.0; 2],
        }
    }

    /// Direction, 0 or 1, in which the part over `rect` is longer or bends more.
    pub(crate) fn direction(&self, rect: &Rect) -> usize {
        let [a, b] = rect.size();
        let at = |s, t| self.d2_within(rect, rect.at(s, t));
        let center = at(0.5, 0.5);
        let reach = |d1: DVec3, d2: DVec3, h: f64| d1.length() * h + 4.0 * d2.length() * h * h;
        let [ends_u, ends_v] = [[at(0.0, 0.5), at(1.0, 0.5)], [at(0.5, 0.0), at(0.5, 1.0)]];
        let chord = |e: [Jet; 2]| e[0][0].distance(e[1][0]);
        let u = reach(center[1], center[3], a).max(chord(ends_u));
        let v = reach(center[2], center[5], b).max(chord(ends_v));
        usize::from(v > u)
    }
}

/// Turns a meridian's jet by `u` about the axis.
fn spin(axis: &Axis, [c, c1, c2]: [DVec3; 3], u: f64) -> Jet {
    let (sin, cos) = u.sin_cos();
    let turn = |along: f64, r: DVec3, q: DVec3| along * axis.z + cos * r + sin * q;
    let slide = |r: DVec3, q: DVec3| cos * q - sin * r;
    let (h, r, q) = axis.split(c);
    let (h1, r1, q1) = axis.split(axis.o + c1);
    let (h2, r2, q2) = axis.split(axis.o + c2);
    [axis.o + turn(h, r, q), slide(r, q), turn(h1, r1, q1), -(cos * r + sin * q), slide(r1, q1), turn(h2, r2, q2)]
}

/// Triangle around the arc that `p` runs through while `u` goes over a range of at most a quarter turn.
fn arc_hull(axis: &Axis, p: DVec3, u: [f64; 2]) -> [DVec3; 3] {
    let (h, r, q) = axis.split(p);
    let at = |u: f64, scale: f64| axis.o + h * axis.z + scale * (u.cos() * r + u.sin() * q);
    [at(u[0], 1.0), at(0.5 * (u[0] + u[1]), (0.5 * (u[1] - u[0])).cos().recip()), at(u[1], 1.0)]
}

/// Cuts a piece of a straight meridian where it crosses the axis (the apex of a cone), so that no part changes sides.
fn cut_at_axis(axis: &Axis, meridian: &Curve, [a, b]: [f64; 2]) -> Vec<[f64; 2]> {
    if let Curve::Line { o, d } = meridian {
        let (_, r0, _) = axis.split(*o);
        let (_, r1, _) = axis.split(axis.o + *d);
        let apex = -r0.dot(r1) / r1.length_squared();
        if apex > a && apex < b {
            return vec![[a, apex], [apex, b]];
        }
    }
    vec![[a, b]]
}

/// The hull of the basis `S` under the affine map that comes nearest to `S + distance n`, padded by how far the map is off: sampled at
/// 4 × 4 points and widened by [`BOUND_SAFETY`], as the derivatives of certificates are. The pad falls with the square of the size.
fn offset_hull(basis: &Chart, distance: f64, rect: Rect) -> Hull {
    let mut hull = basis.hull(rect);
    let at = |a: f64, b: f64| {
        let jet = basis.d2_within(&rect, rect.at(a, b));
        Some((jet[0], distance * jet[1].cross(jet[2]).try_normalize()?))
    };
    let map = || {
        let (origin, lift) = at(0.5, 0.5)?;
        let [(p, lp), (q, lq)] = [at(0.0, 0.5)?, at(1.0, 0.5)?];
        let [(r, lr), (s, ls)] = [at(0.5, 0.0)?, at(0.5, 1.0)?];
        let (u, v) = (q - p, s - r);
        let [e, f, g] = [u.length_squared(), u.dot(v), v.length_squared()];
        let d = Some(e * g - f * f).filter(|d| *d > 1e-12 * e * g)?.recip();
        Some(move |x: DVec3| {
            let (a, b) = ((x - origin).dot(u), (x - origin).dot(v));
            lift + d * (g * a - f * b) * (lq - lp) + d * (e * b - f * a) * (ls - lr)
        })
    };
    let padded = map().and_then(|map| {
        let samples = (0..16).map(|k| at(f64::from(k / 4) / 3.0, f64::from(k % 4) / 3.0));
        let mut off = samples.map(|sample| sample.map(|(x, lift)| lift.distance(map(x))));
        let off = off.try_fold(0.0, |most: f64, off| Some(most.max(off?)))?;
        Some((map, BOUND_SAFETY * off)).filter(|(_, pad)| *pad < distance.abs())
    });
    match padded {
        Some((map, pad)) => {
            hull.points.iter_mut().for_each(|x| *x += map(*x));
            hull.pad += pad;
        }
        None => hull.pad += distance.abs(),
    }
    hull
}

fn sampled_hull(chart: &Chart, rect: Rect) -> Hull {
    let points: Vec<DVec3> =
        (0..25).map(|k| chart.at(rect.at(f64::from(k / 5) / 4.0, f64::from(k % 5) / 4.0))).collect();
    let bend = |a: usize, b: usize, c: usize| (points[a] - 2.0 * points[b] + points[c]).length();
    let bends = (0..5).flat_map(|i| {
        (0..3)
            .flat_map(move |j| [[5 * i + j, 5 * i + j + 1, 5 * i + j + 2], [5 * j + i, 5 * j + 5 + i, 5 * j + 10 + i]])
    });
    let pad = 2.0 * bends.map(|[a, b, c]| bend(a, b, c)).fold(0.0, f64::max);
    Hull { points, pad, sound: false }
}

/// OCCT's own evaluation; NaN where it throws.
pub(crate) fn surface_d2(handle: &SurfaceHandle, u: f64, v: f64) -> Jet {
    let mut jet = [0.0; 18];
    match handle.d2(u, v, &mut jet) {
        Ok(()) => [0, 3, 6, 9, 12, 15].map(|i| DVec3::from_slice(&jet[i..])),
        Err(_) => [DVec3::NAN; 6],
    }
}
