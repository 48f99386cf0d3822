//! Ids of CAD entities and of sets of them.

use std::collections::BTreeMap;

use cad::EntityId;
use linkage_schema::{GeometryGroup, GeometryId, GeometryReference, Origin};

use super::patches::{patches, union};
use crate::associate::Candidates;
use crate::mesh::{Boundary, Mesh};

/// The id of every entity and of every set of several that something lies on.
pub(super) struct Ids {
    references: BTreeMap<EntityId, GeometryId>,
    groups: BTreeMap<Vec<EntityId>, (GeometryId, String)>,
}

impl Ids {
    pub(super) fn new(candidates: &Candidates, mesh: &Mesh, boundary: &Boundary) -> Ids {
        let mut sets: BTreeMap<Vec<EntityId>, String> = BTreeMap::new();
        for (entity, runs) in patches(candidates, boundary) {
            sets.entry(union(&runs)).or_insert_with(|| mesh.label(entity));
            for (entities, _) in runs {
                sets.entry(entities.to_vec()).or_default();
            }
        }
        let others =
            candidates.strings.iter().map(|s| &s.entities).chain(candidates.points.iter().map(|p| &p.entities));
        for entities in others {
            sets.entry(entities.clone()).or_default();
        }
        let mut made = Ids { references: BTreeMap::new(), groups: BTreeMap::new() };
        let mut ids = (1..=u32::MAX).filter_map(GeometryId::new);
        for &entity in sets.keys().flatten() {
            if !made.references.contains_key(&entity)
                && let Some(id) = ids.next()
            {
                made.references.insert(entity, id);
            }
        }
        for (set, name) in sets.into_iter().filter(|(set, _)| set.len() > 1) {
            if let Some(id) = ids.next() {
                made.groups.insert(set, (id, name));
            }
        }
        made
    }

    /// What stands for these entities; nothing where there are none.
    pub(super) fn gref(&self, entities: &[EntityId]) -> Option<GeometryId> {
        match entities {
            [only] => self.references.get(only).copied(),
            several => self.groups.get(several).map(|(id, _)| *id),
        }
    }

    /// The definitions, by id.
    pub(super) fn geometry(self) -> (Vec<GeometryReference>, Vec<GeometryGroup>) {
        let references = &self.references;
        let mut singles: Vec<GeometryReference> = references
            .iter()
            .map(|(&entity, &id)| GeometryReference {
                id,
                reference: reference(entity),
                name: None,
                aref: None,
                origin: Origin::MADE,
            })
            .collect();
        singles.sort_by_key(|single| single.id);
        let group = |(members, (id, name)): (&Vec<EntityId>, &(GeometryId, String))| GeometryGroup {
            id: *id,
            name: Some(name.clone()).filter(|name| !name.is_empty()),
            aref: None,
            members: members.iter().filter_map(|entity| references.get(entity).copied()).collect(),
            origin: Origin::MADE,
        };
        let mut groups: Vec<GeometryGroup> = self.groups.iter().map(group).collect();
        groups.sort_by_key(|group| group.id);
        (singles, groups)
    }
}

/// `face-3`, as Gmsh's numbers are written.
fn reference(entity: EntityId) -> String {
    entity.to_string().replace(':', "-")
}
