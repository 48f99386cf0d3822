//! The wall's surface: B-spline faces over a square of unit cells.
//!
//! ```text
//!  bump  ____.-.____   dent  ‾‾‾‾`-´‾‾‾‾   ridge: a bump along a line   crease  ___/\___ or ‾‾‾\/‾‾‾, two faces
//! ```

use glam::{DVec2, DVec3};

use crate::common::iges::Patch;
use crate::common::random::Random;
use crate::viscous_patches::case::Shape;

/// Poles of a face along each side.
const POLES: usize = 18;

/// What the surface is but for its amplitude.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// Cells along a side: the length of a side.
    pub cells: usize,
    shape: Shape,
    /// Middle of the bump, dent or ridge.
    middle: DVec2,
    /// Half widths across and along.
    widths: DVec2,
    /// Direction across.
    across: DVec2,
    /// How the ridge or the crease bends aside.
    bend: f64,
    /// Slope at a crease on either side: positive where it is convex.
    slope: f64,
}

impl Form {
    pub fn draw(shape: Shape, cells: usize, random: &mut Random) -> Form {
        let side = cells as f64;
        let mut place = || random.between(0.3, 0.7) * side;
        let middle = DVec2::new(place(), place());
        let mut width = || random.between(1.0, 2.0);
        let widths = DVec2::new(width(), width());
        let across = DVec2::from_angle(random.between(0.0, std::f64::consts::TAU));
        let bend = random.between(-0.5, 0.5);
        let turn = random.between(10.0_f64, 60.0).to_radians();
        let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
        Form { cells, shape, middle, widths, across, bend, slope: sign * (0.5 * turn).tan() }
    }

    /// The mesh line that the crease lies on.
    pub fn split(&self) -> Option<usize> {
        (self.shape == Shape::Crease).then_some(self.cells / 2)
    }

    /// Height of the smooth part over a point of the square, for an amplitude of 1.
    fn smooth(&self, x: DVec2) -> f64 {
        let local = x - self.middle;
        let (s, t) = (local.dot(self.across) / self.widths.x, local.dot(self.across.perp()) / self.widths.y);
        match self.shape {
            Shape::Bump => (-s * s - t * t).exp(),
            Shape::Dent => -(-s * s - t * t).exp(),
            Shape::Ridge => (-(s + self.bend * (0.5 * t).sin()).powi(2)).exp(),
            // a wave along the crease, so that its own edges are curved
            Shape::Crease => (-(local.y / self.widths.y).powi(2)).exp(),
        }
    }

    /// The surface with an amplitude.
    pub fn surface(&self, amplitude: f64) -> Surface {
        let side = self.cells as f64;
        let graph =
            |x: f64, y: f64, tent: f64| DVec3::new(x, y, amplitude * self.smooth(DVec2::new(x, y)) - self.slope * tent);
        let face = |map: &dyn Fn(f64, f64) -> DVec3| Patch::at_greville([POLES; 2], map);
        let Some(split) = self.split() else {
            return Surface { split: None, side, faces: vec![face(&|u, v| graph(u * side, v * side, 0.0))] };
        };
        let line = |y: f64| split as f64 + amplitude * self.bend * (2.0 * y / side - 1.0).powi(2);
        let left = face(&|u, v| graph(u * line(v * side), v * side, (1.0 - u) * line(v * side)));
        let right = face(&|u, v| {
            let from = line(v * side);
            graph(from + u * (side - from), v * side, u * (side - from))
        });
        Surface { split: Some(split as f64), side, faces: vec![left, right] }
    }
}

/// Faces in the order of their numbers in the CAD file.
pub struct Surface {
    pub faces: Vec<Patch>,
    split: Option<f64>,
    side: f64,
}

impl Surface {
    /// The surface at a place of the mesh: cells along both sides.
    pub fn at(&self, place: DVec2) -> DVec3 {
        let v = (place.y / self.side).clamp(0.0, 1.0);
        match self.split {
            None => self.faces[0].point((place.x / self.side).clamp(0.0, 1.0), v),
            Some(split) if place.x <= split => self.faces[0].point((place.x / split).clamp(0.0, 1.0), v),
            Some(split) => self.faces[1].point(((place.x - split) / (self.side - split)).clamp(0.0, 1.0), v),
        }
    }
}
