//! Where the judge reads elements from.

use glam::DVec3;

use super::mean_normal;
use crate::element::{Cell, Order};
use crate::mesh::{self, ElementId, Mesh};

/// An element's coordinates, in memory that is used again.
#[derive(Clone, Debug, Default)]
pub struct Buffer {
    /// Nodes in internal order.
    pub points: Vec<DVec3>,
    /// Corners of the unperturbed linear element; empty where there is none.
    pub corners: Vec<DVec3>,
    /// The unit normal that a face is judged against; volumes have none.
    pub normal: Option<DVec3>,
}

/// Elements that are to be judged, of any kinds and orders.
pub trait Elements: Sync {
    /// How many there are.
    fn count(&self) -> usize;

    /// The number of the element at a place among them, below their count; numbers rise with the places.
    fn id(&self, place: usize) -> ElementId;

    /// The place of an element among them.
    fn place(&self, element: ElementId) -> usize;

    /// Fills the empty buffer with an element.
    fn read(&self, element: ElementId, into: &mut Buffer) -> (Cell, Order);
}

/// The cells of a mesh.
#[derive(Clone, Debug)]
pub struct MeshElements<'a> {
    cells: mesh::Elements<'a>,
    positions: &'a [DVec3],
    unperturbed: Option<&'a [DVec3]>,
    /// That of a plane mesh.
    normal: Option<DVec3>,
    /// Whether every face is judged against its own mean normal.
    by_face: bool,
}

impl<'a> MeshElements<'a> {
    /// The cells of a mesh with its nodes at `positions`, and the points of its linear nodes before they were moved (the first
    /// of an elevated mesh's); without these an element's reference is its own straight corners.
    ///
    /// Faces are judged against the normal of the mesh's plane ([`Mesh::plane`]); those of a mesh that has none are undecided.
    #[must_use]
    pub fn new(mesh: &'a Mesh, positions: &'a [DVec3], unperturbed: Option<&'a [DVec3]>) -> MeshElements<'a> {
        let normal = mesh.plane(positions).map(|plane| plane.normal);
        MeshElements { cells: mesh.cells(), positions, unperturbed, normal, by_face: false }
    }

    /// The faces of a mesh without a volume, each judged against the mean normal of its linear face; `linear` are the points of the linear
    /// nodes before they were moved.
    #[must_use]
    pub fn of_surface(mesh: &'a Mesh, positions: &'a [DVec3], linear: &'a [DVec3]) -> MeshElements<'a> {
        MeshElements { cells: mesh.cells(), positions, unperturbed: Some(linear), normal: None, by_face: true }
    }

    /// The unit normal of a plane mesh.
    #[must_use]
    pub fn normal(&self) -> Option<DVec3> {
        self.normal
    }
}

impl Elements for MeshElements<'_> {
    fn count(&self) -> usize {
        self.cells.len()
    }

    fn id(&self, place: usize) -> ElementId {
        self.cells.id(place)
    }

    fn place(&self, element: ElementId) -> usize {
        element.index()
    }

    fn read(&self, element: ElementId, into: &mut Buffer) -> (Cell, Order) {
        let element = self.cells.get(element);
        into.points.extend(element.nodes.iter().map(|n| self.positions[n.index()]));
        if let Some(points) = self.unperturbed {
            into.corners.extend(element.corners().iter().map(|n| points[n.index()]));
        }
        into.normal = if self.by_face { Some(mean_normal(&into.corners)) } else { self.normal };
        (element.cell, self.cells.order())
    }
}
