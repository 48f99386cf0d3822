//! CAD groups: sets of faces, edges and vertices, with a tree of samples and a tree of hull boxes each.

use crate::boxes::{Aabb, BoxTree};
use crate::closest::foot::Foot;
use crate::closest::hint::Hint;
use crate::geometry::evaluation::Evaluation;
use crate::ids::{EdgeId, EntityId, FaceId, VertexId};
use crate::model::{Geometry, Model};
use glam::DVec3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use thiserror::Error;

/// Groups made so far in this process.
static GROUPS: AtomicU32 = AtomicU32::new(0);

/// Why a group cannot be made.
#[derive(Debug, Error, PartialEq)]
pub enum GroupError {
    /// No entity was given.
    #[error("a CAD group needs at least one face, edge or vertex")]
    Empty,
    /// Number beyond those of the model.
    #[error("{entity} is not in the CAD model, which has {count} of that kind")]
    Unknown {
        /// The number that was asked for.
        entity: EntityId,
        /// How many entities of its kind there are.
        count: usize,
    },
    /// Only degenerate edges.
    #[error("{entity} is degenerate: it has no curve to project on; take its vertex instead")]
    Degenerate {
        /// The edge.
        entity: EntityId,
    },
    /// Faces without area, or a surface that OCCT cannot evaluate.
    #[error("the group has no point to project on: its faces have no area inside their trims")]
    Void,
}

/// A leaf of the group's tree: entity index in the model and the entity's own leaf.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Member {
    Face {
        face: u32,
        leaf: u32,
    },
    /// `owner` is a face of the group that the edge bounds, if there is one.
    Edge {
        edge: u32,
        leaf: u32,
        owner: Option<u32>,
    },
    /// `owner` is a face of the group that the vertex is a corner of, if there is one.
    Vertex {
        vertex: u32,
        owner: Option<u32>,
    },
}

/// A set of faces, edges and vertices: the unit of projection. All queries may be made from many threads at once.
pub struct Group {
    /// Tells hints from this group from those of others.
    pub(crate) number: u32,
    pub(crate) geometry: Arc<Geometry>,
    entities: Vec<EntityId>,
    pub(crate) members: Vec<Member>,
    pub(crate) boxes: BoxTree,
    samples: ImmutableKdTree<f64, 3>,
    /// How large a leaf is, on average.
    pub(crate) leaf_size: f64,
    /// Diagonal of the model, the measure of all tolerances.
    pub(crate) diagonal: f64,
}

impl std::fmt::Debug for Group {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Group").field("entities", &self.entities).finish_non_exhaustive()
    }
}

impl Group {
    /// Group of faces; their boundary edges and corners are taken along: the
    /// closest point of a trimmed face may lie there, off the surface by up to the tolerance of the edge or vertex. Order and repetition of `ids` do not matter.
    ///
    /// # Errors
    /// [`GroupError`]: no ids, ids that the model lacks, nothing to project on.
    pub fn of_faces(model: &Model, ids: &[FaceId]) -> Result<Self, GroupError> {
        Self::of(model, &ids.iter().map(|&id| id.into()).collect::<Vec<_>>())
    }

    /// Group of edges; degenerate ones (poles) have no curve and count only if a real one is there too.
    ///
    /// # Errors
    /// [`GroupError`]: no ids, ids that the model lacks, degenerate edges only.
    pub fn of_edges(model: &Model, ids: &[EdgeId]) -> Result<Self, GroupError> {
        Self::of(model, &ids.iter().map(|&id| id.into()).collect::<Vec<_>>())
    }

    /// Group of vertices.
    ///
    /// # Errors
    /// [`GroupError`]: no ids, ids that the model lacks.
    pub fn of_vertices(model: &Model, ids: &[VertexId]) -> Result<Self, GroupError> {
        Self::of(model, &ids.iter().map(|&id| id.into()).collect::<Vec<_>>())
    }

