//! Faces that are off the CAD by more than the tolerance and run beside it all the same: walls of meshes in low precision, or made on a coarser CAD.

use std::collections::BTreeSet;

use cad::{EntityId, Evaluation, FaceId, Group, Model};
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::Doubt;
use super::faces::ALONG;
use crate::associate::Side;
use crate::associate::side::SMOOTH;
use crate::mesh::{Boundary, Mesh};

/// Corners of a face beside the CAD are nearer to it than this fraction of the face's shortest edge. Of its longest edge it would be more
/// than a thin cell is high: the sides of a stack of layers stand on a CAD face's edge, and would be beside that face.
const NEAR: f64 = 0.1;

/// Tells of faces that are off the CAD which of them run beside a CAD face that no mesh face lies on; and of those that are off it in part, which
/// run beside any.
///
/// Beside a CAD face with mesh faces of its own runs the outer boundary of a thin mesh, which is no part of the CAD.
pub(super) fn find(
    model: &Model,
    boundary: &Boundary,
    mesh: &Mesh,
    sides: &[Side],
    classifications: &[Option<Vec<FaceId>>],
    doubts: &mut [(usize, Doubt)],
) {
    let covered: BTreeSet<FaceId> = classifications.iter().flatten().flatten().copied().collect();
    let (covered, bare): (Vec<FaceId>, Vec<FaceId>) =
        model.faces().iter().map(|face| face.id).partition(|id| covered.contains(id));
    let [bare, covered] = [bare, covered].map(|faces| Group::of_faces(model, &faces).ok());
    let beside = |face: usize, (group, others): (&Option<Group>, &Option<Group>)| {
        let (side, group) = (&sides[face], group.as_ref()?);
        let (id, off) = over(group, side.middle, side.normal)?;
        let is_nearest = others.as_ref().is_none_or(|other| other.distance(side.middle) > off);
        let corners: Vec<DVec3> = mesh.points_of(&boundary.corners[face]).collect();
        let distance = corners.iter().map(|&x| group.distance(x)).fold(0.0, f64::max);
        let next = corners.iter().cycle().skip(1);
        let shortest = corners.iter().zip(next).map(|(a, b)| a.distance(*b)).fold(f64::INFINITY, f64::min);
        (distance <= NEAR * shortest && is_nearest).then_some(Doubt::Beside { on: id.into(), distance })
    };
    let found = |(face, doubt): &(usize, Doubt)| {
        let found = match doubt {
            Doubt::OffCad => beside(*face, (&bare, &covered)),
            Doubt::PartlyOffCad => beside(*face, (&bare, &covered)).or_else(|| beside(*face, (&covered, &bare))),
            _ => None,
        };
        found.map(|found| (*face, found))
    };
    let found: FxHashMap<usize, Doubt> = doubts.par_iter().filter_map(found).collect();
    let belongs = |face: usize| found.contains_key(&face) || classifications[face].is_some();
    for (face, doubt) in doubts.iter_mut() {
        if let Some(own) = found.get(face).filter(|_| most_neighbours(*face, boundary, sides, belongs)) {
            *doubt = own.clone();
        }
    }
}

/// Whether something holds of at least half of the faces in which a face goes on smoothly: a single face may run beside the CAD by chance.
fn most_neighbours(face: usize, boundary: &Boundary, sides: &[Side], holds: impl Fn(usize) -> bool) -> bool {
    let corners = &boundary.corners[face];
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    let edges = ends.filter_map(|(&a, &b)| boundary.edge([a, b]));
    let (mut count, mut holding) = (0, 0);
    for other in edges.flat_map(|edge| boundary.edge_faces[edge].iter().copied()) {
        if other != face && sides[other].normal.dot(sides[face].normal) >= SMOOTH {
            count += 1;
            holding += usize::from(holds(other));
        }
    }
    2 * holding >= count
}

/// The face of a group that a point stands over, off it along its normal, and how far; where the surface runs along the mesh face.
fn over(group: &Group, x: DVec3, along: DVec3) -> Option<(FaceId, f64)> {
    let foot = group.closest(x, None)?;
    let (EntityId::Face(id), Evaluation::Surface(at)) = (foot.entity, group.evaluate_at(&foot)?) else { return None };
    let (normal, off) = (at.normal?, x - foot.point);
    let is_over = off.dot(normal).abs() >= ALONG * off.length();
    (is_over && normal.dot(along).abs() >= ALONG).then_some((id, foot.distance))
}
