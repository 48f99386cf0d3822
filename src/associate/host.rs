//! The CAD entities that the sides of a mesh lie on: faces, and edges in a plane mesh.

use cad::{Aabb, EntityId, Evaluation, Foot, Group, Kind, Model};
use glam::DVec3;

use super::{Candidate, Candidates};
use crate::mesh::{Boundary, Plane};

/// Whether the boundary faces of a mesh may lie on a CAD entity.
pub(super) fn is_host(boundary: &Boundary, entity: EntityId) -> bool {
    matches!((boundary.plane, entity), (None, EntityId::Face(_)) | (Some(_), EntityId::Edge(_)))
}

/// All CAD entities that the boundary faces of a mesh may lie on, ascending; among edges no poles.
pub(super) fn hosts(boundary: &Boundary, model: &Model) -> Vec<EntityId> {
    match boundary.plane {
        None => model.faces().iter().map(|face| face.id.into()).collect(),
        Some(_) => model.edges().iter().filter(|edge| !edge.degenerate).map(|edge| edge.id.into()).collect(),
    }
}

/// The shape of a face or edge.
pub(super) fn kind_of(model: &Model, entity: EntityId) -> Option<Kind> {
    match entity {
        EntityId::Face(id) => model.face(id).map(|face| face.kind),
        EntityId::Edge(id) => model.edge(id).map(|edge| edge.kind),
        EntityId::Vertex(_) => None,
    }
}

/// The box of a face or edge.
pub(super) fn bounds_of(model: &Model, entity: EntityId) -> Option<Aabb> {
    match entity {
        EntityId::Face(id) => model.face(id).map(|face| face.bounds),
        EntityId::Edge(id) => model.edge(id).map(|edge| edge.bounds),
        EntityId::Vertex(_) => None,
    }
}

/// The unit normal of a group where a foot is: of a face, or in the plane of a mesh of an edge, to the right of its direction. `None` where the
/// CAD has none.
#[must_use]
pub fn normal_of(group: &Group, foot: &Foot, plane: Option<Plane>) -> Option<DVec3> {
    match (foot.entity, group.evaluate_at(foot)?, plane) {
        (EntityId::Face(_), Evaluation::Surface(point), None) => point.normal,
        (_, Evaluation::Curve(point), Some(plane)) => point.tangent?.cross(plane.normal).try_normalize(),
        _ => None,
    }
}

impl Candidates {
    /// In a plane mesh takes what is said of edges for what is said of its sides, and leaves out what is said of faces.
    pub(super) fn of_sides(mut self, boundary: &Boundary) -> Candidates {
        if boundary.plane.is_none() {
            return self;
        }
        let sides = |Candidate { label, items, entities }: Candidate<_>| Candidate {
            label,
            items: items.iter().filter_map(|ends: &[_; 2]| boundary.face(ends)).collect(),
            entities,
        };
        self.sheets = std::mem::take(&mut self.strings).into_iter().map(sides).collect();
        self.sheets.retain(|sheet| !sheet.items.is_empty());
        self
    }

    /// The way back: as a linkage file says it.
    pub(super) fn into_written(mut self, boundary: &Boundary) -> Candidates {
        if boundary.plane.is_some() {
            let ends = |side: &usize| <[_; 2]>::try_from(&boundary.corners[*side][..]).ok();
            let string = |Candidate { label, items, entities }: Candidate<usize>| Candidate {
                label,
                items: items.iter().filter_map(ends).collect(),
                entities,
            };
            self.strings = std::mem::take(&mut self.sheets).into_iter().map(string).collect();
        }
        self
    }
}
