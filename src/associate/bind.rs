//! Candidates checked against the CAD: groups are made, points must lie on them, and every boundary item gets its classification.

use std::collections::BTreeSet;

use cad::{Aabb, EdgeId, EntityId, Evaluation, FaceId, Group, Kind, Model, VertexId};
use glam::DVec3;
use rustc_hash::FxHashMap;

use super::host::{hosts, is_host, kind_of};
use super::sizes::check_boxes;
use super::{AssociateError, Association, Candidate, Candidates, Classification, Curve, Surface, Teller};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId, Plane};

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

    /// The plane of a plane face; of a straight edge that which stands on the mesh's plane.
    fn plane(&self, entity: EntityId) -> Option<Plane> {
        let flat = matches!(kind_of(self.model, entity)?, Kind::Plane | Kind::Line);
        let middle = |[from, to]: [f64; 2]| 0.5 * (from + to);
        let parameters = match entity {
            EntityId::Face(id) => self.model.face(id)?.parameters.map(middle),
            EntityId::Edge(id) => [middle(self.model.edge(id)?.parameters), 0.0],
            EntityId::Vertex(_) => return None,
        };
        match (self.boundary.plane, self.model.evaluate(entity, parameters).filter(|_| flat)?) {
            (None, Evaluation::Surface(at)) => Some(Plane { point: at.point, normal: at.normal? }),
            (Some(plane), Evaluation::Curve(at)) => plane.upright(&[at.point, at.point + at.tangent?], self.slack),
            _ => None,
        }
    }

    /// The plane that all the faces or edges lie in.
    fn common_plane(&self, entities: &[EntityId]) -> Option<Plane> {
        let mut common: Option<Plane> = None;
        for &id in entities {
            let own = self.plane(id)?;
            match common {
                None => common = Some(own),
                Some(plane) => {
                    let apart = plane.closest(own.point).distance(own.point);
                    if plane.normal.cross(own.normal).length() > ON_ENTITY || apart > self.slack {
                        return None;
                    }
                }
            }
        }
        common
    }

    /// An unlinked patch keeps its plane, if it has one, or its straight faces.
    fn unlinked(&mut self, patch: &[usize]) {
        let nodes: BTreeSet<NodeId> = patch.iter().flat_map(|&f| self.boundary.corners[f].iter().copied()).collect();
        let places: Vec<DVec3> = nodes.iter().map(|n| self.mesh.points()[n.index()]).collect();
        let entity = self.boundary.faces[patch[0]].entity;
        let flat = match self.boundary.plane {
            None => Plane::through(&places, self.slack),
            Some(plane) => plane.upright(&places, self.slack),
        };
        let [noun, shape, are] = match self.boundary.plane {
            None => ["faces", "plane", "planar"],
            Some(_) => ["edges", "line", "straight"],
        };
        let what = format!("{entity}: {} {noun} are not associated with the CAD", patch.len());
        let classification = match flat {
            Some(plane) => {
                self.result.notes.push(format!("{what}; they stay in their {shape}"));
                self.result.planes.push(plane);
                Classification::Plane(self.result.planes.len() - 1)
            }
            None => {
                self.result.notes.push(format!("{what} and are not {are}; they stay straight"));
                Classification::Straight
            }
        };
        for &face in patch {
            self.result.faces[face] = classification;
        }
    }

    fn edges(&mut self, candidates: &Candidates) -> Result<(), AssociateError> {
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
        let ids: Vec<EdgeId> = string.entities.iter().filter_map(|e| edge_of(*e)).collect();
        if !ids.is_empty() {
            let nodes: BTreeSet<NodeId> = string.items.iter().flatten().copied().collect();
            if let Ok(group) = Group::of_edges(self.model, &ids) {
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

    fn nodes(&mut self, candidates: &Candidates) {
        let mut classifications: Vec<BTreeSet<Rank>> = vec![BTreeSet::new(); self.mesh.points().len()];
        for (edge, ends) in self.boundary.edges.iter().enumerate() {
            for end in ends {
                classifications[end.index()].insert(Rank::of(self.result.edges[edge]));
            }
        }
        for (face, corners) in self.boundary.corners.iter().enumerate() {
            for corner in corners {
                classifications[corner.index()].insert(Rank::of(self.result.faces[face]));
            }
        }
        self.result.nodes =
            (0..classifications.len()).map(|n| self.lowest(&classifications[n], self.mesh.points()[n])).collect();
        for point in &candidates.points {
            let vertex = point.entities.iter().find_map(|e| vertex_of(*e)).and_then(|id| self.model.vertex(id));
            for node in &point.items {
                let near = |v: &&cad::Vertex| v.point.distance(self.mesh.points()[node.index()]) <= self.slack;
                if let Some(vertex) = vertex.filter(near) {
                    self.result.nodes[node.index()] = Classification::Vertex(vertex.point);
                }
            }
        }
    }

    /// The lowest of the classifications around a node.
    fn lowest(&self, around: &BTreeSet<Rank>, x: DVec3) -> Classification {
        let curves: Vec<usize> =
            around.iter().filter_map(|r| if let Rank::Curve(c) = r { Some(*c) } else { None }).collect();
        if self.boundary.plane.is_some() {
            return self.lowest_in_plane(around, x);
        }
        match curves[..] {
            [] => around.first().map_or(Classification::Free, |rank| rank.classification()),
            [only] if self.result.curves[only].group.entities().len() == 1 => Classification::Curve(only),
            [first, ..] => self.vertex(x).map_or(Classification::Curve(first), Classification::Vertex),
        }
    }

    /// The same in a plane mesh: where sides on different edges meet, or on several that go together, there is a vertex.
    fn lowest_in_plane(&self, around: &BTreeSet<Rank>, x: DVec3) -> Classification {
        let lowest = around.first().map_or(Classification::Free, |rank| rank.classification());
        let one = match lowest {
            Classification::Surface(surface) => self.result.surfaces[surface].group.entities().len() == 1,
            _ => true,
        };
        if around.len() < 2 && one { lowest } else { self.vertex(x).map_or(lowest, Classification::Vertex) }
    }

    /// The CAD vertex at a place: where curves meet, or the edges of one curve do, perhaps at an angle.
    fn vertex(&self, x: DVec3) -> Option<DVec3> {
        let near = self.model.vertices().iter().map(|v| (v.point.distance(x), v.point));
        let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.filter(|(distance, _)| *distance <= self.slack).map(|(_, point)| point)
    }
}

/// Classifications without coordinates, lowest first: what a node at the meeting of several takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Curve(usize),
    Straight,
    Surface(usize),
    Plane(usize),
}

impl Rank {
    fn of(classification: Classification) -> Rank {
        match classification {
            Classification::Curve(c) => Rank::Curve(c),
            Classification::Surface(s) => Rank::Surface(s),
            Classification::Plane(p) => Rank::Plane(p),
            Classification::Straight | Classification::Free | Classification::Vertex(_) => Rank::Straight,
        }
    }

    fn classification(self) -> Classification {
        match self {
            Rank::Curve(c) => Classification::Curve(c),
            Rank::Surface(s) => Classification::Surface(s),
            Rank::Plane(p) => Classification::Plane(p),
            Rank::Straight => Classification::Straight,
        }
    }
}

fn face_of(entity: EntityId) -> Option<FaceId> {
    if let EntityId::Face(id) = entity { Some(id) } else { None }
}

fn edge_of(entity: EntityId) -> Option<EdgeId> {
    if let EntityId::Edge(id) = entity { Some(id) } else { None }
}

fn vertex_of(entity: EntityId) -> Option<VertexId> {
    if let EntityId::Vertex(id) = entity { Some(id) } else { None }
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
