//! Planes: flat CAD faces and straight edges, and patches that are not associated with the CAD.

use std::collections::BTreeSet;

use cad::{EntityId, Evaluation};
use glam::DVec3;

use super::{Binder, ON_ENTITY, surface_of};
use crate::associate::Classification;
use crate::mesh::{NodeId, Plane};

impl Binder<'_> {
    /// The plane of a plane face; of a straight edge that which stands on the mesh's plane.
    pub(super) fn plane(&self, entity: EntityId) -> Option<Plane> {
        let flat = self.model.is_flat(entity);
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
    pub(super) fn common_plane(&self, entities: &[EntityId]) -> Option<Plane> {
        let mut common: Option<Plane> = None;
        for &id in entities {
            let own = self.plane(id)?;
            match common {
                None => common = Some(own),
                Some(plane) if self.is_same_plane(plane, own) => {}
                Some(_) => return None,
            }
        }
        common
    }

    fn is_same_plane(&self, plane: Plane, other: Plane) -> bool {
        let apart = plane.closest(other.point).distance(other.point);
        plane.normal.cross(other.normal).length() <= ON_ENTITY && apart <= self.slack
    }

    /// An unlinked patch keeps its plane, if it has one, or its straight faces.
    pub(super) fn unlinked(&mut self, patch: &[usize]) {
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

    /// Whether faces of one flat CAD face go on, in its plane, in faces that are not associated with the CAD: it ends near there, and what is
    /// between them is not to be taken to its edge.
    pub(super) fn go_on_in_plane(&self, classifications: &[Classification]) -> bool {
        let surfaces: BTreeSet<usize> = classifications.iter().filter_map(|h| surface_of(*h)).collect();
        let planes: Option<Vec<Plane>> = classifications.iter().map(|&h| self.result.plane_of(h)).collect();
        let Some(planes) = planes.filter(|_| surfaces.len() == 1) else { return false };
        planes.windows(2).all(|pair| self.is_same_plane(pair[0], pair[1]))
    }
}
