//! Curves of mesh edges: of the lines that a source names, and of those that lie between faces on different surfaces.

use std::collections::BTreeSet;

use cad::{EdgeId, EntityId, FaceId, Group};
use glam::DVec3;
use rustc_hash::FxHashMap;

use super::{Binder, list, surface_of};
use crate::associate::{AssociateError, Candidate, Candidates, Classification, Curve};
use crate::mesh::NodeId;

/// Doubles of a CAD edge count as one curve where the farthest points of a mesh line are no more times as far from one as from the other, ...
const DOUBLE: f64 = 10.0;
/// ... or this near; fraction of the model's diagonal.
const SAME_PLACE: f64 = 1e-9;

impl Binder<'_> {
    pub(super) fn edges(&mut self, candidates: &Candidates) -> Result<(), AssociateError> {
        self.result.edges = vec![Classification::Straight; self.boundary.edges.len()];
        let mut done = vec![false; self.boundary.edges.len()];
        for string in &candidates.strings {
            let edges: Vec<usize> = string.items.iter().filter_map(|&ends| self.boundary.edge(ends)).collect();
            let trusted = candidates.trusted;
            if let Some(curve) = self.candidate_curve(string, &edges, trusted)? {
                for edge in edges {
                    self.result.edges[edge] = Classification::Curve(curve);
                    done[edge] = true;
                }
            }
        }
        for edge in (0..done.len()).filter(|&e| !done[e]) {
            self.result.edges[edge] = self.without_candidate(edge)?;
        }
        Ok(())
    }

    /// The curve of a string: as candidate where its points lie there, else by the surfaces that meet in it.
    fn candidate_curve(
        &mut self,
        string: &Candidate<[NodeId; 2]>,
        edges: &[usize],
        trusted: bool,
    ) -> Result<Option<usize>, AssociateError> {
        let nodes: BTreeSet<NodeId> = string.items.iter().flatten().copied().collect();
        let named: Vec<EdgeId> = string.entities.iter().filter_map(|e| edge_of(*e)).collect();
        let ids = self.without_far_doubles(named, &nodes);
        if !ids.is_empty()
            && let Ok(group) = Group::of_edges(self.model, &ids)
        {
            let places: Vec<DVec3> = nodes.iter().map(|n| self.mesh.points()[n.index()]).collect();
            let farthest = group.distances(&places).into_iter().fold(0.0, f64::max);
            if farthest <= self.slack {
                return Ok(Some(self.curve(ids, &string.label, group)));
            }
            if trusted {
                self.held(&group, &string.label, &string.entities, &nodes)?;
                return Ok(Some(self.curve(ids, &string.label, group)));
            }
        }
        let found: Option<Vec<BTreeSet<EdgeId>>> = edges.iter().map(|&e| self.candidates(e)).collect();
        let union: BTreeSet<EdgeId> = found.into_iter().flatten().flatten().collect();
        if union.is_empty() {
            return Ok(None);
        }
        self.result.notes.push(format!("{}: found on {}", string.label, list(union.iter())));
        let ids: Vec<EdgeId> = union.into_iter().collect();
        let group = Group::of_edges(self.model, &ids).map_err(|cause| self.bad_group(string, &cause))?;
        Ok(Some(self.curve(ids, &string.label, group)))
    }

    /// Edges without those whose double is where the nodes of a mesh line are: faces that were not sewn have an edge each, and these may be
    /// apart by more than the first cells are thick.
    fn without_far_doubles(&self, ids: Vec<EdgeId>, nodes: &BTreeSet<NodeId>) -> Vec<EdgeId> {
        let doubles = |&id: &EdgeId| self.model.sewing().same_as(id).into_iter().filter(|other| ids.contains(other));
        if ids.iter().all(|id| doubles(id).all(|other| other == *id)) {
            return ids;
        }
        let farthest = |id: EdgeId| {
            let places: Vec<DVec3> = nodes.iter().map(|n| self.mesh.points()[n.index()]).collect();
            let group = Group::of_edges(self.model, &[id]).ok()?;
            Some(group.distances(&places).into_iter().fold(0.0, f64::max))
        };
        let far: FxHashMap<EdgeId, f64> = ids.iter().filter_map(|&id| Some((id, farthest(id)?))).collect();
        let is_near = |id: &EdgeId| {
            let least = doubles(id).filter_map(|other| far.get(&other).copied()).fold(f64::INFINITY, f64::min);
            let near = (DOUBLE * least).max(SAME_PLACE * self.model.diagonal());
            far.get(id).is_none_or(|&distance| distance <= near)
        };
        ids.iter().copied().filter(is_near).collect()
    }

    fn curve(&mut self, mut ids: Vec<EdgeId>, label: &str, group: Group) -> usize {
        ids.sort_unstable();
        ids.dedup();
        let key: Vec<EntityId> = ids.iter().map(|&id| id.into()).collect();
        let curves = &mut self.result.curves;
        *self.known_curves.entry(key).or_insert_with(|| {
            curves.push(Curve { group, label: format!("{label} ({})", list(ids.iter())) });
            curves.len() - 1
        })
    }

    /// The classification of an edge that no string holds: that of its faces where they agree.
    fn without_candidate(&mut self, edge: usize) -> Result<Classification, AssociateError> {
        let classifications: Vec<Classification> =
            self.boundary.edge_faces[edge].iter().map(|&f| self.result.faces[f]).collect();
        let Some(&first) = classifications.first() else { return Ok(Classification::Straight) };
        if classifications.iter().all(|&h| h == first) {
            return Ok(first);
        }
        let surfaces: Vec<usize> = classifications.iter().filter_map(|h| surface_of(*h)).collect();
        let Some(&surface) = surfaces.first() else { return Ok(Classification::Straight) };
        if self.go_on_in_plane(&classifications) {
            return Ok(Classification::Surface(surface));
        }
        let found = self.candidates(edge).unwrap_or_default();
        let ids: Vec<EdgeId> = found.into_iter().collect();
        match Group::of_edges(self.model, &ids) {
            Ok(group) => Ok(Classification::Curve(self.curve(ids, "edge between surfaces", group))),
            // What lies beside the surface is not associated with the CAD: the rim of what is goes with it.
            Err(_) if surfaces.iter().all(|&other| other == surface) => Ok(Classification::Surface(surface)),
            Err(_) => {
                let [a, b] = self.boundary.edges[edge].map(|n| self.mesh.node_tags()[n.index()]);
                let label = |h: Option<&Classification>| match h {
                    Some(&Classification::Surface(s)) => self.result.surfaces[s].label.clone(),
                    _ => "a patch that is not associated with the CAD".to_owned(),
                };
                let other = classifications.iter().find(|&&h| h != first);
                Err(AssociateError::NoCurve {
                    a,
                    b,
                    first: label(Some(&first)),
                    second: label(other),
                    teller: self.teller,
                })
            }
        }
    }

    /// CAD edges, of the surfaces at a mesh edge, that hold its ends and run beside it; `None` where there is none.
    fn candidates(&mut self, edge: usize) -> Option<BTreeSet<EdgeId>> {
        let mut nearby = BTreeSet::new();
        for &face in &self.boundary.edge_faces[edge] {
            let Classification::Surface(surface) = self.result.faces[face] else { continue };
            for id in self.result.surfaces[surface].group.entities().iter().filter_map(|e| face_of(*e)) {
                nearby.extend(self.model.face(id).map_or(&[][..], |f| &f.edges).iter().copied());
            }
        }
        let [a, b] = self.boundary.edges[edge].map(|n| self.mesh.points()[n.index()]);
        let slack = self.slack;
        let holds = |id: &EdgeId| {
            let model = self.model;
            let single = self.singles.entry(*id).or_insert_with(|| Group::of_edges(model, &[*id]).ok());
            let Some(group) = single else { return false };
            let near = |x: DVec3, limit: f64| group.distance(x) <= limit;
            near(a, slack) && near(b, slack) && near(0.5 * (a + b), 0.5 * a.distance(b))
        };
        let found: BTreeSet<EdgeId> = nearby.into_iter().filter(holds).collect();
        (!found.is_empty()).then_some(found)
    }
}

fn face_of(entity: EntityId) -> Option<FaceId> {
    if let EntityId::Face(id) = entity { Some(id) } else { None }
}

fn edge_of(entity: EntityId) -> Option<EdgeId> {
    if let EntityId::Edge(id) = entity { Some(id) } else { None }
}
