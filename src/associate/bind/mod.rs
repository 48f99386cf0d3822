//! Candidates checked against the CAD: groups are made, points must lie on them, and every boundary item gets its classification.

mod edges;
mod nodes;
mod planes;

use std::collections::BTreeSet;

use cad::{Aabb, EdgeId, EntityId, Group, Model};
use glam::DVec3;
use rustc_hash::FxHashMap;

use super::host::{hosts, is_host};
use super::sizes::check_boxes;
use super::{AssociateError, Association, Candidate, Candidates, Classification, Surface, Teller};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

/// A point this near to a CAD entity lies on it; fraction of the model's diagonal.
const ON_ENTITY: f64 = 1e-6;

/// Associates a mesh with its CAD.
///
/// `max_offset`, a fraction of the mesh's bounding-box diagonal, is how far a point may be from an entity that a trusted source names.
///
/// # Errors
/// [`AssociateError`].
pub fn associate(
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    candidates: &Candidates,
    max_offset: f64,
) -> Result<Association, AssociateError> {
    let faces_linked = candidates.sheets.iter().filter(|s| !s.entities.is_empty()).count();
    if faces_linked == 0 {
        return Err(AssociateError::Nothing {
            surfaces: candidates.sheets.len(),
            faces: model.faces().len(),
            teller: candidates.teller,
        });
    }
    let limit = max_offset * Aabb::of_points(mesh.points().iter().copied()).diagonal();
    let slack = ON_ENTITY * model.diagonal();
    let mut binder = Binder {
        mesh,
        boundary,
        model,
        teller: candidates.teller,
        limit,
        slack,
        result: Association::default(),
        known_surfaces: FxHashMap::default(),
        known_curves: FxHashMap::default(),
        singles: FxHashMap::default(),
    };
    // Boxes of another size or place explain a failure; they make none: a mesh may cover a part of its CAD faces.
    binder.faces(candidates).map_err(|error| check_boxes(mesh, boundary, model, candidates).err().unwrap_or(error))?;
    binder.edges(candidates)?;
    binder.nodes(candidates);
    Ok(binder.result)
}

struct Binder<'a> {
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    model: &'a Model,
    teller: Teller,
    /// How far a point may be from what it is associated with.
    limit: f64,
    /// How far a point may be from what it *lies on*; grows with the offsets that the surfaces show.
    slack: f64,
    result: Association,
    known_surfaces: FxHashMap<Vec<EntityId>, usize>,
    known_curves: FxHashMap<Vec<EntityId>, usize>,
    /// Groups of one edge each, for the search of an edge's curve.
    singles: FxHashMap<EdgeId, Option<Group>>,
}

