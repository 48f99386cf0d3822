//! Where cells are looked at from: those of a plane mesh in its plane, whose normal is taken for z; faces that lie in no plane each along
//! its own mean normal.

use glam::{DMat3, DVec3};

use super::derivative::NodeDerivative;
use crate::certify::mean_normal;
use crate::mesh::Mesh;

/// The coordinates in which the kernels see elements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct View {
    /// The normal of a plane mesh.
    pub(super) normal: Option<DVec3>,
    /// What turns it to z; `None` where nothing need be turned.
    turn: Option<DMat3>,
    /// Whether every face has a view of its own.
    by_face: bool,
}

impl View {
    /// The view of a mesh with its nodes at these positions.
    pub(super) fn of(mesh: &Mesh, positions: &[DVec3]) -> View {
        match mesh.plane(positions) {
            Some(plane) => View::along(plane.normal),
            None => View { by_face: mesh.dimension() == 2, ..View::default() },
        }
    }

    /// The view along a unit normal.
    fn along(normal: DVec3) -> View {
        let turn = |normal: DVec3| {
            let first = normal.any_orthonormal_vector();
            DMat3::from_cols(first, normal.cross(first), normal).transpose()
        };
        View { normal: Some(normal), turn: Some(normal).filter(|&normal| normal != DVec3::Z).map(turn), by_face: false }
    }

    /// The view of one element with these straight corners.
    pub(super) fn of_element(&self, corners: &[DVec3]) -> View {
        let normal = if self.by_face { mean_normal(corners) } else { DVec3::ZERO };
        if normal == DVec3::ZERO { *self } else { View::along(normal) }
    }

    /// Turns vectors of space to those of the kernels.
    pub(super) fn turn(&self, vectors: &mut [DVec3]) {
        if let Some(turn) = self.turn {
            vectors.iter_mut().for_each(|v| *v = turn * *v);
        }
    }

    /// A vector of space from one of the kernels.
    pub(super) fn back(&self, v: DVec3) -> DVec3 {
        self.turn.map_or(v, |turn| turn.transpose() * v)
    }

    /// Derivatives by a node's place in space from those that the kernels give.
    pub(super) fn derivative(&self, own: NodeDerivative) -> NodeDerivative {
        let Some(turn) = self.turn else { return own };
        let back = turn.transpose();
        NodeDerivative { gradient: back * own.gradient, hessian: back * own.hessian * turn }
    }
}
