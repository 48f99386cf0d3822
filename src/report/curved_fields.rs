//! Fields of a curved mesh: what was done to it, and how far it is from the CAD.

use rayon::prelude::*;

use super::distance::distance;
use super::fields::{field, measure_fields};
use crate::associate::Classification;
use crate::curve::Curved;
use crate::curve::layers::{layers, straight_elements};
use crate::curve::recover::Departure;
use crate::formats::{Field, Places, Support, Values};
use crate::mesh::NodeId;
use crate::scene::Measures;

/// The measures, whether each cell is straight and its layer, the displacement of each node, and of wall nodes and boundary faces how they lie
/// on the CAD.
#[must_use]
pub fn fields(curved: &Curved, measures: &Measures) -> Vec<Field> {
    let mesh = &curved.mesh;
    let whole = |values: Vec<usize>| Values::Integer(values.into_iter().map(|value| value as i64).collect());
    let straight = straight_elements(mesh, &curved.straight).into_iter().map(usize::from).collect();
    let moved = mesh.points().iter().zip(&curved.straight).map(|(x, straight)| (*x - *straight).to_array());
    let mut fields = vec![
        field("straight", Support::Elements, whole(straight)),
        field("layer", Support::Elements, whole(layers(mesh, &curved.boundary, &curved.association))),
        field("displacement", Support::Points, Values::Vectors(moved.collect())),
        field("cad_distance", Support::Points, Values::Real(distances_of_nodes(curved))),
    ];
    fields.extend(side_fields(curved));
    fields.extend(measure_fields(mesh, measures));
    fields
}

/// The largest distance of each wall node from the CAD that the faces at it are associated with; NaN for others.
fn distances_of_nodes(curved: &Curved) -> Vec<f64> {
    let mut on: Vec<(NodeId, usize)> = Vec::new();
    for (face, classification) in curved.association.faces.iter().enumerate() {
        if let Classification::Surface(surface) = classification {
            on.extend(curved.boundary.nodes(face, &curved.mesh).iter().map(|&node| (node, *surface)));
        }
    }
    on.sort_unstable();
    on.dedup();
    let far = |&(node, surface): &(NodeId, usize)| {
        curved.association.surfaces[surface].group.distance(curved.mesh.points()[node.index()])
    };
    let far: Vec<f64> = on.par_iter().map(far).collect();
    let mut distances = vec![f64::NAN; curved.mesh.points().len()];
    on.iter().zip(far).for_each(|((node, _), far)| distances[node.index()] = distances[node.index()].max(far));
    distances
}

/// Of boundary faces: the number of their CAD face (the least of a group; -1 for none), their largest distance from it, whether they are off
/// it (1 taken back, 2 released), and by what fraction they are.
fn side_fields(curved: &Curved) -> Vec<Field> {
    let (boundary, association) = (&curved.boundary, &curved.association);
    let support = if boundary.is_of_cells(&curved.mesh) {
        Support::Elements
    } else {
        Support::Sides(Places::new(boundary.corners.iter().map(Vec::as_slice)))
    };
    let group = |on: &Classification| match on {
        Classification::Surface(surface) => {
            let entities = association.surfaces[*surface].group.entities().iter().map(|own| own.tag());
            entities.min().map_or(-1, i64::from)
        }
        _ => -1,
    };
    let faces = boundary.faces.len();
    let far = (0..faces).into_par_iter().map(|face| distance(curved, face).map_or(f64::NAN, |own| own.max)).collect();
    let (mut off, mut fraction) = (vec![0; faces], vec![0.0; faces]);
    for own in &curved.off_cad {
        off[own.face] = if own.departure == Departure::Released { 2 } else { 1 };
        fraction[own.face] = own.fraction().map_or(f64::NAN, |kept| 1.0 - kept);
    }
    [
        ("cad_face", Values::Integer(association.faces.iter().map(group).collect())),
        ("cad_distance_of_face", Values::Real(far)),
        ("off_cad", Values::Integer(off)),
        ("off_cad_fraction", Values::Real(fraction)),
    ]
    .map(|(name, values)| field(name, support.clone(), values))
    .into()
}
