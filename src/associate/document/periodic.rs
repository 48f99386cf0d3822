//! The periodic pairs of a mesh, as linkages of sheets.

use std::collections::BTreeSet;

use glam::{DAffine3, DMat4};
use linkage_schema::{AttributeId, ElementLinkage, Origin, Transform, TransformId};

use super::model::Models;
use crate::mesh::periodic::{map_of, matched};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId, Periodic};

/// Linkages with their transforms, and what could not be written.
#[derive(Default)]
pub(super) struct Pairs {
    pub(super) transforms: Vec<Transform>,
    pub(super) linkages: Vec<ElementLinkage>,
    pub(super) notes: Vec<String>,
}

/// The pairs of patches of the mesh; `aref` says that they are periodic.
pub(super) fn pairs(mesh: &Mesh, boundary: &Boundary, models: &Models, aref: Option<AttributeId>) -> Pairs {
    let mut pairs = Pairs::default();
    for record in mesh.periodic().iter().filter(|record| record.slave.is_surface()) {
        let master = EntityKey::new(2, record.master);
        let sheet = |entity: EntityKey| match models.sheets.get(&entity).map(|names| &names[..]) {
            Some([only]) => Some(only.clone()),
            _ => None,
        };
        let map = correspondence(mesh, boundary, record, master);
        let (Some(source), Some(target), Some(map)) = (sheet(master), sheet(record.slave), map) else {
            let slave = record.slave;
            pairs.notes.push(format!(
                "the periodic pair of {slave} and {master} is not written: each side must be one sheet, and their points must correspond"
            ));
            continue;
        };
        let number = u32::try_from(pairs.transforms.len() + 1).ok().and_then(TransformId::new);
        let Some(id) = number else { break };
        // Row vectors, the shift in the fourth row, as in the files of other programs.
        let rows = DMat4::from(map).to_cols_array().map(|x| x.to_string());
        let (name, origin) = (Some(format!("{source} to {target}")), Origin::MADE);
        pairs.transforms.push(Transform { id, name: name.clone(), aref: None, content: rows.join(" "), origin });
        pairs.linkages.push(ElementLinkage { source, target, transform: Some(id), aref, name, origin });
    }
    pairs
}

/// The map that takes all nodes of the master onto those of the slave.
fn correspondence(mesh: &Mesh, boundary: &Boundary, record: &Periodic, master: EntityKey) -> Option<DAffine3> {
    let nodes = |entity: EntityKey| -> Vec<NodeId> {
        let faces = (0..boundary.faces.len()).filter(|&face| boundary.faces[face].entity == entity);
        let nodes: BTreeSet<NodeId> = faces.flat_map(|face| boundary.corners[face].iter().copied()).collect();
        nodes.into_iter().collect()
    };
    let map = map_of(mesh, record)?;
    matched(mesh, &nodes(master), &nodes(record.slave), &[map]).map(|(map, _)| map)
}
