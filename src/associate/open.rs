//! Boundary faces that stay straight though they seem to belong to a curved wall.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::{Association, Classification};
use crate::mesh::{Boundary, EntityKey, Mesh};

/// Turns between neighbouring faces, in radians, that make a wall of them that is curved: less is a plane with rounding, more an edge.
const CURVED: std::ops::Range<f64> = 1e-3..0.7;

/// Faces that lie on no CAD and in no plane, of patches that were not to stay straight, and turn smoothly from a neighbour: by index in
/// [`Boundary::faces`], rising.
#[must_use]
pub fn open_faces(
    mesh: &Mesh,
    boundary: &Boundary,
    association: &Association,
    straight: &BTreeSet<EntityKey>,
) -> Vec<usize> {
    let is_open = |face: usize| {
        association.faces[face] == Classification::Straight && !straight.contains(&boundary.faces[face].entity)
    };
    let mut found = BTreeSet::new();
    for faces in &boundary.edge_faces {
        let &[a, b] = &faces[..] else { continue };
        if !is_open(a) && !is_open(b) {
            continue;
        }
        let [first, second] = [a, b].map(|face| normal(mesh, boundary, face));
        let turn = first.angle_between(second);
        // Neighbours may be listed in opposite directions.
        if CURVED.contains(&turn.min(std::f64::consts::PI - turn)) {
            found.extend([a, b].into_iter().filter(|&face| is_open(face)));
        }
    }
    found.into_iter().collect()
}

/// What a user should know of open faces, patch by patch.
#[must_use]
pub fn open_notes(mesh: &Mesh, boundary: &Boundary, open: &[usize]) -> Vec<String> {
    let mut patches: BTreeMap<EntityKey, usize> = BTreeMap::new();
    open.iter().for_each(|&face| *patches.entry(boundary.faces[face].entity).or_default() += 1);
    let note = |(entity, count): (EntityKey, usize)| {
        format!(
            "{}: {count} faces seem to belong to a curved wall, but no CAD face was found for them, and they stay straight; \
             --dry-run says why, and --straight {} accepts it",
            mesh.label(entity),
            entity.tag
        )
    };
    patches.into_iter().map(note).collect()
}

/// The normal of a linear face, of any length.
fn normal(mesh: &Mesh, boundary: &Boundary, face: usize) -> DVec3 {
    let corners: Vec<DVec3> = mesh.points_of(&boundary.corners[face]).collect();
    let from = corners[0];
    corners[1..].windows(2).map(|pair| (pair[0] - from).cross(pair[1] - from)).sum()
}
