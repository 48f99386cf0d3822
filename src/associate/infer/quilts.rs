//! CAD faces that go on smoothly in one another, for mesh faces that no single one holds.

use std::collections::{BTreeMap, BTreeSet};

use cad::{FaceId, Group, Model};

use super::Doubt;
use super::faces::{ALONG, BULGE};
use super::incidence::Incidence;
use crate::associate::joint::{SHARP, normal_at};
use crate::associate::{Joints, Side};
use crate::mesh::Boundary;

/// The CAD faces of every mesh face, ascending, and the doubts that are left.
type Hosts = (Vec<Option<Vec<FaceId>>>, Vec<(usize, Doubt)>);

/// Puts faces without a CAD face of their own on several together. Where a quilt is needed, all its mesh faces go on all its CAD faces, so
/// that no host ends in the middle of a smooth surface.
pub(super) fn join(
    boundary: &Boundary,
    model: &Model,
    joints: &Joints<'_>,
    incidence: &Incidence,
    sides: &[Side],
    decided: Vec<Result<FaceId, Doubt>>,
) -> Hosts {
    let open = decided.iter().filter(|outcome| **outcome == Err(Doubt::NoCommonFace)).count();
    let quilt_of = if open == 0 { Vec::new() } else { quilts(model, joints) };
    let mut members: BTreeMap<usize, BTreeSet<FaceId>> = BTreeMap::new();
    let mut spans: BTreeMap<usize, usize> = BTreeMap::new();
    for (face, _) in decided.iter().enumerate().filter(|(_, outcome)| **outcome == Err(Doubt::NoCommonFace)) {
        if let Some((quilt, held)) = only_quilt(face, boundary, model, incidence, &sides[face], &quilt_of) {
            members.entry(quilt).or_default().extend(held);
            spans.insert(face, quilt);
        }
    }
    for id in decided.iter().flatten() {
        if let Some(members) = quilt_of.get(id.index()).and_then(|quilt| members.get_mut(quilt)) {
            members.insert(*id);
        }
    }
    let mut doubts = Vec::new();
    let host = |(face, outcome): (usize, Result<FaceId, Doubt>)| {
        let quilt = match &outcome {
            Ok(id) => quilt_of.get(id.index()),
            Err(_) => spans.get(&face),
        };
        match (quilt.and_then(|quilt| members.get(quilt)), outcome) {
            (Some(members), _) => Some(members.iter().copied().collect()),
            (None, Ok(id)) => Some(vec![id]),
            (None, Err(doubt)) => {
                doubts.push((face, doubt));
                None
            }
        }
    };
    let hosts = decided.into_iter().enumerate().map(host).collect();
    (hosts, doubts)
}

/// The quilt of each CAD face: faces joined by edges that are not sharp have one number.
fn quilts(model: &Model, joints: &Joints<'_>) -> Vec<usize> {
    let mut quilt: Vec<usize> = (0..model.faces().len()).collect();
    for (edge, faces) in joints.edges() {
        let &[a, b] = faces else { continue };
        let (from, to) = (quilt[a.index()], quilt[b.index()]);
        if from != to && joints.turn(edge).is_some_and(|turn| turn <= SHARP) {
            quilt.iter_mut().filter(|q| **q == from).for_each(|q| *q = to);
        }
    }
    quilt
}

/// The one quilt that holds all corners and runs along the face, with its CAD faces at the corners.
fn only_quilt(
    face: usize,
    boundary: &Boundary,
    model: &Model,
    incidence: &Incidence,
    side: &Side,
    quilt_of: &[usize],
) -> Option<(usize, BTreeSet<FaceId>)> {
    let held = |n: usize| &incidence.faces[n];
    let corners = &boundary.corners[face];
    let quilts: BTreeSet<usize> = held(corners[0].index()).iter().map(|id| quilt_of[id.index()]).collect();
    let fits = |quilt: usize| {
        let of_quilt = |n: usize| held(n).iter().copied().filter(move |id| quilt_of[id.index()] == quilt);
        if !corners.iter().all(|n| of_quilt(n.index()).next().is_some()) {
            return None;
        }
        let faces: BTreeSet<FaceId> = corners.iter().flat_map(|n| of_quilt(n.index())).collect();
        let group = Group::of_faces(model, &faces.iter().copied().collect::<Vec<_>>()).ok()?;
        let near = group.closest(side.middle, None).distance <= BULGE * side.size;
        let runs_along = normal_at(&group, side.middle).is_none_or(|n| n.dot(side.normal).abs() >= ALONG);
        (near && runs_along).then_some((quilt, faces))
    };
    let mut found = quilts.into_iter().filter_map(fits);
    found.next().filter(|_| found.next().is_none())
}
