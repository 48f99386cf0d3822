//! The wall faces that recovery leaves off the CAD.

use crate::associate::Classification;
use crate::curve::level::Level;
use crate::element::Order;

/// A boundary face that is off the CAD so that the elements behind it are valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffCadFace {
    /// Its index in [`Boundary::faces`](crate::mesh::Boundary::faces).
    pub face: usize,
    /// How it left the CAD.
    pub departure: Departure,
}

/// How a face left the CAD.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Departure {
    /// Nodes of it that are not linear ones were released, and moved as little as the elements behind it ask.
    Released,
    /// It was taken back towards a mesh that is known to be valid.
    Back {
        /// The fraction of its way from there to the CAD at which it is, 0 to 1: the least of its nodes.
        fraction: f64,
        /// Order of that mesh; linear where it is the straight one.
        order: Order,
    },
}

impl OffCadFace {
    /// The fraction of its way from the fallback to the CAD at which a face is that was taken back.
    #[must_use]
    pub fn fraction(&self) -> Option<f64> {
        match self.departure {
            Departure::Released => None,
            Departure::Back { fraction, .. } => Some(fraction),
        }
    }

    /// Order of the fallback of a face that was taken back.
    #[must_use]
    pub fn order(&self) -> Option<Order> {
        match self.departure {
            Departure::Released => None,
            Departure::Back { order, .. } => Some(order),
        }
    }
}

/// The faces on the CAD by their classification that have a node which is off it; `order` is that of the fallback, `fraction` tells how
/// far each node is on its way from there.
#[must_use]
pub fn off_cad_faces(level: &Level, order: Order, fraction: impl Fn(usize) -> f64) -> Vec<OffCadFace> {
    let Level { case, wall, .. } = level;
    let mut faces = Vec::new();
    for face in 0..case.boundary.faces.len() {
        if !matches!(case.association.faces[face], Classification::Surface(_)) {
            continue;
        }
        let nodes = case.boundary.nodes(face, level.mesh());
        let fraction = nodes.iter().map(|n| fraction(n.index())).fold(1.0, f64::min);
        if fraction < 1.0 {
            faces.push(OffCadFace { face, departure: Departure::Back { fraction, order } });
        } else if nodes.iter().any(|n| wall.is_released(n.index())) {
            faces.push(OffCadFace { face, departure: Departure::Released });
        }
    }
    faces
}
