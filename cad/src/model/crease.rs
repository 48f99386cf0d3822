//! Creases: lines inside a face at which its surface turns, as where knots of a B-spline have the multiplicity of its degree (C0).
//!
//! A mesh edge that crosses one cannot follow it with one polynomial.

use std::fmt;

use glam::DVec3;

use crate::geometry::chart::{Chart, Rect};
use crate::ids::FaceId;
use crate::model::Model;
use crate::tolerance::{CREASE, CREASE_INSET};

/// Points across each piece of a line at which the surface is looked at.
const SAMPLES: u32 = 4;

/// A line of constant parameter at which a face's surface turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crease {
    /// The face.
    pub face: FaceId,
    /// 0 where `u` is constant along it, 1 where `v` is.
    pub direction: usize,
    /// That parameter.
    pub parameter: f64,
    /// Largest angle seen between the normals of its two sides, in radians.
    pub angle: f64,
    /// Where it was seen, in the unit of the model.
    pub place: DVec3,
}

impl fmt::Display for Crease {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, degrees) = (["u", "v"][self.direction.min(1)], self.angle.to_degrees());
        let [x, y, z] = self.place.to_array();
        write!(
            f,
            "{} turns by {degrees:.1} degrees along {name} = {} inside, near ({x:.4}, {y:.4}, {z:.4})",
            self.face, self.parameter
        )
    }
}

impl Model {
    /// The creases of a face, inside its trim; rising by direction and parameter.
    #[must_use]
    pub fn creases(&self, id: FaceId) -> Vec<Crease> {
        let Some(face) = self.geometry().faces.get(id.index()) else { return Vec::new() };
        let ranges = face.chart.cuts(face.rect);
        let mut creases = Vec::new();
        for direction in [0, 1] {
            for pair in ranges[direction].windows(2) {
                let seen = ranges[1 - direction].iter().flat_map(|&along| (0..SAMPLES).map(move |k| (along, k)));
                let turns = seen.filter_map(|([a, b], k)| {
                    let along = a + (b - a) * (f64::from(k) + 0.5) / f64::from(SAMPLES);
                    let place = parameters(direction, pair[1][0], along);
                    let angle = turn(&face.chart, direction, [pair[0], pair[1]], along)?;
                    face.trim.contains(place).then(|| (angle, face.chart.d2(place[0], place[1])[0]))
                });
                let worst = turns.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(angle, _)| *angle > CREASE);
                creases.extend(worst.map(|(angle, place)| Crease {
                    face: id,
                    direction,
                    parameter: pair[1][0],
                    angle,
                    place,
                }));
            }
        }
        creases
    }
}

/// `u` and `v` of a point of a line on which the parameter of `direction` is `across`.
fn parameters(direction: usize, across: f64, along: f64) -> [f64; 2] {
    if direction == 0 { [across, along] } else { [along, across] }
}

/// The angle between the normals beside the border of two ranges; `None` where one side has none.
fn turn(chart: &Chart, direction: usize, [before, after]: [[f64; 2]; 2], along: f64) -> Option<f64> {
    let normal = |across: f64| {
        let [u, v] = parameters(direction, across, along);
        let rect = Rect { u: [u, u], v: [v, v] };
        let jet = chart.d2_within(&rect, [u, v]);
        jet[1].cross(jet[2]).try_normalize()
    };
    let inset = |[a, b]: [f64; 2]| CREASE_INSET * (b - a);
    let [one, other] = [normal(before[1] - inset(before))?, normal(after[0] + inset(after))?];
    Some(one.angle_between(other))
}
