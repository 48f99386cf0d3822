//! Sheets on several CAD faces that meet in a sharp edge: mesh faces across it, and mesh edges on it that no string holds.

use cad::{EdgeId, EntityId, FaceId, Group, Model};
use linkage_schema::{Code, Findings, ModelLinks};
use rustc_hash::FxHashSet;

use super::called;
use super::linked_mesh::LinkedMesh;
use super::references::Geometry;
use crate::associate::{Incidence, Joints, SHARP, Tolerance};

pub(super) fn check(
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
    tolerance: Option<f64>,
    findings: &mut Findings,
) {
    let sheets = || {
        models
            .iter()
            .flat_map(|links| links.sheets.iter().map(move |sheet| (links, sheet)))
            .flat_map(|(links, sheet)| sheet.faces.iter().map(move |link| (links, sheet, link)))
    };
    if sheets().all(|(_, _, link)| geometry.of(link.target.as_deref()).len() < 2) {
        return;
    }
    let joints = Joints::new(model);
    let tolerance = tolerance.map_or_else(|| Tolerance::of(linked.mesh), Tolerance::fixed);
    let incidence = Incidence::new(linked.mesh, linked.boundary, model, &joints, &tolerance);
    let along = incidence.along(linked.mesh, linked.boundary, model);
    let mut held: FxHashSet<usize> = FxHashSet::default();
    for links in models {
        let linked = linked.within(links.model);
        let runs = links.strings.iter().flat_map(|string| &string.edges).map(|link| link.run);
        held.extend(runs.flat_map(|run| run.edges()).filter_map(|ends| linked.edge(ends)));
    }
    for (links, sheet, link) in sheets() {
        let linked = &linked.within(links.model);
        let inside: Vec<FaceId> = geometry
            .of(link.target.as_deref())
            .into_iter()
            .filter_map(|e| if let EntityId::Face(id) = e { Some(id) } else { None })
            .collect();
        let sharp = sharp_between(&joints, &inside);
        let faces: FxHashSet<usize> = link.run.faces().filter_map(|face| linked.face(face)).collect();
        let mut crossing: Vec<usize> =
            faces.iter().copied().filter(|&face| crosses(face, linked, &incidence, &joints, model, &sharp)).collect();
        crossing.sort_unstable();
        let who = called("MeshSheet", sheet.name());
        let tags = |nodes: &[crate::mesh::NodeId]| nodes.iter().map(|&n| linked.tag(n)).collect::<Vec<_>>();
        if let Some(&first) = crossing.first() {
            findings.push(Code::SharpEdgeCrossed, link.run.origin, || {
                let corners = tags(&linked.boundary.corners[first]);
                format!("{} faces of {who} cross a sharp edge of the CAD, the first is {corners:?}", crossing.len())
            });
        }
        let free = (0..along.len()).filter(|&edge| {
            let around = &linked.boundary.edge_faces[edge];
            !held.contains(&edge)
                && around.len() > 1
                && around.iter().all(|face| faces.contains(face))
                && along[edge].iter().any(|id| sharp.contains(id))
        });
        let free: Vec<usize> = free.collect();
        if let Some(&first) = free.first() {
            findings.push(Code::SharpEdgeFree, link.run.origin, || {
                let ends = tags(&linked.boundary.edges[first]);
                let on = along[first].iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
                format!("{} edges inside {who} lie on a sharp edge, the first is {ends:?} on {on}", free.len())
            });
        }
    }
}

/// The sharp edges between two of these faces.
fn sharp_between(joints: &Joints<'_>, faces: &[FaceId]) -> Vec<EdgeId> {
    let between = |(_, own): &(EdgeId, &[FaceId])| own.len() == 2 && own.iter().all(|face| faces.contains(face));
    let is_sharp = |&(edge, _): &(EdgeId, &[FaceId])| joints.turn(edge).is_some_and(|turn| turn > SHARP);
    joints.edges().filter(between).filter(is_sharp).map(|(edge, _)| edge).collect()
}

/// Whether a mesh face, which no CAD face holds whole, has corners on both sides of a sharp edge.
fn crosses(
    face: usize,
    linked: &LinkedMesh<'_>,
    incidence: &Incidence,
    joints: &Joints<'_>,
    model: &Model,
    sharp: &[EdgeId],
) -> bool {
    let corners = &linked.boundary.corners[face];
    let on = |n: usize, id: FaceId| incidence.faces[corners[n].index()].contains(&id);
    let count = corners.len();
    if incidence.faces[corners[0].index()].iter().any(|&id| (1..count).all(|n| on(n, id))) {
        return false;
    }
    let side = &linked.sides[face];
    sharp.iter().any(|&edge| {
        let &[a, b] = joints.faces_of(edge) else { return false };
        let only = |own: FaceId, other: FaceId| (0..count).any(|n| on(n, own) && !on(n, other));
        let near = || Group::of_edges(model, &[edge]).is_ok_and(|g| g.distance(side.middle) <= side.size);
        only(a, b) && only(b, a) && near()
    })
}
