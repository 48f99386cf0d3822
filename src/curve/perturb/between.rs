//! The displacement between the curved walls and the walls that are held.

use glam::DVec3;

use super::field::{Field, WallFace};
use super::roots::{Graph, Roots};
use crate::mesh::elevate::Elevated;

/// The walls that are held: the faces that stay straight, but for their rims.
pub(super) struct Held {
    faces: Vec<WallFace>,
    seeds: Vec<bool>,
    roots: Roots,
}

impl Held {
    /// Held walls; `on` marks the linear nodes of faces.
    pub(super) fn new(faces: Vec<WallFace>, on: impl Fn(&[WallFace]) -> Vec<bool>, graph: &Graph) -> Held {
        let seeds = on(&faces);
        let roots = graph.roots(&seeds);
        Held { faces, seeds, roots }
    }

    /// Their field, the boundary nodes displaced as given.
    pub(super) fn field<'a>(
        &'a self,
        elevated: &'a Elevated,
        displacement: &'a [DVec3],
        beyond: impl Fn(usize) -> bool,
    ) -> Field<'a> {
        Field::new(elevated, &self.faces, displacement, &self.seeds, self.roots.clone(), &[], beyond)
    }
}

/// The displacement of the curved walls, blended with that of the walls that are held where there are any.
pub(super) struct Between<'a> {
    pub(super) curved: Field<'a>,
    pub(super) held: Option<Field<'a>>,
}

impl Between<'_> {
    /// The displacement at the combination `weights` of linear nodes.
    pub(super) fn at(&self, corners: &[usize], weights: &[f64]) -> DVec3 {
        let by_curved = || self.curved.at(corners, weights);
        let Some(held) = &self.held else { return by_curved() };
        let (to_curved, to_held) = (self.curved.distance(corners, weights), held.distance(corners, weights));
        if !to_held.is_finite() {
            return by_curved();
        }
        let fraction = to_held / (to_curved + to_held);
        match fraction {
            fraction if fraction.is_finite() => by_curved() * fraction + held.at(corners, weights) * (1.0 - fraction),
            _ => by_curved(), // at the rim, where the two are the same
        }
    }
}
