//! Nearest points of planes, cylinders, cones, spheres and tori over a leaf, without iteration.

use crate::geometry::chart::{Axis, Chart, Rect};
use crate::geometry::curve::Curve;
use crate::geometry::newton::Local;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The nearest point over `rect`, `None` where the chart has no closed form.
pub(crate) fn nearest(chart: &Chart, rect: &Rect, x: DVec3) -> Option<Local> {
    let parameters = match chart {
        Chart::Plane { o, x: a, y: b } => rect.clamp([(x - *o).dot(*a), (x - *o).dot(*b)]),
        Chart::Spun { axis, meridian, flat: true } => on_spun(axis, meridian, rect, x)?,
        _ => return None,
    };
    let point = chart.d2(parameters[0], parameters[1])[0];
    Some(Local { parameters, distance_squared: (point - x).length_squared() })
}

/// The nearest point over a range of a straight line or circle, `None` for other curves.
pub(crate) fn nearest_on_curve(curve: &Curve, [first, last]: [f64; 2], x: DVec3) -> Option<Local> {
    let t = match curve {
        Curve::Line { o, d } => ((x - *o).dot(*d) / d.length_squared()).clamp(first, last),
        Curve::Conic { o, x: a, y: b } if is_circle(*a, *b) => {
            clamp_angle((x - *o).dot(*b).atan2((x - *o).dot(*a)), [first, last])
        }
        _ => return None,
    };
    Some(Local { parameters: [t, 0.0], distance_squared: (curve.d2(t)[0] - x).length_squared() })
}

fn is_circle(a: DVec3, b: DVec3) -> bool {
    a.length_squared() == b.length_squared() || (a.length() / b.length() - 1.0).abs() < 1e-15
}

/// The angle in `lo..=hi` nearest to `angle` on the circle.
fn clamp_angle(angle: f64, [lo, hi]: [f64; 2]) -> f64 {
    let near = angle - TAU * ((angle - 0.5 * (lo + hi)) / TAU).round();
    near.clamp(lo, hi)
}

/// Whatever the radius (of one sign over the leaf), the nearest `u` is the one nearest in angle to `x`;
/// what remains is the distance to a line or an arc in the meridian plane.
fn on_spun(axis: &Axis, meridian: &Curve, rect: &Rect, x: DVec3) -> Option<[f64; 2]> {
    let [_, middle] = rect.center();
    let e = axis.x;
    let side = axis.turn * axis.z.cross(e);
    let (h, r, _) = axis.split(x);
    let mut angle = r.dot(side).atan2(r.dot(e));
    let plane = |p: DVec3| [(p - axis.o).dot(e), (p - axis.o).dot(axis.z)];
    if plane(meridian.d2(middle)[0])[0] < 0.0 {
        angle += PI;
    }
    let u = clamp_angle(angle, rect.u);
    let (sin, cos) = u.sin_cos();
    let across = r.dot(cos * e + sin * side);
    let v = match meridian {
        Curve::Line { o, d } => {
            let ([or, oh], [dr, dh]) = (plane(*o), plane(axis.o + *d));
            (((across - or) * dr + (h - oh) * dh) / (dr * dr + dh * dh)).clamp(rect.v[0], rect.v[1])
        }
        Curve::Conic { o, .. } => {
            let [or, oh] = plane(*o);
            clamp_angle((h - oh).atan2(across - or), rect.v)
        }
        _ => return None,
    };
    Some([u, v])
}
