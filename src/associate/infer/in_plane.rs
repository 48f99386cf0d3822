//! The sides of a plane mesh on CAD edges: candidates, sides, growth and smooth groups, as of faces on CAD faces, a dimension lower.
//!
//! What joins mesh faces is a mesh edge, and what parts them a CAD edge; here it is a node, and a CAD vertex.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use cad::{EdgeId, EntityId, Evaluation, Group, Model, VertexId};
use glam::DVec3;
use rayon::prelude::*;

use super::before::{Before, Held};
use super::faces::{ALONG, BULGE};
use super::incidence::slacks;
use super::volume_sides::told_by_most;
use super::{Doubt, Inference, Part, Tolerance};
use crate::associate::host::normal_of;
use crate::associate::joint::SHARP;
use crate::associate::{Candidate, Candidates, Side};
use crate::mesh::{Boundary, EntityKey, Incidence, Mesh, NodeId};

/// A side runs beside a CAD edge that is farther off than the tolerance, if it is nearer than this fraction of its length.
const NEAR: f64 = 0.1;

/// A CAD edge that a side may lie on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct EdgeCandidate {
    edge: EdgeId,
    /// Whether the mesh's outward normal is that of the edge ([`normal_of`]).
    outward: Option<bool>,
}

struct Sides<'a> {
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    model: &'a Model,
    sides: &'a [Side],
    curves: Vec<(EdgeId, Group)>,
    /// How far each node may be from the CAD.
    slack: Vec<Option<f64>>,
    /// The sides at each node.
    around: Incidence<u32>,
}

/// Associates the sides of a plane mesh.
pub(super) fn infer(part: Part<'_>, tolerance: &Tolerance, before: Option<&Before>) -> Inference {
    let Part { mesh, boundary, model, joints, sides } = part;
    let single = |(id, _): (EdgeId, _)| Group::of_edges(model, &[id]).ok().map(|group| (id, group));
    let curves = joints.edges().filter_map(single).collect();
    let ends = (0..).zip(&boundary.corners).flat_map(|(side, ends)| ends.iter().map(move |n| (n.index(), side)));
    let around = Incidence::new(mesh.points().len(), ends);
    let slack = slacks(mesh, boundary, tolerance);
    let own = Sides { mesh, boundary, model, sides, curves, slack, around };
    let mut candidates: Vec<Vec<EdgeCandidate>> =
        (0..boundary.faces.len()).into_par_iter().map(|side| own.candidates(side)).collect();
    strike_wrong_sides(&mut candidates);
    own.grow(&mut candidates);
    own.keep_one_of_coincident(&mut candidates);
    if let Some(before) = before {
        let held: Vec<Held> = candidates.iter().map(|own| held(own)).collect();
        let apart = before.apart(boundary, mesh.points().len(), &held);
        apart.iter().for_each(|&side| candidates[side].clear());
        return own.inference(candidates, &apart);
    }
    own.inference(candidates, &[])
}

fn held(candidates: &[EdgeCandidate]) -> Held {
    match candidates {
        [] => Held::No,
        [only] => Held::On(only.edge.into()),
        _ => Held::Open,
    }
}

/// Strikes out candidates that have the cells on the other side, by what sides without a choice show.
fn strike_wrong_sides(candidates: &mut [Vec<EdgeCandidate>]) {
    let mut told: BTreeMap<EdgeId, [usize; 2]> = BTreeMap::new();
    for own in candidates.iter() {
        if let [EdgeCandidate { edge, outward: Some(outward) }] = own[..] {
            told.entry(edge).or_default()[usize::from(outward)] += 1;
        }
    }
    let wrong = |candidate: &EdgeCandidate| {
        let whole = told.get(&candidate.edge).and_then(|counts| told_by_most(*counts));
        candidate.outward.zip(whole).is_some_and(|(own, whole)| own != whole)
    };
    for own in candidates.iter_mut().filter(|own| own.len() > 1) {
        if !own.iter().all(wrong) {
            own.retain(|candidate| !wrong(candidate));
        }
    }
}

