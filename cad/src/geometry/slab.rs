//! Oriented boxes: a leaf in the frame of its tangents, which is far thinner than its axis-aligned box.

use crate::geometry::curve::Hull;
use glam::DVec3;

/// Fraction of `b` that must be across `a` for [`frame`] to use it.
const ACROSS: f64 = 1e-6;

/// Three orthonormal axes: along `a`, along the part of `b` across it, and along their product.
///
/// Where `b` runs along `a` (the second derivative of a straight curve, or dependent tangents), what is left of it is rounding and points
/// anywhere, also along `a`; a box with such axes would not hold its hull. A second step takes the rounding of the first away.
fn frame(a: DVec3, b: DVec3) -> [DVec3; 3] {
    let x = a.normalize_or(DVec3::X);
    let across = b - b.dot(x) * x;
    let y = if across.length() > ACROSS * b.length() {
        let y = across.normalize();
        (y - y.dot(x) * x).normalize()
    } else {
        x.any_orthonormal_vector()
    };
    [x, y, x.cross(y)]
}

/// A box with its own axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    center: DVec3,
    axes: [DVec3; 3],
    half: DVec3,
}

impl Slab {
    /// Around a hull, with axes along `a` and, as far as it goes, `b`.
    pub(crate) fn new(hull: &Hull, a: DVec3, b: DVec3) -> Self {
        let axes = frame(a, b);
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for p in &hull.points {
            let q = DVec3::from_array(axes.map(|axis| axis.dot(*p)));
            (low, high) = (low.min(q), high.max(q));
        }
        let middle = 0.5 * (low + high);
        let center = middle.x * axes[0] + middle.y * axes[1] + middle.z * axes[2];
        // products with the axes are rounded relative to the coordinates
        let rounding = 1e-15 * (low.abs().max_element() + high.abs().max_element());
        Self { center, axes, half: 0.5 * (high - low) + DVec3::splat(hull.pad + rounding) }
    }

    /// Square of a lower bound of the distance from `x` to what is inside.
    pub(crate) fn distance_squared(&self, x: DVec3) -> f64 {
        let r = x - self.center;
        let q = DVec3::from_array(self.axes.map(|axis| axis.dot(r).abs()));
        (q - self.half).max(DVec3::ZERO).length_squared()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors that are parallel but for their rounding, that vanish, that are no multiples.
    #[test]
    fn axes_are_orthonormal_whatever_the_tangents() {
        let mut state = 1_u64;
        let mut unit = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for k in 0..10_000 {
            let a = DVec3::new(unit(), 1e-3 * unit(), 1e-3 * unit()) * 1e4;
            let off = DVec3::new(unit(), unit(), unit()) * 10_f64.powi(-(k % 20));
            let b = if k % 97 == 0 { DVec3::ZERO } else { a * unit() + off };
            let [x, y, z] = frame(a, b);
            for (p, q) in [(x, y), (y, z), (z, x)] {
                assert!(p.dot(q).abs() < 1e-15 && (p.length() - 1.0).abs() < 1e-15, "{a} {b}: {x} {y} {z}");
            }
        }
    }

    /// A straight piece whose second derivative is parallel to it: its own points are inside.
    #[test]
    fn a_straight_piece_lies_in_its_box() {
        let (from, to) =
            (DVec3::new(17_245.990_815_7, 1_673.605_3, -1_304.072_04), DVec3::new(20_154.9, 1_672.27, -1_303.08));
        let along = to - from;
        let points: Vec<DVec3> = (0..4).map(|k| from + along * (f64::from(k) / 3.0)).collect();
        for factor in [0.1, 0.3, 0.7, 1.1, 1.3] {
            let slab = Slab::new(&Hull::of(points.clone()), along, along * factor);
            assert!(points.iter().all(|&p| slab.distance_squared(p) < 1e-20), "{factor}");
        }
    }
}
