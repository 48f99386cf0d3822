//! Tight corners of wall faces: where two edges of a face leave a corner nearly along one line once they follow the CAD.
//!
//! Where two CAD curves join smoothly at a corner of a face, or an edge bends by as much as the face is wide, the face's area element
//! there goes to zero, and the better the edges follow their curves the nearer it comes. Its measure is
//! `q = (T_1 x T_2) . n / |c_1 x c_2|`: `T` the tangents of the edge polynomials at the corner, `c` the chords, `n` the CAD's normal. Nothing
//! inside the volume can change it; only nodes that slide along the edges can.

use rustc_hash::FxHashSet;

use super::corner::face_corners;
use crate::curve::level::Case;
use crate::curve::wall_state::Wall;
use crate::mesh::NodeId;
use crate::mesh::elevate::Elevated;

/// Corners with a smaller `q` are tight.
const TIGHT: f64 = 0.3;

/// The nodes inside the edges that meet at tight corners of faces on the CAD, as projected.
pub(super) fn tight_nodes(case: Case, elevated: &Elevated, wall: &Wall) -> FxHashSet<NodeId> {
    let mesh = &elevated.mesh;
    let at = |node: NodeId| mesh.points()[node.index()] + wall.displacement(node.index());
    // Nodes in planes go where the volume wants them.
    let is_held = |node: NodeId| case.association.plane_of(wall.classification(node.index())).is_none();
    let mut tight = FxHashSet::default();
    for corner in face_corners(case, mesh, &at, &is_held, TIGHT) {
        let nodes = case.boundary.nodes(corner.face, mesh);
        tight.extend(corner.arms.iter().flat_map(|arm| &arm[2..]).map(|&place| nodes[place]));
    }
    tight
}
