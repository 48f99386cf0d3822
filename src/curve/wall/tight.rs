//! Tight corners of wall faces: where two edges of a face leave a corner nearly along one line once they follow the CAD.
//!
//! Where two CAD curves join smoothly at a corner of a face, or an edge bends by as much as the face is wide, the face's area element
//! there goes to zero, and the better the edges follow their curves the nearer it comes. Its measure is
//! `q = (T_1 x T_2) . n / |c_1 x c_2|`: `T` the tangents of the edge polynomials at the corner, `c` the chords, `n` the CAD's normal. Nothing
//! inside the volume can change it; only nodes that slide along the edges can.

use glam::DVec3;
use rustc_hash::FxHashSet;

use crate::associate::normal_at;
use crate::curve::level::Case;
use crate::curve::wall_state::Wall;
use crate::element::{Cell, Order, basis, edge_nodes};
use crate::mesh::NodeId;
use crate::mesh::elevate::Elevated;

/// Corners with a smaller `q` are tight.
const TIGHT: f64 = 0.3;
/// Where the linear face's normal gives a larger `q`, the CAD is not asked for its own.
const CLEAR: f64 = 0.6;

/// The nodes inside the edges that meet at tight corners of faces on the CAD, as projected.
pub(super) fn tight_nodes(case: Case, elevated: &Elevated, wall: &Wall) -> FxHashSet<NodeId> {
    let (mesh, order) = (&elevated.mesh, elevated.mesh.order());
    let at = |node: NodeId| mesh.points()[node.index()] + wall.displacement(node.index());
    // Nodes in planes go where the volume wants them.
    let is_held = |node: NodeId| case.association.plane_of(wall.classification(node.index())).is_none();
    let slopes = end_slopes(order);
    let mut tight = FxHashSet::default();
    for (face, own) in case.boundary.faces.iter().enumerate() {
        let Some(group) = case.association.group_of(case.association.faces[face]) else { continue };
        let nodes = case.boundary.nodes(face, mesh);
        let edges = edge_nodes(own.cell, order);
        for corner in 0..own.cell.corner_count() {
            let mut arms = edges.iter().filter_map(|edge| arm(edge, corner)).filter(|arm| is_held(nodes[arm[2]]));
            let (Some(one), Some(other)) = (arms.next(), arms.next()) else { continue };
            let tangent = |arm: &[usize]| -> DVec3 { arm.iter().zip(&slopes).map(|(&n, &s)| at(nodes[n]) * s).sum() };
            let chord = |arm: &[usize]| at(nodes[arm[1]]) - at(nodes[arm[0]]);
            let (flat, bent) = (chord(&one).cross(chord(&other)), tangent(&one).cross(tangent(&other)));
            let q = |normal: DVec3| bent.dot(normal) / flat.length();
            let Some(linear) = flat.try_normalize() else { continue };
            if q(linear) > CLEAR {
                continue;
            }
            let cad = normal_at(group, at(nodes[corner])).map(|normal| normal * normal.dot(linear).signum());
            if q(cad.unwrap_or(linear)) < TIGHT {
                tight.extend(one[2..].iter().chain(&other[2..]).map(|&n| nodes[n]));
            }
        }
    }
    tight
}

/// An edge's nodes, both ends first, as seen from a corner at its end.
fn arm(edge: &[usize], corner: usize) -> Option<Vec<usize>> {
    let mut nodes = edge.to_vec();
    if edge[1] == corner {
        nodes.swap(0, 1);
        nodes[2..].reverse();
    }
    (nodes[0] == corner).then_some(nodes)
}

/// Weights of an edge's nodes in the polynomial's derivative at its first end.
fn end_slopes(order: Order) -> Vec<f64> {
    let start = Cell::Line.corners()[0].map(f64::from);
    basis::gradients(Cell::Line, order, start).into_iter().map(|slope| slope[0]).collect()
}
