//! Oriented boxes: a leaf in the frame of its tangents, which is far thinner than its axis-aligned box.

use crate::geometry::curve::Hull;
use glam::DVec3;

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
        let x = a.normalize_or(DVec3::X);
        let y = (b - b.dot(x) * x).normalize_or(x.any_orthonormal_vector());
        let axes = [x, y, x.cross(y)];
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
