//! How much of each boundary patch is linked.

use std::collections::BTreeMap;

use linkage_schema::{Code, Findings, ModelLinks, Origin};
use rustc_hash::FxHashMap;
use schemars::JsonSchema;
use serde::Serialize;

use super::linked_mesh::LinkedMesh;
use crate::mesh::EntityKey;

/// Linked faces of a boundary patch.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Coverage {
    /// The mesh entity.
    pub entity: String,
    /// Its physical names.
    pub names: Vec<String>,
    /// Its faces.
    pub faces: usize,
    /// Those that the file links to geometry.
    pub linked: usize,
    /// Those that it has, but links to nothing.
    pub without_geometry: usize,
}

/// Counts, and finds patches that are linked in part.
pub(super) fn check(linked: &LinkedMesh<'_>, models: &[&ModelLinks<'_>], findings: &mut Findings) -> Vec<Coverage> {
    let mut states: FxHashMap<usize, (bool, Origin)> = FxHashMap::default();
    for (links, sheet) in models.iter().flat_map(|links| links.sheets.iter().map(move |sheet| (links, sheet))) {
        let linked = linked.within(links.model);
        for link in &sheet.faces {
            let has_geometry = link.target.is_some();
            for face in link.run.faces().filter_map(|face| linked.face(face)) {
                let state = states.entry(face).or_insert((has_geometry, link.run.origin));
                state.0 |= has_geometry;
            }
        }
        if let Some(name) = sheet.reference {
            let called =
                |face: &usize| linked.mesh.names_of(linked.boundary.faces[*face].entity).contains(&name.into());
            for face in (0..linked.boundary.faces.len()).filter(called) {
                states.entry(face).or_insert((sheet.target.is_some(), sheet.sheet.origin));
            }
        }
    }
    if linked.boundary.plane.is_some() {
        strings(linked, models, &mut states);
    }
    let mut patches: BTreeMap<EntityKey, (Coverage, Option<Origin>)> = BTreeMap::new();
    for (index, face) in linked.boundary.faces.iter().enumerate() {
        let (patch, place) = patches.entry(face.entity).or_insert_with(|| {
            let names = linked.mesh.names_of(face.entity);
            (Coverage { entity: face.entity.to_string(), names, faces: 0, linked: 0, without_geometry: 0 }, None)
        });
        patch.faces += 1;
        if let Some((has_geometry, origin)) = states.get(&index) {
            patch.linked += usize::from(*has_geometry);
            patch.without_geometry += usize::from(!has_geometry);
            place.get_or_insert(*origin);
        }
    }
    for (patch, place) in patches.values() {
        let named = patch.linked + patch.without_geometry;
        if let Some(origin) = place.filter(|_| named < patch.faces) {
            findings.push(Code::PartlyCovered, origin, || {
                let name = patch.names.join(",");
                format!("{named} of the {} faces of {} {name} are in the file", patch.faces, patch.entity)
            });
        }
    }
    patches.into_values().map(|(patch, _)| patch).collect()
}

/// The sides of a plane mesh are linked by strings.
fn strings(linked: &LinkedMesh<'_>, models: &[&ModelLinks<'_>], states: &mut FxHashMap<usize, (bool, Origin)>) {
    for (links, string) in models.iter().flat_map(|links| links.strings.iter().map(move |string| (links, string))) {
        let linked = linked.within(links.model);
        for link in &string.edges {
            for edge in link.run.edges().filter_map(|ends| linked.edge(ends)) {
                for &side in &linked.boundary.edge_faces[edge] {
                    states.entry(side).or_insert((false, link.run.origin)).0 |= link.target.is_some();
                }
            }
        }
    }
}
