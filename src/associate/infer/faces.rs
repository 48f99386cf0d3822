//! One CAD face for each mesh face: candidates, sides, growth.

use std::collections::{BTreeMap, VecDeque};

use cad::{EdgeId, FaceId};

use super::before::{Before, Held};
use super::incidence::Incidence;
use super::volume_sides::VolumeSides;
use super::{Doubt, Part};
use crate::associate::joint::normal_at;
use crate::associate::{Candidate, Joints, Side};
use crate::mesh::{Boundary, EntityKey, Mesh};

/// A mesh face runs along a CAD face if the cosine between their normals is at least this.
pub(super) const ALONG: f64 = 0.5;
/// How far the middle of a mesh face may be from its CAD face; fraction of its longest edge.
pub(super) const BULGE: f64 = 0.5;
/// Of mesh faces on both sides of a CAD face, those that are farther off by this factor in the mean are not on it.
const FARTHER: f64 = 4.0;

/// A CAD face that a mesh face may lie on.
#[derive(Clone, Copy, Debug)]
struct FaceCandidate {
    face: FaceId,
    /// Whether the mesh's outward normal is that of the CAD face; `None` where the CAD has no normal.
    outward: Option<bool>,
}

/// For each mesh face its CAD face, or why it has none.
pub(super) fn decide(
    part: Part<'_>,
    incidence: &Incidence,
    along: &[Vec<EdgeId>],
    before: Option<&Before>,
) -> Vec<Result<FaceId, Doubt>> {
    let Part { mesh, boundary, joints, sides, .. } = part;
    let mut candidates: Vec<Vec<FaceCandidate>> =
        (0..boundary.faces.len()).map(|f| candidates(f, boundary, joints, incidence, &sides[f])).collect();
    let beside =
        before.map_or_else(Vec::new, |before| strike_beside(&mut candidates, mesh, boundary, joints, &before.sides));
    strike_wrong_sides(&mut candidates);
    grow(boundary, joints, along, &mut candidates);
    for (f, own) in candidates.iter_mut().enumerate().filter(|(_, own)| own.len() > 1) {
        keep_one_of_coincident(own, joints, &sides[f], incidence.slack(boundary, f));
    }
    let is_beside = |f: usize| beside.binary_search(&f).is_ok();
    follow_neighbours(boundary, joints, incidence, along, &is_beside, &mut candidates);
    let outcome = |f: usize, left: &Vec<FaceCandidate>| match left[..] {
        [only] => Ok(only.face),
        [] if is_beside(f) => Err(Doubt::OffCad),
        [] => {
            let held = boundary.corners[f].iter().filter(|n| !incidence.faces[n.index()].is_empty()).count();
            Err(match held {
                0 => Doubt::OffCad,
                held if held < boundary.corners[f].len() => Doubt::PartlyOffCad,
                _ => Doubt::NoCommonFace,
            })
        }
        _ => Err(Doubt::Several(left.iter().map(|candidate| candidate.face.into()).collect())),
    };
    let mut decided: Vec<_> = candidates.iter().enumerate().map(|(f, left)| outcome(f, left)).collect();
    if let Some(before) = before {
        let held: Vec<Held> = decided.iter().map(held).collect();
        before
            .apart(boundary, mesh.points().len(), &held)
            .into_iter()
            .for_each(|face| decided[face] = Err(Doubt::OffCad));
    }
    decided
}

fn held(decided: &Result<FaceId, Doubt>) -> Held {
    match decided {
        Ok(face) => Held::On((*face).into()),
        Err(Doubt::OffCad | Doubt::PartlyOffCad) => Held::No,
        Err(_) => Held::Open,
    }
}