impl Sides<'_> {
    fn at(&self, node: NodeId) -> DVec3 {
        self.mesh.points()[node.index()]
    }

    fn holds(&self, group: &Group, node: NodeId) -> bool {
        self.slack[node.index()].is_some_and(|slack| group.distance(self.at(node)) <= slack)
    }

    fn curve(&self, edge: EdgeId) -> Option<&Group> {
        let place = self.curves.binary_search_by_key(&edge, |(id, _)| *id).ok()?;
        Some(&self.curves[place].1)
    }

    /// CAD edges that hold both ends, run along the side, and that its middle is near to.
    fn candidates(&self, side: usize) -> Vec<EdgeCandidate> {
        let ends = &self.boundary.corners[side];
        let fits = |(edge, group): &(EdgeId, Group)| {
            let near = |&node: &NodeId| {
                let slack = self.slack[node.index()].unwrap_or(0.0);
                group.bounds().distance_squared(self.at(node)) <= slack * slack
            };
            (ends.iter().all(near) && ends.iter().all(|&node| self.holds(group, node))).then_some(())?;
            let Side { middle, normal, size, .. } = self.sides[side];
            let foot = group.closest(middle, None).filter(|foot| foot.distance <= BULGE * size)?;
            let cosine = normal_of(group, &foot, self.boundary.plane).map(|own| own.dot(normal));
            let runs_along = cosine.is_none_or(|cosine| cosine.abs() >= ALONG);
            runs_along.then(|| EdgeCandidate { edge: *edge, outward: cosine.map(|cosine| cosine > 0.0) })
        };
        self.curves.iter().filter_map(fits).collect()
    }

    /// The vertex that a node lies on, of those that end an edge.
    fn vertex_at(&self, edge: EdgeId, node: NodeId) -> Option<VertexId> {
        let ends = self.model.edge(edge)?.ends.into_iter().flatten();
        let is_at = |id: &VertexId| {
            let distance = self.model.vertex(*id).map(|vertex| vertex.point.distance(self.at(node)));
            distance.zip(self.slack[node.index()]).is_some_and(|(distance, slack)| distance <= slack)
        };
        ends.into_iter().find(is_at)
    }

    /// Lets decided sides decide their neighbours: across a node that is no vertex a CAD edge goes on, at its end another begins.
    fn grow(&self, candidates: &mut [Vec<EdgeCandidate>]) {
        let mut decided: VecDeque<usize> = (0..candidates.len()).filter(|&s| candidates[s].len() == 1).collect();
        while let Some(side) = decided.pop_front() {
            let [EdgeCandidate { edge, .. }] = candidates[side][..] else { continue };
            let closed = self.model.edge(edge).is_some_and(|own| own.ends[0] == own.ends[1]);
            for &node in &self.boundary.corners[side] {
                let &[a, b] = self.around.at(node.index()) else { continue };
                let other = if a as usize == side { b } else { a } as usize;
                let ends = self.vertex_at(edge, node).is_some();
                if candidates[other].len() < 2 || (ends && closed) {
                    continue;
                }
                let mut kept = candidates[other].clone();
                kept.retain(|candidate| (candidate.edge == edge) != ends);
                if !kept.is_empty() && kept.len() < candidates[other].len() {
                    candidates[other] = kept;
                    if candidates[other].len() == 1 {
                        decided.push_back(other);
                    }
                }
            }
        }
    }

    /// Keeps the first of CAD edges that coincide where the side is.
    fn keep_one_of_coincident(&self, candidates: &mut [Vec<EdgeCandidate>]) {
        for (side, own) in candidates.iter_mut().enumerate().filter(|(_, own)| own.len() > 1) {
            let slack = self.boundary.corners[side].iter().filter_map(|n| self.slack[n.index()]).fold(0.0, f64::max);
            let middle = self.sides[side].middle;
            let Some(foot) = self.curve(own[0].edge).and_then(|group| group.closest(middle, None)) else { continue };
            let coincides = |candidate: &EdgeCandidate| {
                self.curve(candidate.edge).is_some_and(|group| group.distance(foot.point) <= slack)
            };
            if own.iter().all(coincides) {
                own.truncate(1);
            }
        }
    }

    /// The sides' places; those `apart` (rising) have none.
    fn inference(&self, candidates: Vec<Vec<EdgeCandidate>>, apart: &[usize]) -> Inference {
        let is_apart = |side: usize| apart.binary_search(&side).is_ok();
        let spans: BTreeMap<usize, Vec<EdgeId>> = (0..candidates.len())
            .filter(|&s| candidates[s].is_empty() && !is_apart(s))
            .filter_map(|s| Some((s, self.smooth_pair(s)?)))
            .collect();
        let mut joined = JoinedEdges::default();
        spans.values().for_each(|pair| joined.join(pair));
        let mut sheets: BTreeMap<(EntityKey, Vec<EdgeId>), Vec<usize>> = BTreeMap::new();
        let mut doubts = Vec::new();
        for (side, left) in candidates.iter().enumerate() {
            let own = match (&left[..], spans.get(&side)) {
                (&[EdgeCandidate { edge, .. }], _) => joined.of(edge),
                ([], Some(pair)) => joined.of(pair[0]),
                (several, _) => {
                    doubts.push((side, if is_apart(side) { Doubt::OffCad } else { self.doubt(side, several) }));
                    continue;
                }
            };
            sheets.entry((self.boundary.faces[side].entity, own)).or_default().push(side);
        }
        let used: BTreeSet<EdgeId> = sheets.keys().flat_map(|(_, edges)| edges.iter().copied()).collect();
        let sheet = |((entity, edges), items): ((EntityKey, Vec<EdgeId>), Vec<usize>)| Candidate {
            label: self.mesh.label(entity),
            items,
            entities: edges.into_iter().map(Into::into).collect(),
        };
        let mut found = Candidates { trusted: true, points: self.points(&used), ..Candidates::default() };
        found.sheets = sheets.into_iter().map(sheet).collect();
        self.tell_beside(&used, &mut doubts);
        Inference { candidates: found, faces: doubts, edges: Vec::new() }
    }

    fn doubt(&self, side: usize, several: &[EdgeCandidate]) -> Doubt {
        if !several.is_empty() {
            return Doubt::Several(several.iter().map(|candidate| candidate.edge.into()).collect());
        }
        let on = |&node: &NodeId| self.curves.iter().any(|(_, group)| self.holds(group, node));
        let ends = &self.boundary.corners[side];
        match ends.iter().filter(|node| on(node)).count() {
            0 => Doubt::OffCad,
            held if held < ends.len() => Doubt::PartlyOffCad,
            _ => Doubt::NoCommonFace,
        }
    }

    /// Two CAD edges that go on smoothly in one another and hold one end of a side each.
    fn smooth_pair(&self, side: usize) -> Option<Vec<EdgeId>> {
        let &[a, b] = &self.boundary.corners[side][..] else { return None };
        let at = |node: NodeId| self.curves.iter().filter(move |(_, group)| self.holds(group, node));
        let mut pairs = at(a).flat_map(|one| at(b).map(move |other| (one, other)));
        let smooth = |(one, other): &(&(EdgeId, Group), &(EdgeId, Group))| {
            let ends = |edge: EdgeId| self.model.edge(edge).map(|own| own.ends).into_iter().flatten().flatten();
            let shared = ends(one.0).find(|vertex| ends(other.0).any(|own| own == *vertex));
            let at = shared.and_then(|vertex| self.model.vertex(vertex)).map(|vertex| vertex.point);
            let tangent = |group: &Group| match group.evaluate_at(&group.closest(at?, None)?)? {
                Evaluation::Curve(point) => point.tangent,
                _ => None,
            };
            let cosine = tangent(&one.1).zip(tangent(&other.1)).map(|(a, b)| a.dot(b).abs());
            one.0 != other.0 && cosine.is_some_and(|cosine| cosine >= SHARP.cos())
        };
        pairs.find(smooth).map(|(one, other)| vec![one.0, other.0])
    }

    /// Nodes at the vertices of the CAD edges that sides lie on.
    fn points(&self, used: &BTreeSet<EdgeId>) -> Vec<Candidate<NodeId>> {
        let ends = |edge: &EdgeId| self.model.edge(*edge).map(|own| own.ends).into_iter().flatten().flatten();
        let vertices: BTreeSet<VertexId> = used.iter().flat_map(ends).collect();
        let nodes: BTreeSet<NodeId> = self.boundary.corners.iter().flatten().copied().collect();
        let point = |&id: &VertexId| {
            let place = self.model.vertex(id)?.point;
            let is_at =
                |node: &&NodeId| self.slack[node.index()].is_some_and(|slack| self.at(**node).distance(place) <= slack);
            let items: Vec<NodeId> = nodes.iter().filter(is_at).copied().collect();
            // Two nodes at one vertex are one too many to say which is the corner.
            (items.len() == 1).then(|| Candidate { label: id.to_string(), items, entities: vec![id.into()] })
        };
        vertices.iter().filter_map(point).collect()
    }

    /// Tells of sides off the CAD which of them run beside an edge that no side lies on.
    fn tell_beside(&self, used: &BTreeSet<EdgeId>, doubts: &mut [(usize, Doubt)]) {
        let bare: Vec<EntityId> =
            self.curves.iter().map(|(id, _)| *id).filter(|id| !used.contains(id)).map(Into::into).collect();
        let Ok(group) = Group::of(self.model, &bare) else { return };
        for (side, doubt) in doubts.iter_mut().filter(|(_, doubt)| *doubt == Doubt::OffCad) {
            let Side { middle, normal, size, .. } = self.sides[*side];
            let distances = self.boundary.corners[*side].iter().map(|&n| group.distance(self.at(n)));
            let distance = distances.fold(0.0, f64::max);
            let Some(foot) = group.closest(middle, None).filter(|_| distance <= NEAR * size) else { continue };
            if normal_of(&group, &foot, self.boundary.plane).is_some_and(|own| own.dot(normal).abs() >= ALONG) {
                *doubt = Doubt::Beside { on: foot.entity, distance };
            }
        }
    }
}

/// CAD edges that count as one.
#[derive(Default)]
struct JoinedEdges(Vec<BTreeSet<EdgeId>>);

impl JoinedEdges {
    fn join(&mut self, edges: &[EdgeId]) {
        let mut all: BTreeSet<EdgeId> = edges.iter().copied().collect();
        self.0.retain(|own| {
            let apart = own.is_disjoint(&all);
            if !apart {
                all.extend(own);
            }
            apart
        });
        self.0.push(all);
    }

    fn of(&self, edge: EdgeId) -> Vec<EdgeId> {
        let joined = self.0.iter().find(|own| own.contains(&edge));
        joined.map_or_else(|| vec![edge], |own| own.iter().copied().collect())
    }
}
