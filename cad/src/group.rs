//! CAD groups: sets of faces, of edges or of vertices, with a tree of samples and a tree of hull boxes each.

use crate::boxes::{Aabb, BoxTree};
use crate::chart::surface_d2;
use crate::curve::curve_d2;
use crate::foot::{CurvePoint, Evaluation, Foot, SurfacePoint};
use crate::ids::{EdgeId, EntityId, FaceId, VertexId};
use crate::model::{Geometry, Model};
use glam::DVec3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
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
    /// `owner` is a face of the group that the edge bounds; `None` in groups of edges.
    Edge {
        edge: u32,
        leaf: u32,
        owner: Option<u32>,
    },
    /// `owner` is a face of the group that the vertex is a corner of; `None` in groups of vertices.
    Vertex {
        vertex: u32,
        owner: Option<u32>,
    },
}

/// A set of faces, of edges, or of vertices: the unit of projection. All queries may be made from many threads at once.
pub struct Group {
    /// Tells feet of this group from those of others.
    pub(crate) number: u32,
    pub(crate) geometry: Arc<Geometry>,
    entities: Vec<EntityId>,
    pub(crate) members: Vec<Member>,
    pub(crate) boxes: BoxTree,
    samples: ImmutableKdTree<f64, 3>,
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
        let count = model.faces().len();
        let ids = sorted(ids, |id| id.index() < count, count)?;
        let geometry = model.geometry();
        let mut members = Vec::new();
        for id in &ids {
            let leaves = geometry.faces[id.index()].leaves.len() as u32;
            members.extend((0..leaves).map(|leaf| Member::Face { face: id.index() as u32, leaf }));
        }
        let mut seen = std::collections::BTreeSet::new();
        for id in &ids {
            for edge in geometry.faces[id.index()].sides.iter().filter_map(|side| side.edge) {
                let Some(curve) = geometry.edges[edge].as_ref().filter(|_| seen.insert(edge)) else { continue };
                let owner = Some(id.index() as u32);
                let leaves = curve.leaves.len() as u32;
                members.extend((0..leaves).map(|leaf| Member::Edge { edge: edge as u32, leaf, owner }));
            }
        }
        let mut corners = std::collections::BTreeSet::new();
        for id in &ids {
            let edges = geometry.faces[id.index()].sides.iter().filter_map(|side| side.edge);
            for vertex in edges.filter(|&edge| geometry.edges[edge].is_some()).flat_map(|edge| geometry.ends[edge]) {
                let Some(vertex) = vertex.filter(|vertex| corners.insert(vertex.index())) else { continue };
                members.push(Member::Vertex { vertex: vertex.index() as u32, owner: Some(id.index() as u32) });
            }
        }
        Self::new(model, ids.into_iter().map(EntityId::Face).collect(), members)
    }

    /// Group of edges; degenerate ones (poles) have no curve and count only if a real one is there too.
    ///
    /// # Errors
    /// [`GroupError`]: no ids, ids that the model lacks, degenerate edges only.
    pub fn of_edges(model: &Model, ids: &[EdgeId]) -> Result<Self, GroupError> {
        let count = model.edges().len();
        let ids = sorted(ids, |id| id.index() < count, count)?;
        let mut members = Vec::new();
        for id in &ids {
            let Some(curve) = &model.geometry().edges[id.index()] else { continue };
            let leaves = curve.leaves.len() as u32;
            members.extend((0..leaves).map(|leaf| Member::Edge { edge: id.index() as u32, leaf, owner: None }));
        }
        if members.is_empty() {
            return Err(GroupError::Degenerate { entity: ids[0].into() });
        }
        Self::new(model, ids.into_iter().map(EntityId::Edge).collect(), members)
    }

    /// Group of vertices.
    ///
    /// # Errors
    /// [`GroupError`]: no ids, ids that the model lacks.
    pub fn of_vertices(model: &Model, ids: &[VertexId]) -> Result<Self, GroupError> {
        let count = model.vertices().len();
        let ids = sorted(ids, |id| id.index() < count, count)?;
        let members = ids.iter().map(|id| Member::Vertex { vertex: id.index() as u32, owner: None }).collect();
        Self::new(model, ids.into_iter().map(EntityId::Vertex).collect(), members)
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

    /// [`Group::closest`] for many points at once, on all threads of the current rayon pool. `hints` may be empty or hold one entry a point.
    /// The answers do not depend on the number of threads.
    pub fn closest_batch(&self, xs: &[DVec3], hints: &[Option<Foot>]) -> Vec<Foot> {
        xs.par_iter().enumerate().map(|(i, &x)| self.closest(x, hints.get(i).and_then(Option::as_ref))).collect()
    }

    /// Point and derivatives of an entity of the model at OCCT's parameters, by OCCT. `None` where OCCT cannot evaluate, the entity
    /// does not exist, or is a degenerate edge.
    pub fn evaluate(&self, entity: EntityId, parameters: [f64; 2]) -> Option<Evaluation> {
        self.geometry.evaluate(entity, parameters)
    }
}

fn sorted<I: Copy + Ord + Into<EntityId>>(
    ids: &[I],
    known: impl Fn(I) -> bool,
    count: usize,
) -> Result<Vec<I>, GroupError> {
    let mut ids = ids.to_vec();
    ids.sort_unstable();
    ids.dedup();
    match ids.iter().find(|&&id| !known(id)) {
        Some(&id) => Err(GroupError::Unknown { entity: id.into(), count }),
        None if ids.is_empty() => Err(GroupError::Empty),
        None => Ok(ids),
    }
}

impl Geometry {
    fn bounds_of(&self, member: Member) -> Aabb {
        match member {
            Member::Face { face, leaf } => self.faces[face as usize].leaves[leaf as usize].bounds,
            Member::Edge { edge, leaf, .. } => {
                self.edges[edge as usize].as_ref().map_or(Aabb::EMPTY, |e| e.leaves[leaf as usize].bounds)
            }
            Member::Vertex { vertex, .. } => Aabb::of_points([self.vertices[vertex as usize]]),
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
            Member::Vertex { vertex, .. } => self.vertices[vertex as usize],
        }
    }

    pub(crate) fn evaluate(&self, entity: EntityId, [u, v]: [f64; 2]) -> Option<Evaluation> {
        let evaluation = match entity {
            EntityId::Face(id) => {
                let face = self.faces.get(id.index())?;
                Evaluation::Surface(SurfacePoint::new(surface_d2(&face.handle, u, v), face.reversed))
            }
            EntityId::Edge(id) => {
                Evaluation::Curve(CurvePoint::new(curve_d2(&self.edges.get(id.index())?.as_ref()?.handle, u)))
            }
            EntityId::Vertex(id) => Evaluation::Vertex(*self.vertices.get(id.index())?),
        };
        evaluation.point().is_finite().then_some(evaluation)
    }
}
