//! Whether leaves lie in their own boxes: what the search rests on, held against OCCT's evaluation.

use crate::boxes::Aabb;
use crate::geometry::chart::surface_d2;
use crate::geometry::curve::curve_d2;
use crate::geometry::slab::Slab;
use crate::ids::{EdgeId, EntityId, FaceId};
use crate::model::Model;
use glam::DVec3;

/// A point of a leaf that stands out of the boxes of the leaf.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stray {
    /// The face or edge.
    pub entity: EntityId,
    /// OCCT's parameters of the point: `u, v` of a face, `t, 0` of an edge.
    pub parameters: [f64; 2],
    /// How far it stands out, in the unit of the model.
    pub distance: f64,
}

impl Model {
    /// Samples each leaf of each face and edge at `per_side` points a direction, its border included, evaluates them by OCCT and holds
    /// them against the two boxes of the leaf. Gives the number of leaves and, of each that does not hold its own points, the one that
    /// stands out most. For tests: the search is right only where there is none beyond rounding.
    #[doc(hidden)]
    pub fn strays(&self, per_side: u32, slack: f64) -> (usize, Vec<Stray>) {
        let fraction = move |k: u32| f64::from(k) / f64::from(per_side.max(2) - 1);
        let mut leaves = 0;
        let mut strays = Vec::new();
        for (i, face) in self.geometry.faces.iter().enumerate() {
            leaves += face.leaves.len();
            for leaf in &face.leaves {
                let at = |k: u32| leaf.rect.at(fraction(k / per_side), fraction(k % per_side));
                let points = (0..per_side * per_side).map(at).map(|[u, v]| ([u, v], surface_d2(&face.handle, u, v)[0]));
                strays.extend(worst(FaceId::new(i).into(), points, &leaf.bounds, &leaf.slab, slack));
            }
        }
        for (i, edge) in self.geometry.edges.iter().enumerate() {
            let Some(edge) = edge else { continue };
            leaves += edge.leaves.len();
            for leaf in &edge.leaves {
                let at = |k: u32| leaf.range[0] + fraction(k) * (leaf.range[1] - leaf.range[0]);
                let points = (0..per_side).map(at).map(|t| ([t, 0.0], curve_d2(&edge.handle, t)[0]));
                strays.extend(worst(EdgeId::new(i).into(), points, &leaf.bounds, &leaf.slab, slack));
            }
        }
        (leaves, strays)
    }
}

fn worst(
    entity: EntityId,
    points: impl Iterator<Item = ([f64; 2], DVec3)>,
    bounds: &Aabb,
    slab: &Slab,
    slack: f64,
) -> Option<Stray> {
    let out = |x: DVec3| bounds.distance_squared(x).max(slab.distance_squared(x)).sqrt();
    let strays = points.map(|(parameters, x)| Stray { entity, parameters, distance: out(x) });
    strays.filter(|stray| stray.distance > slack).max_by(|a, b| a.distance.total_cmp(&b.distance))
}
