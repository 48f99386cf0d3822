//! Faces that a file holds twice: copies beside a solid, and the common faces of solids that touch.

use crate::closest::group::Group;
use crate::ids::FaceId;
use crate::model::Model;
use crate::tolerance::SEWING;
use glam::DVec3;

/// Points of a face that are held against another, at most.
const SAMPLES: usize = 64;

impl Model {
    /// Pairs of faces that cover each other within their tolerances; rising. A mesh face on such a pair is tied to the first.
    #[must_use]
    pub fn duplicate_faces(&self) -> Vec<[FaceId; 2]> {
        let faces = self.faces();
        let mut pairs = Vec::new();
        for (k, one) in faces.iter().enumerate() {
            for other in &faces[k + 1..] {
                let slack = one.tolerance.max(other.tolerance).max(SEWING * self.diagonal());
                // Boxes are from samples, and may be wide of each other by more than the faces are.
                let wide = slack.max(0.01 * one.bounds.diagonal());
                let near = |a: DVec3, b: DVec3| (a - b).abs().max_element() <= wide;
                if near(one.bounds.min, other.bounds.min)
                    && near(one.bounds.max, other.bounds.max)
                    && self.covers(one.id, other.id, slack)
                    && self.covers(other.id, one.id, slack)
                {
                    pairs.push([one.id, other.id]);
                }
            }
        }
        pairs
    }

    /// Whether points inside `one` lie on `other`.
    fn covers(&self, other: FaceId, one: FaceId, slack: f64) -> bool {
        let Ok(group) = Group::of_faces(self, &[other]) else { return false };
        let face = &self.geometry().faces[one.index()];
        let inside = face.leaves.iter().map(|leaf| leaf.rect.center()).filter(|&at| face.trim.contains(at));
        let places: Vec<[f64; 2]> = inside.collect();
        let step = places.len().div_ceil(SAMPLES).max(1);
        let mut points = places.iter().step_by(step).map(|&[u, v]| face.chart.d2(u, v)[0]).peekable();
        points.peek().is_some() && points.all(|x| group.distance(x) <= slack)
    }
}