/// CAD faces that hold all corners, run along the face, and that its middle is near to.
fn candidates(
    face: usize,
    boundary: &Boundary,
    joints: &Joints<'_>,
    incidence: &Incidence,
    side: &Side,
) -> Vec<FaceCandidate> {
    let corners = &boundary.corners[face];
    let at = |q: usize| &incidence.faces[corners[q].index()];
    let common = at(0).iter().filter(|id| (1..corners.len()).all(|q| at(q).contains(id)));
    let fits = |&id: &FaceId| {
        let group = joints.face(id)?;
        if group.distance(side.middle) > BULGE * side.size {
            return None;
        }
        let cosine = normal_at(group, side.middle).map(|normal| normal.dot(side.normal));
        let runs_along = cosine.is_none_or(|cosine| cosine.abs() >= ALONG);
        runs_along.then(|| FaceCandidate { face: id, outward: cosine.map(|cosine| cosine > 0.0) })
    };
    common.filter_map(fits).collect()
}

/// Strikes out candidates that have the volume on the other side, by what faces without a choice show.
fn strike_wrong_sides(candidates: &mut [Vec<FaceCandidate>]) {
    let mut told = VolumeSides::default();
    for own in candidates.iter() {
        if let [FaceCandidate { face, outward: Some(outward) }] = own[..] {
            told.tell(face, outward);
        }
    }
    let wrong = |candidate: &FaceCandidate| {
        candidate.outward.zip(told.outward(candidate.face)).is_some_and(|(own, whole)| own != whole)
    };
    for own in candidates.iter_mut().filter(|own| own.len() > 1) {
        if !own.iter().all(wrong) {
            own.retain(|candidate| !wrong(candidate));
        }
    }
}

/// Strikes out candidates of mesh faces that face the other way than those that are known to lie on the CAD face; where none is known, than those
/// that are nearer. Returns the mesh faces that have none left, rising.
fn strike_beside(
    candidates: &mut [Vec<FaceCandidate>],
    mesh: &Mesh,
    boundary: &Boundary,
    joints: &Joints<'_>,
    told: &VolumeSides,
) -> Vec<usize> {
    let mut distances: BTreeMap<FaceId, [(f64, usize); 2]> = BTreeMap::new();
    for (own, corners) in candidates.iter().zip(&boundary.corners) {
        for candidate in own.iter().filter(|candidate| told.outward(candidate.face).is_none()) {
            let (Some(group), Some(outward)) = (joints.face(candidate.face), candidate.outward) else { continue };
            let (sum, count) = &mut distances.entry(candidate.face).or_default()[usize::from(outward)];
            *sum += mesh.points_of(corners).map(|x| group.distance(x)).sum::<f64>();
            *count += corners.len();
        }
    }
    let nearer = |face: FaceId| {
        let [against, with] = distances.get(&face)?.map(|(sum, count)| sum / count.max(1) as f64);
        let counts = distances.get(&face)?.map(|(_, count)| count);
        if counts.contains(&0) {
            return None;
        }
        (against > FARTHER * with).then_some(true).or((with > FARTHER * against).then_some(false))
    };
    let mut emptied = Vec::new();
    for (f, own) in candidates.iter_mut().enumerate().filter(|(_, own)| !own.is_empty()) {
        let wrong = |candidate: &FaceCandidate| {
            let right = told.outward(candidate.face).or_else(|| nearer(candidate.face));
            candidate.outward.zip(right).is_some_and(|(own, right)| own != right)
        };
        own.retain(|candidate| !wrong(candidate));
        if own.is_empty() {
            emptied.push(f);
        }
    }
    emptied
}

