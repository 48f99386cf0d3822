//! From where a mesh is looked at, without perspective.

use glam::DVec3;

/// A direction to look from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// From the front, the right and above.
    Iso,
    /// From along an axis (0 to 2), or from its other end.
    Axis(usize, bool),
}

/// The words for views.
pub const VIEWS: [&str; 7] = ["iso", "x", "y", "z", "-x", "-y", "-z"];

impl View {
    /// The view of one of [`VIEWS`].
    #[must_use]
    pub fn of(word: &str) -> Option<View> {
        let place = VIEWS.iter().position(|&own| own == word)?;
        Some(if place == 0 { View::Iso } else { View::Axis((place - 1) % 3, place > 3) })
    }

    /// Unit vectors to the right, upwards, and towards the eye.
    #[must_use]
    pub(super) fn frame(self) -> [DVec3; 3] {
        let (eye, up) = match self {
            View::Iso => (DVec3::new(-0.62, -0.9, 0.62), DVec3::Z),
            View::Axis(axis, back) => {
                let eye = [DVec3::X, DVec3::Y, DVec3::Z][axis] * if back { -1.0 } else { 1.0 };
                (eye, if axis == 2 { DVec3::Y } else { DVec3::Z })
            }
        };
        let eye = eye.normalize();
        let right = up.cross(eye).normalize();
        [right, eye.cross(right), eye]
    }
}

/// A window on the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Camera {
    /// To the right, upwards, towards the eye.
    pub frame: [DVec3; 3],
    /// What is in the middle of the window.
    pub target: DVec3,
    /// The middle of the window, in the canvas' units.
    pub middle: [f64; 2],
    /// Units of the canvas for one of the mesh.
    pub scale: f64,
}

impl Camera {
    /// A window with its left upper corner and size given, on all of some points.
    #[must_use]
    pub(super) fn on(
        frame: [DVec3; 3],
        points: impl Iterator<Item = DVec3>,
        corner: [f64; 2],
        size: [f64; 2],
    ) -> Camera {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for x in points {
            for (k, direction) in frame.iter().enumerate() {
                low[k] = low[k].min(direction.dot(x));
                high[k] = high[k].max(direction.dot(x));
            }
        }
        let empty = low[0] > high[0];
        let middle = |k: usize| if empty { 0.0 } else { 0.5 * (low[k] + high[k]) };
        let target = frame[0] * middle(0) + frame[1] * middle(1) + frame[2] * middle(2);
        let fits = |k: usize| size[k] / (high[k] - low[k]).max(f64::MIN_POSITIVE);
        let scale = if empty { 1.0 } else { 0.94 * fits(0).min(fits(1)) };
        let scale = if scale.is_finite() { scale } else { 1.0 };
        Camera { frame, target, middle: [corner[0] + 0.5 * size[0], corner[1] + 0.5 * size[1]], scale }
    }

    /// Where a point is on the canvas, and how far away.
    #[must_use]
    pub(super) fn see(&self, x: DVec3) -> [f32; 3] {
        let [right, up, eye] = self.frame.map(|direction| direction.dot(x - self.target) * self.scale);
        [(self.middle[0] + right) as f32, (self.middle[1] - up) as f32, -eye as f32]
    }
}
