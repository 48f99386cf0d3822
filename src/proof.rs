//! What is proven of a curved mesh: that its elements are valid, and that its faces on the CAD do not fold.

use glam::DVec3;
use rustc_hash::FxHashSet;

use crate::associate::{Association, Boundary, Host};
use crate::certify::{self, Certificate, WallFace, Walls};
use crate::mesh::{Mesh, NodeId};

/// A mesh's certificate, and that of its faces on the CAD.
#[derive(Clone, Debug)]
pub struct Proof {
    /// Of the elements.
    pub certificate: Certificate,
    /// Of the faces on the CAD.
    pub walls: Walls,
}

impl Proof {
    /// Judges a mesh; `linear` are the places of its linear nodes before they were moved.
    #[must_use]
    pub fn of(mesh: &Mesh, linear: &[DVec3], boundary: &Boundary, association: &Association) -> Proof {
        let certificate = certify::mesh(mesh, Some(linear), &certify::Settings::default());
        Proof { certificate, walls: walls(mesh, linear, boundary, association, |_| true) }
    }

    /// Whether every element is proven valid and every face on the CAD free of folds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.certificate.holds() && self.walls.hold()
    }

    /// Numbers of the elements that are not proven valid or have a face that is not proven free of folds, rising.
    #[must_use]
    pub fn failing(&self, mesh: &Mesh, boundary: &Boundary) -> Vec<usize> {
        let mut failing: Vec<usize> = self.certificate.failures.iter().map(|judged| judged.element).collect();
        failing.extend(behind(mesh, boundary, &self.walls));
        failing.sort_unstable();
        failing.dedup();
        failing
    }
}

/// Judges those of the faces on the CAD that are `asked` for, by their index in [`Boundary::faces`].
pub(crate) fn walls(
    mesh: &Mesh,
    linear: &[DVec3],
    boundary: &Boundary,
    association: &Association,
    asked: impl Fn(usize) -> bool,
) -> Walls {
    let tied = |f: usize| matches!(association.faces[f], Host::Surface(_));
    let numbers: Vec<usize> = (0..boundary.faces.len()).filter(|&f| tied(f) && asked(f)).collect();
    let face = |f: usize| {
        let own = &boundary.faces[f];
        let points = mesh.points_of(boundary.nodes(f, mesh)).collect();
        let corners = boundary.corners[f].iter().map(|n| linear[n.index()]).collect();
        WallFace { cell: own.cell, order: mesh.order, points, corners }
    };
    certify::walls(&numbers, face, &certify::Settings::default())
}

/// Numbers of the elements behind faces that are not proven free of folds, rising.
pub(crate) fn behind(mesh: &Mesh, boundary: &Boundary, walls: &Walls) -> Vec<usize> {
    if walls.hold() {
        return Vec::new();
    }
    let faces: Vec<&[NodeId]> = walls.failures.iter().map(|own| &boundary.corners[own.face][..]).collect();
    let corners: FxHashSet<NodeId> = faces.iter().copied().flatten().copied().collect();
    let elements = mesh.blocks_of(3).flat_map(|(_, block)| block.elements(mesh.order));
    let has_face = |nodes: &[NodeId]| {
        nodes.iter().any(|n| corners.contains(n)) && faces.iter().any(|face| face.iter().all(|n| nodes.contains(n)))
    };
    elements.enumerate().filter(|(_, nodes)| has_face(nodes)).map(|(e, _)| e).collect()
}