/// Lets decided faces decide their neighbours, until nothing changes.
fn grow(boundary: &Boundary, joints: &Joints<'_>, along: &[Vec<EdgeId>], candidates: &mut [Vec<FaceCandidate>]) {
    let mut edges_of: Vec<Vec<usize>> = vec![Vec::new(); boundary.faces.len()];
    for (edge, faces) in boundary.edge_faces.iter().enumerate() {
        faces.iter().for_each(|&face| edges_of[face].push(edge));
    }
    let mut decided: VecDeque<usize> = (0..candidates.len()).filter(|&f| candidates[f].len() == 1).collect();
    while let Some(face) = decided.pop_front() {
        let [FaceCandidate { face: own, .. }] = candidates[face][..] else { continue };
        for &edge in &edges_of[face] {
            // Where three faces meet, there is no "other side".
            let [a, b] = boundary.edge_faces[edge][..] else { continue };
            let other = if a == face { b } else { a };
            if candidates[other].len() < 2 {
                continue;
            }
            let bounds = |&&id: &&EdgeId| joints.faces_of(id).contains(&own);
            let kept: Vec<FaceCandidate> = match along[edge].iter().find(bounds) {
                None => candidates[other].iter().filter(|c| c.face == own).copied().collect(),
                // A seam has its one face on both sides.
                Some(&id) if joints.faces_of(id).len() == 1 && joints.is_seam(id) => continue,
                Some(_) => candidates[other].iter().filter(|c| c.face != own).copied().collect(),
            };
            if !kept.is_empty() && kept.len() < candidates[other].len() {
                candidates[other] = kept;
                if candidates[other].len() == 1 {
                    decided.push_back(other);
                }
            }
        }
    }
}

/// Keeps the first of CAD faces that coincide where the mesh face is: solids that touch, and faces that a file holds twice, have them.
fn keep_one_of_coincident(own: &mut Vec<FaceCandidate>, joints: &Joints<'_>, side: &Side, slack: f64) {
    let Some(foot) = joints.face(own[0].face).and_then(|group| group.closest(side.middle, None)) else { return };
    let coincides = |candidate: &FaceCandidate| {
        joints.face(candidate.face).is_some_and(|group| group.distance(foot.point) <= slack)
    };
    if own.iter().all(coincides) {
        own.truncate(1); // the smallest number comes first
    }
}

/// Lets faces that no CAD face seems to run along, though one holds all their corners, go with their neighbours: coarse faces beside a
/// pole or on a small radius turn by any angle from the CAD.
fn follow_neighbours(
    boundary: &Boundary,
    joints: &Joints<'_>,
    incidence: &Incidence,
    along: &[Vec<EdgeId>],
    is_beside: &dyn Fn(usize) -> bool,
    candidates: &mut [Vec<FaceCandidate>],
) {
    let holds = |f: usize, id: FaceId| boundary.corners[f].iter().all(|n| incidence.faces[n.index()].contains(&id));
    loop {
        let mut found: Vec<(usize, FaceCandidate)> = Vec::new();
        for (edge, faces) in boundary.edge_faces.iter().enumerate() {
            let &[a, b] = &faces[..] else { continue };
            for (open, decided) in [(a, b), (b, a)] {
                let ([], [own]) = (&candidates[open][..], &candidates[decided][..]) else { continue };
                let bounds = |id: &EdgeId| joints.faces_of(*id).contains(&own.face) && !joints.is_seam(*id);
                if !is_beside(open) && holds(open, own.face) && !along[edge].iter().any(bounds) {
                    found.push((open, *own));
                }
            }
        }
        if found.is_empty() {
            return;
        }
        for (face, candidate) in found {
            if candidates[face].is_empty() {
                candidates[face].push(candidate);
            }
        }
    }
}

/// The candidates of mesh faces, patch by patch.
pub(super) fn sheets(
    mesh: &Mesh,
    boundary: &Boundary,
    classifications: &[Option<Vec<FaceId>>],
) -> Vec<Candidate<usize>> {
    let mut sheets: BTreeMap<(EntityKey, &[FaceId]), Vec<usize>> = BTreeMap::new();
    for (face, classification) in classifications.iter().enumerate() {
        if let Some(classification) = classification {
            sheets.entry((boundary.faces[face].entity, classification)).or_default().push(face);
        }
    }
    let candidate = |((entity, classification), items): ((EntityKey, &[FaceId]), Vec<usize>)| Candidate {
        label: mesh.label(entity),
        items,
        entities: classification.iter().map(|&id| id.into()).collect(),
    };
    sheets.into_iter().map(candidate).collect()
}
