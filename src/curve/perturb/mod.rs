//! Carrying the wall's displacement into the volume, equation (1).
//!
//! A node takes the displacement of its *foot* on the linear wall, times a factor that falls with the distance `d` to the
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
//! # The factor
//!
//! The paper's `min(1, |P| / d)` falls with slope -1 where `d = |P|`: a bulging wall squeezes the cells there to nothing,
//! and `|P|`, taken point by point, is no polynomial. Here the factor is `1 / (1 + (d / (5 R))^2)`, `R` the largest
//! displacement of the wall faces around the foot, linear between wall vertices; but no less than `0.6 L`, `L` the wall
//! faces' shortest edges: where columns lean (downstream of a sharp trailing edge by 1 : 8) a factor that falls within a few
//! sagittas falls within a layer. Measured on the weeble before any smoothing, min C_WCN / C_JAC (inverted elements):
//!
//! | factor | P2 | P4 |
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

//!
//! # Walls that are held
//!
//! A boundary face that is neither on the CAD nor in a plane stays straight, but for its rim, which lies on the CAD curve of the curved
//! patch beside it. It is a wall too: the layers over it follow it. Between the two kinds of wall the displacement is
//!
//! `u = w u_curved + (1 - w) u_held`, `w = d_held / (d_curved + d_held)`,
//!
//! `d` the distances along mesh edges. It is linear along a column from one wall to the other, so that every layer of a stack of height
//! `H` is squeezed alike, by `1 - P / H`: a decay that is steeper anywhere inverts a layer sooner. At the rim the two displacements are
//! the same, and so is `u`. Without it `--curve 2` on the weeble began with `C_JAC` -105 and ended with all 151 faces off the CAD.

mod between;
mod field;
mod roots;

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

use super::level::{Case, Level};
use crate::associate::Classification;
use crate::mesh::Boundary;
use crate::mesh::elevate::Elevated;
use between::{Between, Held};
use field::Field;
pub use field::WallFace;
use roots::Graph;

/// Positions of all nodes: boundary nodes displaced as given ([`Wall::displacements`](super::wall_state::Wall::displacements)), planes and
/// volume carried along.
#[must_use]
pub fn perturb(level: &Level, mut displacement: Vec<DVec3>) -> Vec<DVec3> {
    let Level { case: Case { boundary, association, .. }, elevated, wall: state, .. } = level;
    let planar = |classification: Classification| association.plane_of(classification).is_some();
    let curved = |classification: Classification| {
        matches!(classification, Classification::Surface(_)) && !planar(classification)
    };
    let linear = elevated.linear_nodes;
    let classification = |n: usize| state.classification(n);
    let mut wall = wall_faces(elevated, boundary, |f| curved(association.faces[f]));
    let mut straight = wall_faces(elevated, boundary, |f| association.faces[f] == Classification::Straight);
    let nodes = elevated.mesh.points().len();
    let moves = |face: &WallFace| face.nodes.iter().any(|n| displacement[n.index()] != DVec3::ZERO);
    if wall.is_empty() && straight.iter().any(moves) {
        wall = std::mem::take(&mut straight); // the rims of planes are all that is curved
    }
    if wall.is_empty() {
        displacement.resize(nodes, DVec3::ZERO);
        return sum(level, displacement);
    }

    let on = |faces: &[WallFace]| linear_nodes_on(faces, linear);
    let seeds = on(&wall);
    let planes = wall_faces(elevated, boundary, |f| planar(association.faces[f]));
    let graph = Graph::new(elevated);
    let mut all_seeds = graph.walls_of_their_own(|n| planar(classification(n)), &on(&planes));
    all_seeds.iter_mut().zip(&seeds).for_each(|(all, seed)| *all |= seed);
    let (roots, all_roots) = rayon::join(|| graph.roots(&seeds), || graph.roots(&all_seeds));
    let held = (!straight.is_empty()).then(|| Held::new(straight, on, &graph));
    drop(graph);

    let in_plane = |n: usize| n >= linear && planar(classification(n));
    let beyond = |n: usize| state.is_beyond_layers(n);
    let field = Field::new(elevated, &wall, &displacement, &seeds, roots, &[], beyond);
    let reach = field.reach_of_roots();
    let between =
        Between { curved: field, held: held.as_ref().map(|held| held.field(elevated, &displacement, beyond)) };
    let mut carried = carry(&between, elevated, displacement.clone(), in_plane);
    carried.par_iter_mut().enumerate().skip(linear).for_each(|(n, d)| {
        if let Some(plane) = level.plane_of(n) {
            *d = plane.closest(elevated.mesh.points()[n] + *d) - elevated.mesh.points()[n];
        }
    });
    drop(between);
    displacement = carried;
    level.periodic.carry(elevated.mesh.points(), &mut displacement);

    wall.extend(planes);
    let field = Field::new(elevated, &wall, &displacement, &all_seeds, all_roots, &reach, beyond);
    let between =
        Between { curved: field, held: held.as_ref().map(|held| held.field(elevated, &displacement, beyond)) };
    let mut whole = displacement.clone();
    whole.resize(nodes, DVec3::ZERO);
    let whole = carry(&between, elevated, whole, |n| classification(n) == Classification::Free);
    sum(level, whole)
}