    /// Group of any entities, as [`Group::of_faces`], [`Group::of_edges`] and [`Group::of_vertices`] take them. A foot on an edge or a vertex
    /// that bounds a face of the group is given as a foot of that face.
    ///
    /// # Errors
    /// [`GroupError`]: no ids, ids that the model lacks, nothing to project on.
    pub fn of(model: &Model, ids: &[EntityId]) -> Result<Self, GroupError> {
        let ids = sorted(model, ids)?;
        let geometry = model.geometry();
        let (mut members, mut seen) = (Vec::new(), BTreeSet::new());
        let faces = || ids.iter().filter_map(|id| if let EntityId::Face(id) = id { Some(id.index()) } else { None });
        for face in faces() {
            let leaves = geometry.faces[face].leaves.len() as u32;
            members.extend((0..leaves).map(|leaf| Member::Face { face: face as u32, leaf }));
        }
        let sides = |face: usize| geometry.faces[face].sides.iter().filter_map(|side| side.edge);
        for face in faces() {
            for edge in sides(face) {
                add_edge(geometry, EdgeId::new(edge), Some(face as u32), &mut seen, &mut members);
            }
        }
        for face in faces() {
            for edge in sides(face).filter(|&edge| geometry.edges[edge].is_some()) {
                for vertex in geometry.ends[edge].into_iter().flatten() {
                    add_vertex(vertex, Some(face as u32), &mut seen, &mut members);
                }
            }
        }
        for &id in &ids {
            match id {
                EntityId::Face(_) => {}
                EntityId::Edge(edge) => add_edge(geometry, edge, None, &mut seen, &mut members),
                EntityId::Vertex(vertex) => add_vertex(vertex, None, &mut seen, &mut members),
            }
        }
        match (members.is_empty(), ids.iter().find(|id| matches!(id, EntityId::Edge(_)))) {
            (true, Some(&entity)) => Err(GroupError::Degenerate { entity }),
            _ => Self::new(model, ids, members),
        }
    }

    fn new(model: &Model, entities: Vec<EntityId>, members: Vec<Member>) -> Result<Self, GroupError> {
        let geometry = Arc::clone(model.geometry());
        let boxes: Vec<Aabb> = members.iter().map(|&member| geometry.bounds_of(member)).collect();
        let centers: Vec<[f64; 3]> = members.iter().map(|&member| geometry.sample_of(member).to_array()).collect();
        if centers.is_empty() || centers.iter().flatten().any(|c| !c.is_finite()) {
            return Err(GroupError::Void);
        }
        let samples = ImmutableKdTree::new_from_slice(&centers).map_err(|_| GroupError::Void)?;
        Ok(Self {
            number: GROUPS.fetch_add(1, Ordering::Relaxed),
            geometry,
            entities,
            members,
            boxes: BoxTree::new(&boxes),
            samples,
            leaf_size: boxes.iter().map(Aabb::diagonal).sum::<f64>() / boxes.len() as f64,
            diagonal: model.diagonal(),
        })
    }

    /// The entities of the group, in ascending order.
    pub fn entities(&self) -> &[EntityId] {
        &self.entities
    }

    /// Box around the hulls of all members.
    pub fn bounds(&self) -> Aabb {
        self.boxes.bounds()
    }

    /// Leaf whose sample is nearest to `x`: the seed of a search without a hint.
    pub(crate) fn seed(&self, x: DVec3) -> usize {
        // far outside the model the tree of samples degenerates into a linear scan: ask from the nearest point of the box
        let bounds = self.boxes.bounds();
        let near = x.clamp(bounds.min, bounds.max);
        self.samples.query(&near.to_array()).nearest_one::<SquaredEuclidean<f64>>().execute().item as usize
    }

    /// [`Group::closest`] for many points at once, on all threads of the current rayon pool. `hints` is empty or holds one a point.
    /// The answers do not depend on the number of threads.
    pub fn closest_batch(&self, xs: &[DVec3], hints: &mut [Hint]) -> Vec<Option<Foot>> {
        if hints.len() == xs.len() {
            return xs.par_iter().zip(hints).map(|(&x, hint)| self.closest(x, Some(hint))).collect();
        }
        xs.par_iter().map(|&x| self.closest(x, None)).collect()
    }

