//! Boundary faces that belong to the CAD and stay straight all the same, as it could not be decided where.

use std::collections::{BTreeMap, BTreeSet};

use cad::Aabb;
use glam::DVec3;
use rustc_hash::FxHashSet;

use super::side::SMOOTH;
use super::{Association, Classification, Doubt, Inference, ON_CAD, sides};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

/// A boundary face that belongs to the CAD and stays straight.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenFace {
    /// By index in [`Boundary::faces`].
    pub face: usize,
    /// Why it is associated with nothing.
    pub doubt: Doubt,
}

/// Faces that geometry left undecided though all their points are on the CAD, or though they go on smoothly in a face that is, across an
/// edge that is no CAD edge; of patches that were not to stay straight. By rising index.
///
/// Faces of a patch that is not part of the CAD, such as a far field, are none.
#[must_use]
pub fn open_faces(
    mesh: &Mesh,
    boundary: &Boundary,
    association: &Association,
    inference: &Inference,
    straight: &BTreeSet<EntityKey>,
) -> Vec<OpenFace> {
    let sides = sides(mesh, boundary);
    let slack = ON_CAD * Aabb::of_points(mesh.points().iter().copied()).diagonal();
    let strings = inference.candidates.strings.iter().flat_map(|string| &string.items);
    let on_cad_edges: FxHashSet<usize> = strings.filter_map(|&ends: &[NodeId; 2]| boundary.edge(ends)).collect();
    let mut goes_on = FxHashSet::default();
    for (_, faces) in boundary.edge_faces.iter().enumerate().filter(|(edge, _)| !on_cad_edges.contains(edge)) {
        let decided = faces.iter().find(|&&face| matches!(association.faces[face], Classification::Surface(_)));
        let Some(&decided) = decided else { continue };
        // Beyond the end of a plane there is nothing to curve, and round a corner of the mesh another boundary begins.
        let smoothly = |face: usize| sides[face].normal.dot(sides[decided].normal) >= SMOOTH;
        let plane = association.plane_of(association.faces[decided]);
        let in_plane = |face: usize| {
            let lies = |x: DVec3| plane.is_some_and(|plane| plane.closest(x).distance(x) <= slack);
            mesh.points_of(&boundary.corners[face]).all(lies)
        };
        goes_on.extend(faces.iter().copied().filter(|&face| smoothly(face) && !in_plane(face)));
    }
    let is_open = |(face, doubt): &&(usize, Doubt)| {
        association.faces[*face] == Classification::Straight
            && !straight.contains(&boundary.faces[*face].entity)
            && (!matches!(doubt, Doubt::OffCad | Doubt::PartlyOffCad) || goes_on.contains(face))
    };
    let open = inference.faces.iter().filter(is_open);
    let mut open: Vec<OpenFace> = open.map(|(face, doubt)| OpenFace { face: *face, doubt: doubt.clone() }).collect();
    open.sort_unstable_by_key(|own| own.face);
    open
}

/// What a user should know of open faces, patch by patch.
#[must_use]
pub fn open_notes(mesh: &Mesh, boundary: &Boundary, open: &[OpenFace]) -> Vec<String> {
    let mut patches: BTreeMap<EntityKey, usize> = BTreeMap::new();
    open.iter().for_each(|own| *patches.entry(boundary.faces[own.face].entity).or_default() += 1);
    let note = |(entity, count): (EntityKey, usize)| {
        let name = mesh.label(entity);
        format!(
            "{name}: {count} faces belong to the CAD, but it is open on which of its faces they lie, and they stay straight; \
             --straight \"{name}\" accepts it"
        )
    };
    patches.into_iter().map(note).collect()
}