/// The nodes of faces off the CAD that are carried along by the curved walls, between these and the other faces that stay straight, with their
/// displacements: those on no other boundary face, linear ones apart.
#[must_use]
pub(super) fn carried_along(level: &Level, faces: &FxHashSet<usize>) -> Vec<(usize, DVec3)> {
    let Level { case: Case { boundary, association, .. }, elevated, wall: state, .. } = level;
    let linear = elevated.linear_nodes;
    let mut follows = vec![false; elevated.boundary_nodes];
    let nodes_of = |face: usize| boundary.nodes(face, &elevated.mesh).iter().map(|n| n.index());
    faces.iter().flat_map(|&face| nodes_of(face)).for_each(|n| follows[n] = n >= linear);
    let others = (0..boundary.faces.len()).filter(|face| !faces.contains(face));
    others.flat_map(nodes_of).for_each(|n| follows[n] = false);

    let wall = wall_faces(elevated, boundary, |f| {
        matches!(association.faces[f], Classification::Surface(_))
            && association.plane_of(association.faces[f]).is_none()
    });
    let straight =
        wall_faces(elevated, boundary, |f| association.faces[f] == Classification::Straight && !faces.contains(&f));
    let on = |faces: &[WallFace]| linear_nodes_on(faces, linear);
    let (seeds, graph) = (on(&wall), Graph::new(elevated));
    let roots = graph.roots(&seeds);
    let held = (!straight.is_empty()).then(|| Held::new(straight, on, &graph));
    let displacement = state.displacements();
    let beyond = |n: usize| state.is_beyond_layers(n);
    let curved = Field::new(elevated, &wall, &displacement, &seeds, roots, &[], beyond);
    let between = Between { curved, held: held.as_ref().map(|held| held.field(elevated, &displacement, beyond)) };
    let follows = |n: usize| follows.get(n).is_some_and(|follows| *follows);
    let carried = carry(&between, elevated, displacement.clone(), follows);
    carried.into_iter().enumerate().filter(|(n, _)| follows(*n)).collect()
}

/// Marks the linear nodes of faces.
fn linear_nodes_on(faces: &[WallFace], linear_nodes: usize) -> Vec<bool> {
    let mut marked = vec![false; linear_nodes];
    faces.iter().flat_map(WallFace::corners).for_each(|n| marked[n.index()] = true);
    marked
}

/// Straight positions plus displacements, planes kept exactly.
fn sum(level: &Level, mut displacement: Vec<DVec3>) -> Vec<DVec3> {
    displacement.par_iter_mut().zip(level.straight()).enumerate().for_each(|(n, (position, straight))| {
        *position += *straight;
        if n >= level.elevated.linear_nodes {
            *position = level.plane_of(n).map_or(*position, |plane| plane.closest(*position));
        }
    });
    displacement
}

fn wall_faces(elevated: &Elevated, boundary: &Boundary, of: impl Fn(usize) -> bool) -> Vec<WallFace> {
    (0..boundary.faces.len())
        .filter(|&f| of(f))
        .map(|f| WallFace { cell: boundary.faces[f].cell, nodes: boundary.nodes(f, &elevated.mesh).to_vec() })
        .collect()
}

/// Displacements of all nodes: those that `follows` from the field, the others as given.
fn carry(
    field: &Between,
    elevated: &Elevated,
    given: Vec<DVec3>,
    follows: impl Fn(usize) -> bool + Sync,
) -> Vec<DVec3> {
    let mut result = given;
    let offset = elevated.linear_nodes;
    let (vertices, new) = result.split_at_mut(offset);
    vertices.par_iter_mut().enumerate().filter(|(n, _)| follows(*n)).for_each(|(n, d)| *d = field.at(&[n], &[1.0]));
    for carriers in &elevated.carriers {
        carriers.fill(new, offset, &|carrier, inside| {
            let (corners, first) = carriers.get(carrier);
            let mut ends = [0; 8];
            ends.iter_mut().zip(corners).for_each(|(end, corner)| *end = corner.index());
            for ((d, weights), node) in inside.iter_mut().zip(carriers.weights()).zip(first.index()..) {
                if follows(node) {
                    *d = field.at(&ends[..corners.len()], weights);
                }
            }
        });
    }
    result
}
