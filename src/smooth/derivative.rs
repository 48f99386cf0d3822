//! Derivatives of the objective by one node.

use glam::{DMat3, DVec3};

/// Gradient and Hessian block of the objective by one node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct NodeDerivative {
    pub(super) gradient: DVec3,
    pub(super) hessian: DMat3,
}

impl NodeDerivative {
    pub(super) const ZERO: NodeDerivative = NodeDerivative { gradient: DVec3::ZERO, hessian: DMat3::ZERO };
}
