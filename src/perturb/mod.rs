//! Carrying the wall's displacement into the volume, equation (1).
//!
//! A node takes the displacement of its *foot* on the linear wall, times a share that falls with the distance `d` to the
//! foot. Two feet are used:
//!
//! * **Roots.** Every linear node has a root, the wall vertex nearest to it along mesh edges. Where the roots of a
//!   node's carrier (the edge, face or cell that it lies in) are corners of one wall face, the foot is the same
//!   barycentric combination of the roots. A layer then moves as one, whatever else is near; in a concave corner the
//!   closest point of the wall jumps from side to side within a layer, and tears it.
//! * **The closest point** of the linear wall, exact, where the roots form no wall face.
//!
//! The displacement is the wall polynomial at the foot. Taking it from the nearest wall node instead is wrong by many
//! times the wall spacing.
//!
//! # The share
//!
//! The paper's `min(1, |P| / d)` falls with slope -1 where `d = |P|`: a bulging wall squeezes the cells there to nothing,
//! and `|P|`, taken point by point, is no polynomial. Here the share is `1 / (1 + (d / (5 R))^2)`, `R` the largest
//! displacement of the wall faces around the foot, linear between wall vertices; but no less than `0.6 L`, `L` the wall
//! faces' shortest edges: where columns lean (downstream of a sharp trailing edge by 1 : 8) a share that falls within a few
//! sagittas falls within a layer. Measured on the weeble before any smoothing, min C_WCN / C_JAC (inverted elements):
//!
//! | share | P2 | P4 |
//! |---|---|---|
//! | `min(1, P/d)`, the paper's | -0.04 / -1.10 (1245) | -0.21 / -7.9 (2744) |
//! | `min(1, 4 P/d)` | 0.89 / 0.35 (0) | 0.76 / -0.85 (880) |
//! | `min(1, 4 R/d)` | 0.88 / 0.32 (0) | 0.83 / -0.10 (1) |
//! | `max(0, 1 - d/(10 R))` | 0.94 / 0.57 (0) | 0.89 / 0.61 (0) |
//! | `exp(-(d/(6 R))^2)` | 0.94 / 0.51 (0) | 0.91 / 0.58 (0) |
//! | `1 / (1 + (d/(5 R))^2)` | 0.94 / 0.53 (0) | 0.91 / 0.57 (0) |
//!
//! The straight hat starts as well, but its kinks cut through cells of high order.

//!
//! # Planes
//!
//! Planar patches (symmetry planes, caps, the base of a nozzle) have no displacement of their own, but the cells on them
//! follow their curved edges. So their nodes are carried first, in their planes, by the curved walls; the volume then
//! by curved walls and planes. A vertex of a plane counts as a wall of its own, for roots, where the shortest mesh edge at it
//! leaves the plane, as at a wing's cap; at a symmetry plane the layers lie in the plane and keep their roots on the wing.

mod field;
mod roots;

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use crate::associate::{Association, Boundary, Host};
use crate::elevate::{Carriers, Elevated};
use crate::mesh::NodeId;
use crate::periodic::Ties;
use crate::project::Projected;
use field::Field;
pub use field::WallFace;

/// Carriers whose nodes are carried at a time: what they take while they wait does not grow with the mesh.
const BATCH: usize = 1 << 16;

