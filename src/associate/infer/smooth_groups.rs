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
type Classifications = (Vec<Option<Vec<FaceId>>>, Vec<(usize, Doubt)>);

/// Puts faces without a CAD face of their own on several together. Where a smooth_group is needed, all its mesh faces go on all its CAD faces, so
/// that no classification ends in the middle of a smooth surface.
pub(super) fn join(
    boundary: &Boundary,
    model: &Model,
    joints: &Joints<'_>,
    incidence: &Incidence,
    sides: &[Side],
    decided: Vec<Result<FaceId, Doubt>>,
) -> Classifications {
    let open = decided.iter().filter(|outcome| **outcome == Err(Doubt::NoCommonFace)).count();
    let smooth_group_of = if open == 0 { Vec::new() } else { smooth_groups(model, joints) };
    let mut members: BTreeMap<usize, BTreeSet<FaceId>> = BTreeMap::new();
    let mut spans: BTreeMap<usize, usize> = BTreeMap::new();
    for (face, _) in decided.iter().enumerate().filter(|(_, outcome)| **outcome == Err(Doubt::NoCommonFace)) {
        if let Some((smooth_group, held)) =
            only_smooth_group(face, boundary, model, incidence, &sides[face], &smooth_group_of)
        {
            members.entry(smooth_group).or_default().extend(held);
            spans.insert(face, smooth_group);
        }
    }
    for id in decided.iter().flatten() {
        if let Some(members) = smooth_group_of.get(id.index()).and_then(|smooth_group| members.get_mut(smooth_group)) {
            members.insert(*id);
        }
    }
    let mut doubts = Vec::new();
    let classification = |(face, outcome): (usize, Result<FaceId, Doubt>)| {
        let smooth_group = match &outcome {
            Ok(id) => smooth_group_of.get(id.index()),
            Err(_) => spans.get(&face),
        };
        match (smooth_group.and_then(|smooth_group| members.get(smooth_group)), outcome) {
            (Some(members), _) => Some(members.iter().copied().collect()),
            (None, Ok(id)) => Some(vec![id]),
            (None, Err(doubt)) => {
                doubts.push((face, doubt));
                None
            }
        }
    };
    let classifications = decided.into_iter().enumerate().map(classification).collect();
    (classifications, doubts)
}

/// The smooth_group of each CAD face: faces joined by edges that are not sharp have one number.
fn smooth_groups(model: &Model, joints: &Joints<'_>) -> Vec<usize> {
    let mut smooth_group: Vec<usize> = (0..model.faces().len()).collect();
    for (edge, faces) in joints.edges() {
        let &[a, b] = faces else { continue };
        let (from, to) = (smooth_group[a.index()], smooth_group[b.index()]);
        if from != to && joints.turn(edge).is_some_and(|turn| turn <= SHARP) {
            smooth_group.iter_mut().filter(|q| **q == from).for_each(|q| *q = to);
        }
    }
    smooth_group
}

/// The one smooth_group that holds all corners and runs along the face, with its CAD faces at the corners.
fn only_smooth_group(
    face: usize,
    boundary: &Boundary,
    model: &Model,
    incidence: &Incidence,
    side: &Side,
    smooth_group_of: &[usize],
) -> Option<(usize, BTreeSet<FaceId>)> {
    let held = |n: usize| &incidence.faces[n];
    let corners = &boundary.corners[face];
    let smooth_groups: BTreeSet<usize> =
        held(corners[0].index()).iter().map(|id| smooth_group_of[id.index()]).collect();
    let fits = |smooth_group: usize| {
        let of_smooth_group =
            |n: usize| held(n).iter().copied().filter(move |id| smooth_group_of[id.index()] == smooth_group);
        if !corners.iter().all(|n| of_smooth_group(n.index()).next().is_some()) {
            return None;
        }
        let faces: BTreeSet<FaceId> = corners.iter().flat_map(|n| of_smooth_group(n.index())).collect();
        let group = Group::of_faces(model, &faces.iter().copied().collect::<Vec<_>>()).ok()?;
        let near = group.distance(side.middle) <= BULGE * side.size;
        let runs_along = normal_at(&group, side.middle).is_none_or(|n| n.dot(side.normal).abs() >= ALONG);
        (near && runs_along).then_some((smooth_group, faces))
    };
    let mut found = smooth_groups.into_iter().filter_map(fits);
    found.next().filter(|_| found.next().is_none())
}
