//! The boundary faces that are not on the CAD though they belong to it, as a mesh to look at.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::distance::distance;
use crate::associate::OpenFace;
use crate::curve::Curved;
use crate::element::Order;
use crate::formats::{Field, Support, Values};
use crate::mesh::{Boundary, Entity, EntityKey, Inconsistent, Mesh, NodeId, Parts, PhysicalName};

/// Why faces that were released or taken back are not on the CAD.
const OFF: &str = "off the CAD for valid elements";

/// A face that is not on the CAD.
struct LeftOpen {
    /// By index in [`Boundary::faces`].
    face: usize,
    cause: &'static str,
    /// How far it is from the CAD, where that is known.
    distance: Option<f64>,
}

/// The faces of a curved mesh that are off the CAD or undecided, as linear ones: one group of elements a cause, which is its name, and the
/// field `cad_distance` (NaN where it is not known).
///
/// # Errors
/// [`Inconsistent`]: too many.
pub fn left_open(curved: &Curved) -> Result<(Mesh, Vec<Field>), Inconsistent> {
    let far = |face: usize| distance(curved, face).map(|own| own.max);
    let off = curved.off_cad.iter().map(|off| LeftOpen { face: off.face, cause: OFF, distance: far(off.face) });
    drawn(&curved.mesh, &curved.boundary, off.chain(open(&curved.open_faces)).collect())
}

/// The same of a linear mesh: the faces that are undecided.
///
/// # Errors
/// As [`left_open`].
pub fn undecided(mesh: &Mesh, boundary: &Boundary, faces: &[OpenFace]) -> Result<(Mesh, Vec<Field>), Inconsistent> {
    drawn(mesh, boundary, open(faces).collect())
}

fn open(faces: &[OpenFace]) -> impl Iterator<Item = LeftOpen> {
    faces.iter().map(|open| LeftOpen { face: open.face, cause: open.doubt.kind(), distance: open.doubt.distance() })
}

fn drawn(mesh: &Mesh, boundary: &Boundary, faces: Vec<LeftOpen>) -> Result<(Mesh, Vec<Field>), Inconsistent> {
    let mut causes: BTreeMap<&str, Vec<&LeftOpen>> = BTreeMap::new();
    faces.iter().for_each(|own| causes.entry(own.cause).or_default().push(own));
    let mut parts = Parts { order: Order::LINEAR, ..Parts::default() };
    let (mut places, mut distances) = (FxHashMap::default(), Vec::new());
    let dimension = if boundary.plane.is_some() { 1 } else { 2 };
    for ((cause, mut faces), tag) in causes.into_iter().zip(1..) {
        let key = EntityKey::new(dimension, tag);
        faces.sort_by_key(|own| boundary.corners[own.face].len()); // elements are numbered block by block
        for own in faces {
            let mut nodes = Vec::new();
            for &node in &boundary.corners[own.face] {
                let next = NodeId::new(parts.points.len())?;
                let id = *places.entry(node).or_insert(next);
                if id == next {
                    parts.points.push(mesh.points()[node.index()]);
                }
                nodes.push(id);
            }
            parts.push(boundary.faces[own.face].cell, key, &nodes);
            distances.push(own.distance.unwrap_or(f64::NAN));
        }
        parts.entities.push(Entity { key, bounds: [[0.0; 3]; 2], physical_tags: vec![tag], boundary: Vec::new() });
        parts.physical_names.push(PhysicalName { dimension, tag, name: cause.to_owned() });
    }
    let field = Field { name: "cad_distance".to_owned(), support: Support::Elements, values: Values::Real(distances) };
    Ok((Mesh::new(parts)?, vec![field]))
}
