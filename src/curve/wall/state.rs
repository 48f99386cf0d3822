//! What is known of the nodes on the boundary.

use cad::Group;
use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::associate::{Association, Classification};

/// Classifications and places of all nodes after projection.
#[derive(Clone, Debug)]
pub struct Projected {
    /// Classification of every node up to [`Elevated::boundary_nodes`]; the nodes after them are free.
    pub classifications: Vec<Classification>,
    /// Displacement of every boundary node from its straight place to its CAD group; zero for the others, as many as classifications.
    pub displacement: Vec<DVec3>,
    /// By boundary node, the size of the edge or face that it lies inside; of a linear node's edges, the shortest.
    pub sizes: FxHashMap<usize, f64>,
    /// Linear nodes beyond the layers that may be curved, by node; empty where there is no such limit.
    pub beyond: Vec<bool>,
    /// How many closest points were asked for to place nodes.
    pub projections: usize,
    /// How many of them are not proven to be the closest.
    pub unproven: usize,
}

impl Projected {
    /// The classification of any node.
    #[must_use]
    pub fn classification(&self, node: usize) -> Classification {
        self.classifications.get(node).copied().unwrap_or(Classification::Free)
    }
}

/// The CAD that holds a classification's nodes.
pub(crate) fn group_of(association: &Association, classification: Classification) -> Option<&Group> {
    match classification {
        Classification::Surface(surface) => Some(&association.surfaces[surface].group),
        Classification::Curve(curve) => Some(&association.curves[curve].group),
        _ => None,
    }
}
