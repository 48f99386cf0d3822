//! Flaws of the CAD faces that a mesh lies on: what a user should know before trusting what is made on them.

use std::collections::BTreeSet;

use cad::{EntityId, FaceId, Model};

use super::Surface;

/// Notes on creases in the faces that hold mesh faces, and on faces that the file holds twice.
pub(super) fn flaws(model: &Model, surfaces: &[Surface]) -> Vec<String> {
    let faces: BTreeSet<FaceId> =
        surfaces.iter().flat_map(|surface| surface.group.entities()).filter_map(face).collect();
    let creases = faces.iter().flat_map(|&face| model.creases(face));
    let creases = creases
        .map(|crease| format!("{crease}: one polynomial does not follow it across; mesh edges should run along it"));
    let duplicates = model.duplicate_faces().into_iter().filter(|pair| pair.iter().any(|face| faces.contains(face)));
    let duplicates = duplicates
        .map(|[one, other]| format!("{one} and {other} are the same face twice; the mesh is tied to one of them"));
    creases.chain(duplicates).collect()
}

fn face(entity: &EntityId) -> Option<FaceId> {
    match entity {
        EntityId::Face(face) => Some(*face),
        _ => None,
    }
}
