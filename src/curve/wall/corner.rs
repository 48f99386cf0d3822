//! The edges that leave a corner of a face or element, and how much room their tangents leave between them.

use glam::DVec3;

use crate::associate::normal_at;
use crate::curve::level::Case;
use crate::element::{Cell, Order, basis, edge_nodes};
use crate::mesh::{Mesh, NodeId};

/// Where the linear face's normal gives a larger `q`, the CAD is not asked for its own.
const CLEAR: f64 = 0.6;

/// The edges of elements of one order, as seen from their corners.
pub(in crate::curve) struct Arms {
    order: Order,
    /// Weights of an edge's nodes in the polynomial's derivative at its first end.
    end_slopes: Vec<f64>,
}

impl Arms {
    pub(in crate::curve) fn new(order: Order) -> Arms {
        let start = Cell::Line.corners()[0].map(f64::from);
        let slopes = basis::gradients(Cell::Line, order, start).into_iter();
        Arms { order, end_slopes: slopes.map(|slope| slope[0]).collect() }
    }

    /// The edges that leave a corner of a cell, as places of their nodes: the corner, the other end, then the inner ones from the corner on.
    pub(in crate::curve) fn at(&self, cell: Cell, corner: usize) -> impl Iterator<Item = Vec<usize>> + use<> {
        edge_nodes(cell, self.order).iter().filter_map(move |edge| {
            let mut nodes = edge.clone();
            if edge[1] == corner {
                nodes.swap(0, 1);
                nodes[2..].reverse();
            }
            (nodes[0] == corner).then_some(nodes)
        })
    }

    /// The tangent of an edge polynomial at the corner that it leaves.
    pub(in crate::curve) fn tangent(&self, arm: &[usize], nodes: &[NodeId], at: &dyn Fn(NodeId) -> DVec3) -> DVec3 {
        arm.iter().zip(&self.end_slopes).map(|(&place, &slope)| at(nodes[place]) * slope).sum()
    }
}

/// The chord of an edge, from the corner that it leaves.
pub(in crate::curve) fn chord(arm: &[usize], nodes: &[NodeId], at: &dyn Fn(NodeId) -> DVec3) -> DVec3 {
    at(nodes[arm[1]]) - at(nodes[arm[0]])
}

/// A corner of a face on the CAD.
pub(in crate::curve) struct FaceCorner {
    /// The face, by index in [`Boundary::faces`](crate::mesh::Boundary::faces).
    pub(in crate::curve) face: usize,
    /// Room between the tangents of its edges, in that between their chords: `q = (T_1 x T_2) . n / |c_1 x c_2|`, `n` the CAD's normal.
    pub(in crate::curve) q: f64,
    /// Its edges, as places of their nodes in the face.
    pub(in crate::curve) arms: [Vec<usize>; 2],
}

/// Corners of faces on the CAD with a `q` below a bound, the nodes `at` their places; the nodes of both edges must be held.
pub(in crate::curve) fn face_corners(
    case: Case,
    mesh: &Mesh,
    at: &dyn Fn(NodeId) -> DVec3,
    is_held: &dyn Fn(NodeId) -> bool,
    bound: f64,
) -> Vec<FaceCorner> {
    let arms = Arms::new(mesh.order());
    let mut corners = Vec::new();
    for (face, own) in case.boundary.faces.iter().enumerate() {
        let Some(group) = case.association.group_of(case.association.faces[face]) else { continue };
        let nodes = case.boundary.nodes(face, mesh);
        let corners_of = &nodes[..own.cell.corner_count()];
        let middle = corners_of.iter().map(|&node| at(node)).sum::<DVec3>() / corners_of.len() as f64;
        for corner in 0..own.cell.corner_count() {
            let mut held = arms.at(own.cell, corner).filter(|arm| is_held(nodes[arm[2]]));
            let (Some(one), Some(other)) = (held.next(), held.next()) else { continue };
            let flat = chord(&one, nodes, at).cross(chord(&other, nodes, at));
            let bent = arms.tangent(&one, nodes, at).cross(arms.tangent(&other, nodes, at));
            let q = |normal: DVec3| bent.dot(normal) / flat.length();
            let Some(linear) = flat.try_normalize() else { continue };
            if q(linear) > CLEAR {
                continue;
            }
            // At a sharp bend the CAD's normal at the corner may lean by more than 90 degrees off the face: its sign is told in the middle.
            let sign = normal_at(group, middle).map_or(1.0, |normal| normal.dot(linear).signum());
            let q = q(normal_at(group, at(nodes[corner])).map_or(linear, |normal| normal * sign));
            if q < bound {
                corners.push(FaceCorner { face, q, arms: [one, other] });
            }
        }
    }
    corners
}
