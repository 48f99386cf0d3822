//! Parts of a mesh file that number their nodes apart.

use super::NodeId;

/// A zone (CGNS) or block (PLOT3D).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Zone {
    /// The path by which linkage files refer to it: `/Base/zone`.
    pub name: String,
    /// The mesh's node of each of the zone's, in the zone's order; zones that touch share nodes.
    pub nodes: Vec<NodeId>,
}