impl Binder<'_> {
    fn faces(&mut self, candidates: &Candidates) -> Result<(), AssociateError> {
        self.result.faces = vec![Classification::Straight; self.boundary.faces.len()];
        let mut linked = vec![false; self.boundary.faces.len()];
        for sheet in candidates.sheets.iter().filter(|s| !s.entities.is_empty()) {
            let classification = Classification::Surface(self.surface(sheet, candidates.trusted)?);
            for &face in &sheet.items {
                self.result.faces[face] = classification;
                linked[face] = true;
            }
        }
        let mut unlinked: FxHashMap<EntityKey, usize> = FxHashMap::default();
        let mut patches: Vec<Vec<usize>> = Vec::new();
        for face in (0..linked.len()).filter(|&f| !linked[f]) {
            let patch = *unlinked.entry(self.boundary.faces[face].entity).or_insert_with(|| {
                patches.push(Vec::new());
                patches.len() - 1
            });
            patches[patch].push(face);
        }
        for patch in patches {
            self.unlinked(&patch);
        }
        Ok(())
    }

    /// The surface of a sheet, its points checked against it.
    fn surface(&mut self, sheet: &Candidate<usize>, trusted: bool) -> Result<usize, AssociateError> {
        let mut entities = sheet.entities.clone();
        entities.sort_unstable();
        entities.dedup();
        let index = match self.known_surfaces.get(&entities) {
            Some(&index) => index,
            None => {
                let ids: Vec<EntityId> = entities.iter().copied().filter(|&e| is_host(self.boundary, e)).collect();
                let group = Group::of(self.model, &ids).map_err(|cause| self.bad_group(sheet, &cause))?;
                let plane = self.common_plane(&ids);
                let label = format!("{} ({})", sheet.label, names(&entities));
                self.result.surfaces.push(Surface { group, label, plane });
                self.known_surfaces.insert(entities.clone(), self.result.surfaces.len() - 1);
                self.result.surfaces.len() - 1
            }
        };
        let nodes: BTreeSet<NodeId> =
            sheet.items.iter().flat_map(|&f| self.boundary.corners[f].iter().copied()).collect();
        let farthest = self.held(&self.result.surfaces[index].group, &sheet.label, &entities, &nodes)?;
        let off = farthest > ON_ENTITY * self.model.diagonal();
        if let Some(other) = (off && !trusted).then(|| self.host_that_holds(&nodes)).flatten() {
            let (label, entities) = (sheet.label.clone(), names(&entities));
            return Err(AssociateError::Elsewhere { label, entities, other: other.to_string(), teller: self.teller });
        }
        self.result.farthest = self.result.farthest.max(farthest);
        // Noise that the surfaces show must be granted to the edges too.
        self.slack = self.slack.max(4.0 * farthest);
        Ok(index)
    }

    /// The first CAD face, in the plane edge, that all the nodes lie on.
    fn host_that_holds(&self, nodes: &BTreeSet<NodeId>) -> Option<EntityId> {
        let on = |group: &Group, n: &NodeId| {
            group.distance(self.mesh.points()[n.index()]) <= ON_ENTITY * self.model.diagonal()
        };
        let holds =
            |id: &EntityId| Group::of(self.model, &[*id]).is_ok_and(|group| nodes.iter().all(|n| on(&group, n)));
        hosts(self.boundary, self.model).into_iter().find(holds)
    }

    /// The largest distance of the nodes to a group.
    fn held(
        &self,
        group: &Group,
        label: &str,
        entities: &[EntityId],
        nodes: &BTreeSet<NodeId>,
    ) -> Result<f64, AssociateError> {
        let nodes: Vec<NodeId> = nodes.iter().copied().collect();
        let places: Vec<DVec3> = nodes.iter().map(|n| self.mesh.points()[n.index()]).collect();
        let distances = group.distances(&places);
        let off = distances.iter().filter(|&&distance| distance > self.limit).count();
        let worst = (0..distances.len()).max_by(|&a, &b| distances[a].total_cmp(&distances[b]));
        let Some(worst) = worst else { return Ok(0.0) };
        if off > 0 {
            return Err(AssociateError::Off {
                label: label.to_owned(),
                entities: names(entities),
                count: off,
                of: nodes.len(),
                node: self.mesh.node_tags()[nodes[worst].index()],
                at: places[worst],
                distance: distances[worst],
                limit: self.limit,
                teller: self.teller,
            });
        }
        Ok(distances[worst])
    }

    fn bad_group<T>(&self, candidate: &Candidate<T>, cause: &dyn std::fmt::Display) -> AssociateError {
        let label = format!("{} ({})", candidate.label, names(&candidate.entities));
        AssociateError::Group { label, cause: cause.to_string() }
    }
}

fn surface_of(classification: Classification) -> Option<usize> {
    if let Classification::Surface(index) = classification { Some(index) } else { None }
}

fn names(entities: &[EntityId]) -> String {
    list(entities.iter())
}

fn list(items: impl Iterator<Item = impl std::fmt::Display>) -> String {
    items.map(|item| item.to_string()).collect::<Vec<_>>().join(", ")
}
