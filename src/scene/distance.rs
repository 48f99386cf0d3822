//! How far the boundary of a mesh is from something, face by face.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::surface::Surface;
use crate::element::{Cell, Order, Samples, basis};
use crate::mesh::{FaceKey, Mesh, NodeId};

/// Divisions of a face, in multiples of p, at which its distance is sampled.
const DENSITY: usize = 3;

/// The points of a boundary face at which its distance is taken: (3p)^2, or 3p of a line.
#[must_use]
pub fn samples(mesh: &Mesh, cell: Cell, nodes: &[NodeId]) -> Vec<DVec3> {
    let order = mesh.order();
    let samples = Samples::survey(cell, Order::LINEAR, DENSITY * order.get());
    let point = |&at: &_| {
        let values = basis::values(cell, order, at);
        nodes.iter().zip(values).map(|(n, v)| mesh.points()[n.index()] * v).sum()
    };
    samples.points()[..samples.count()].iter().map(point).collect()
}

/// The largest of each boundary face, by its corners; `distances` are those of points.
#[must_use]
pub fn face_distances(mesh: &Mesh, distances: impl Fn(&[DVec3]) -> Vec<f64> + Sync) -> FxHashMap<FaceKey, f64> {
    let surface = Surface::of(mesh);
    let faces = surface.faces.par_iter().map(|face| {
        let far = distances(&samples(mesh, face.cell, &face.nodes)).into_iter().fold(0.0, f64::max);
        (FaceKey::new(&face.nodes[..face.cell.corner_count()]), far)
    });
    faces.collect()
}
