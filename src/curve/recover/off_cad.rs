//! The wall faces that recovery leaves off the CAD.

use crate::associate::Classification;
use crate::curve::level::Level;
use crate::element::Order;

/// A boundary face that was taken off the CAD so that the elements behind it are valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffCadFace {
    /// Its index in [`Boundary::faces`](crate::mesh::Boundary::faces).
    pub face: usize,
    /// The fraction of its way from the fallback to the CAD at which it is, 0 to 1: the least of its nodes.
    pub fraction: f64,
    /// Order of the fallback.
    pub order: Order,
}

/// The faces on the CAD by their classification that have a node which is off it; `order` is that of the fallback, `fraction` tells how
/// far each node is on its way from there.
#[must_use]
pub fn off_cad_faces(level: &Level, order: Order, fraction: impl Fn(usize) -> f64) -> Vec<OffCadFace> {
    let (boundary, association) = (level.case.boundary, level.case.association);
    let mut faces = Vec::new();
    for face in 0..boundary.faces.len() {
        let nodes = boundary.nodes(face, level.mesh());
        let fraction = nodes.iter().map(|n| fraction(n.index())).fold(1.0, f64::min);
        if fraction < 1.0 && matches!(association.faces[face], Classification::Surface(_)) {
            faces.push(OffCadFace { face, fraction, order });
        }
    }
    faces
}
