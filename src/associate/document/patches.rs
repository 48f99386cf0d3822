//! The boundary faces of each patch, in runs on the same CAD entities.

use std::collections::BTreeMap;

use cad::EntityId;

use crate::associate::Candidates;
use crate::mesh::{Boundary, EntityKey};

/// Faces of one patch: its targets, each with its faces.
pub(super) type Runs<'a> = Vec<(&'a [EntityId], Vec<usize>)>;

/// The patches of the candidates, each with its runs.
pub(super) fn patches<'a>(candidates: &'a Candidates, boundary: &Boundary) -> BTreeMap<EntityKey, Runs<'a>> {
    let mut patches: BTreeMap<EntityKey, Runs<'a>> = BTreeMap::new();
    for sheet in candidates.sheets.iter().filter(|sheet| !sheet.entities.is_empty()) {
        for &face in &sheet.items {
            push(patches.entry(boundary.faces[face].entity).or_default(), &sheet.entities, face);
        }
    }
    patches
}

pub(super) fn push<'a>(runs: &mut Runs<'a>, entities: &'a [EntityId], face: usize) {
    match runs.iter_mut().find(|(own, _)| *own == entities) {
        Some((_, faces)) => faces.push(face),
        None => runs.push((entities, vec![face])),
    }
}

/// All entities of a patch, ascending, each once.
pub(super) fn union(runs: &Runs<'_>) -> Vec<EntityId> {
    let mut all: Vec<EntityId> = runs.iter().flat_map(|(entities, _)| entities.iter().copied()).collect();
    all.sort_unstable();
    all.dedup();
    all
}
