//! The mesh at one order on its way to the CAD: the one object that is handed from step to step.

use glam::DVec3;

use super::periodic::PeriodicConstraint;
use super::settings::Settings;
use super::wall_state::Wall;
use crate::associate::{Association, Classification};
use crate::mesh::elevate::Elevated;
use crate::mesh::{Boundary, Mesh, Plane};

/// What is the same at every order.
#[derive(Clone, Copy, Debug)]
pub struct Case<'a> {
    /// What is asked for.
    pub settings: &'a Settings,
    /// The boundary faces and edges of the linear mesh.
    pub boundary: &'a Boundary,
    /// What of them lies on which CAD.
    pub association: &'a Association,
}

/// The mesh at one order: its connectivity, its straight and its curved coordinates, and the state of its boundary.
#[derive(Clone, Debug)]
pub struct Level<'a> {
    /// What is the same at every order.
    pub case: Case<'a>,
    /// Connectivity, and *straight* coordinates in its `mesh.points`: the targets.
    pub elevated: Elevated,
    /// *Curved* coordinates of all nodes.
    pub curved: Vec<DVec3>,
    /// State of the boundary nodes.
    pub wall: Wall,
    /// Nodes that are images of others.
    pub periodic: PeriodicConstraint,
}

impl<'a> Level<'a> {
    /// An elevated mesh that is still straight, its periodic pairs extended to the new nodes; and what a user should know of pairs
    /// that do not correspond.
    #[must_use]
    pub fn new(case: Case<'a>, mut elevated: Elevated) -> (Level<'a>, Vec<String>) {
        let (periodic, notes) = PeriodicConstraint::new(&mut elevated, case.settings.freeze_linear);
        if case.settings.surface {
            elevated.boundary_nodes = elevated.mesh.points().len();
        }
        let wall = Wall::new(&case.association.nodes, elevated.boundary_nodes);
        let curved = elevated.mesh.points().to_vec();
        (Level { case, elevated, curved, wall, periodic }, notes)
    }

    /// The connectivity; its points are the straight ones.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.elevated.mesh
    }

    /// Straight coordinates of all nodes.
    #[must_use]
    pub fn straight(&self) -> &[DVec3] {
        self.elevated.mesh.points()
    }

    /// Straight coordinates of the linear nodes: the reference of the certificate.
    #[must_use]
    pub fn linear(&self) -> &[DVec3] {
        &self.elevated.mesh.points()[..self.elevated.linear_nodes]
    }

    /// Where the wall's displacement puts a boundary node.
    #[must_use]
    pub fn displaced(&self, node: usize) -> DVec3 {
        self.straight()[node] + self.wall.displacement(node)
    }

    /// The plane of a plane mesh.
    #[must_use]
    pub fn plane(&self) -> Option<Plane> {
        self.case.boundary.plane
    }

    /// The plane that holds a node, if one does; in a plane mesh one that stands on it.
    #[must_use]
    pub fn plane_of(&self, node: usize) -> Option<Plane> {
        self.case.association.plane_of(self.wall.classification(node))
    }

    /// Whether a node lies on a curved wall: on a surface, curve or vertex, and not in a plane.
    #[must_use]
    pub fn on_curved_wall(&self, node: usize) -> bool {
        let classification = self.wall.classification(node);
        matches!(classification, Classification::Surface(_) | Classification::Curve(_) | Classification::Vertex(_))
            && self.case.association.plane_of(classification).is_none()
    }
}