/// Places of all nodes: boundary nodes where projection put them, planes and volume carried along.
#[must_use]
pub fn perturb(
    elevated: &Elevated,
    boundary: &Boundary,
    association: &Association,
    projected: &Projected,
    ties: &Ties,
) -> Vec<DVec3> {
    let planar = |host: Host| association.plane_of(host).is_some();
    let curved = |host: Host| matches!(host, Host::Surface(_)) && !planar(host);
    let linear = elevated.linear_nodes;
    let host = |n: usize| projected.host(n);
    let mut wall = wall_faces(elevated, boundary, |f| curved(association.faces[f]));
    let mut displacement = projected.displacement.clone();
    let nodes = elevated.mesh.points.len();
    if wall.is_empty() {
        displacement.resize(nodes, DVec3::ZERO);
        return sum(elevated, association, projected, displacement);
    }

    let mut seeds = vec![false; linear];
    wall.iter().flat_map(WallFace::corners).for_each(|n| seeds[n.index()] = true);
    let in_plane = |n: usize| n >= linear && planar(host(n));
    let field = Field::new(elevated, &wall, &displacement, &seeds, &[], &projected.beyond);
    let reach = field.reach_of_roots();
    let mut carried = carry(&field, elevated, displacement.clone(), in_plane);
    for (n, d) in carried.iter_mut().enumerate().skip(linear) {
        if let Some(plane) = association.plane_of(host(n)) {
            *d = plane.closest(elevated.mesh.points[n] + *d) - elevated.mesh.points[n];
        }
    }
    displacement = carried;
    ties.carry(&elevated.mesh.points, &mut displacement);

    let planes = wall_faces(elevated, boundary, |f| planar(association.faces[f]));
    let mut on_plane = vec![false; linear];
    planes.iter().flat_map(WallFace::corners).for_each(|n| on_plane[n.index()] = true);
    let own_wall = roots::walls_of_their_own(elevated, |n| planar(host(n)), &on_plane);
    for (seed, own) in seeds.iter_mut().zip(own_wall) {
        *seed |= own;
    }
    wall.extend(planes);
    let field = Field::new(elevated, &wall, &displacement, &seeds, &reach, &projected.beyond);
    let mut whole = displacement.clone();
    whole.resize(nodes, DVec3::ZERO);
    let whole = carry(&field, elevated, whole, |n| host(n) == Host::Free);
    sum(elevated, association, projected, whole)
}

/// Straight places plus displacements, planes kept exactly.
fn sum(
    elevated: &Elevated,
    association: &Association,
    projected: &Projected,
    mut displacement: Vec<DVec3>,
) -> Vec<DVec3> {
    for (n, (place, straight)) in displacement.iter_mut().zip(&elevated.mesh.points).enumerate() {
        *place += *straight;
        if n >= elevated.linear_nodes {
            *place = association.plane_of(projected.host(n)).map_or(*place, |plane| plane.closest(*place));
        }
    }
    displacement
}

fn wall_faces(elevated: &Elevated, boundary: &Boundary, of: impl Fn(usize) -> bool) -> Vec<WallFace> {
    (0..boundary.faces.len())
        .filter(|&f| of(f))
        .map(|f| {
            let face = &boundary.faces[f];
            let block = &elevated.mesh.blocks[face.block];
            let stride = block.stride(elevated.mesh.order);
            WallFace { cell: face.cell, nodes: block.nodes[face.element * stride..][..stride].to_vec() }
        })
        .collect()
}

/// Displacements of all nodes: those that `follows` from the field, the others as given.
fn carry(field: &Field, elevated: &Elevated, given: Vec<DVec3>, follows: impl Fn(usize) -> bool + Sync) -> Vec<DVec3> {
    let mut result = given;
    let vertices: Vec<DVec3> = (0..elevated.linear_nodes)
        .into_par_iter()
        .map(|n| if follows(n) { field.at(&[n], &[1.0]) } else { result[n] })
        .collect();
    result[..elevated.linear_nodes].copy_from_slice(&vertices);
    for carriers in &elevated.carriers {
        for first in (0..carriers.len()).step_by(BATCH) {
            let batch = first..carriers.len().min(first + BATCH);
            carry_inside(field, carriers, batch, &follows, &mut result);
        }
    }
    result
}

/// Displacements of the nodes inside some edges, faces or cells of one kind.
fn carry_inside(
    field: &Field,
    carriers: &Carriers,
    batch: Range<usize>,
    follows: &(impl Fn(usize) -> bool + Sync),
    result: &mut [DVec3],
) {
    let inside = |first: NodeId| first.index()..first.index() + carriers.inside();
    let own: Vec<Vec<DVec3>> = batch
        .clone()
        .into_par_iter()
        .with_min_len(256)
        .map(|carrier| {
            let (corners, first) = carriers.get(carrier);
            if !inside(first).any(follows) {
                return Vec::new();
            }
            let corners: Vec<usize> = corners.iter().map(|c| c.index()).collect();
            carriers.weights().iter().map(|weights| field.at(&corners, weights)).collect()
        })
        .collect();
    for (carrier, own) in batch.zip(own) {
        for (node, d) in inside(carriers.get(carrier).1).zip(own) {
            if follows(node) {
                result[node] = d;
            }
        }
    }
}
