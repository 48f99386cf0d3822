//! Boundary faces that belong to the CAD and stay straight all the same, as it could not be decided where.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashSet;

use super::{Association, Classification, Doubt, Inference};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

/// Faces that geometry left undecided though all their points are on the CAD, or though they go on in a face that is, across an edge
/// that is no CAD edge; of patches that were not to stay straight. By index in [`Boundary::faces`], rising.
///
/// Faces of a patch that is not part of the CAD, such as a far field, are none.
#[must_use]
pub fn open_faces(
    boundary: &Boundary,
    association: &Association,
    inference: &Inference,
    straight: &BTreeSet<EntityKey>,
) -> Vec<usize> {
    let strings = inference.candidates.strings.iter().flat_map(|string| &string.items);
    let on_cad_edges: FxHashSet<usize> = strings.filter_map(|&ends: &[NodeId; 2]| boundary.edge(ends)).collect();
    let decided = |face: usize| matches!(association.faces[face], Classification::Surface(_));
    let mut goes_on = FxHashSet::default();
    for (_, faces) in boundary.edge_faces.iter().enumerate().filter(|(edge, _)| !on_cad_edges.contains(edge)) {
        if faces.iter().any(|&face| decided(face)) {
            goes_on.extend(faces.iter().copied());
        }
    }
    let is_open = |(face, doubt): &&(usize, Doubt)| {
        association.faces[*face] == Classification::Straight
            && !straight.contains(&boundary.faces[*face].entity)
            && (!matches!(doubt, Doubt::OffCad | Doubt::PartlyOffCad) || goes_on.contains(face))
    };
    let mut open: Vec<usize> = inference.faces.iter().filter(is_open).map(|(face, _)| *face).collect();
    open.sort_unstable();
    open
}

/// What a user should know of open faces, patch by patch.
#[must_use]
pub fn open_notes(mesh: &Mesh, boundary: &Boundary, open: &[usize]) -> Vec<String> {
    let mut patches: BTreeMap<EntityKey, usize> = BTreeMap::new();
    open.iter().for_each(|&face| *patches.entry(boundary.faces[face].entity).or_default() += 1);
    let note = |(entity, count): (EntityKey, usize)| {
        format!(
            "{}: {count} faces belong to the CAD, but it is open on which of its faces they lie, and they stay straight; \
             --dry-run says why, and --straight {} accepts it",
            mesh.label(entity),
            entity.tag
        )
    };
    patches.into_iter().map(note).collect()
}