    /// [`Group::distance`] for many points at once, on all threads of the current rayon pool.
    pub fn distances(&self, xs: &[DVec3]) -> Vec<f64> {
        xs.par_iter().map(|&x| self.distance(x)).collect()
    }

    /// Point and derivatives of an entity of the model at OCCT's parameters, by OCCT. `None` where OCCT cannot evaluate, the entity
    /// does not exist, or is a degenerate edge.
    pub fn evaluate(&self, entity: EntityId, parameters: [f64; 2]) -> Option<Evaluation> {
        self.geometry.evaluate(entity, parameters)
    }

    /// Derivatives at a foot, by OCCT. `None` where it has no parameters, or OCCT cannot evaluate.
    pub fn evaluate_at(&self, foot: &Foot) -> Option<Evaluation> {
        self.evaluate(foot.entity, foot.parameters?)
    }

    /// [`Group::evaluate`] for many parameters at once, on all threads of the current rayon pool.
    pub fn evaluate_batch(&self, at: &[(EntityId, [f64; 2])]) -> Vec<Option<Evaluation>> {
        at.par_iter().map(|&(entity, parameters)| self.geometry.evaluate(entity, parameters)).collect()
    }
}

/// The leaves of an edge, once; degenerate edges have none.
fn add_edge(
    geometry: &Geometry,
    edge: EdgeId,
    owner: Option<u32>,
    seen: &mut BTreeSet<EntityId>,
    members: &mut Vec<Member>,
) {
    if let Some(curve) = geometry.edges[edge.index()].as_ref().filter(|_| seen.insert(edge.into())) {
        let leaves = curve.leaves.len() as u32;
        members.extend((0..leaves).map(|leaf| Member::Edge { edge: edge.index() as u32, leaf, owner }));
    }
}

fn add_vertex(vertex: VertexId, owner: Option<u32>, seen: &mut BTreeSet<EntityId>, members: &mut Vec<Member>) {
    if seen.insert(vertex.into()) {
        members.push(Member::Vertex { vertex: vertex.index() as u32, owner });
    }
}

fn sorted(model: &Model, ids: &[EntityId]) -> Result<Vec<EntityId>, GroupError> {
    let mut ids = ids.to_vec();
    ids.sort_unstable();
    ids.dedup();
    let unknown = ids.iter().find(|&&id| model.label(id).is_none());
    match unknown {
        Some(&entity) => {
            let count = match entity {
                EntityId::Face(_) => model.faces().len(),
                EntityId::Edge(_) => model.edges().len(),
                EntityId::Vertex(_) => model.vertices().len(),
            };
            Err(GroupError::Unknown { entity, count })
        }
        None if ids.is_empty() => Err(GroupError::Empty),
        None => Ok(ids),
    }
}

impl Geometry {
    pub(crate) fn bounds_of(&self, member: Member) -> Aabb {
        match member {
            Member::Face { face, leaf } => self.faces[face as usize].leaves[leaf as usize].bounds,
            Member::Edge { edge, leaf, .. } => {
                self.edges[edge as usize].as_ref().map_or(Aabb::EMPTY, |e| e.leaves[leaf as usize].bounds)
            }
            Member::Vertex { vertex, .. } => Aabb::of_points([self.vertices[vertex as usize].0]),
        }
    }

    fn sample_of(&self, member: Member) -> DVec3 {
        match member {
            Member::Face { face, leaf } => {
                let face = &self.faces[face as usize];
                let [u, v] = face.leaves[leaf as usize].rect.center();
                face.chart.d2(u, v)[0]
            }
            Member::Edge { edge, leaf, .. } => self.edges[edge as usize].as_ref().map_or(DVec3::NAN, |e| {
                let [a, b] = e.leaves[leaf as usize].range;
                e.curve.d2(0.5 * (a + b))[0]
            }),
            Member::Vertex { vertex, .. } => self.vertices[vertex as usize].0,
        }
    }
}
