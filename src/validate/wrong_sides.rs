//! Faces that do not run along their CAD surface, or lie on its other side.

use std::collections::BTreeMap;

use cad::{EntityId, Evaluation, FaceId, Group, Model};
use linkage_schema::{Code, Findings, ModelLinks, Origin};

use super::called;
use super::linked_mesh::LinkedMesh;
use super::references::Geometry;
use crate::associate::Joints;

/// Cosine between the normals of a mesh face and its CAD face below which the one does not run along the other.
const ALONG: f64 = 0.5;
/// The volume is on one side of a shell if at least this fraction of the linked faces says so.
const ONE_SIDE: f64 = 0.9;

/// A mesh face that runs along its CAD face, and on which side of that it has the volume.
struct Told {
    shell: usize,
    outward: bool,
    run: usize,
    /// The place of its first index in the run.
    word: Option<usize>,
    corners: Vec<u64>,
}

pub(super) fn check(
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
    tolerance: f64,
    findings: &mut Findings,
) {
    let shells = shells(model);
    let joints = Joints::new(model);
    let mut runs: Vec<(Origin, String)> = Vec::new();
    let mut told: Vec<Told> = Vec::new();
    for (links, sheet) in models.iter().flat_map(|links| links.sheets.iter().map(move |sheet| (links, sheet))) {
        let linked = &linked.within(links.model);
        for link in &sheet.faces {
            let faces: Vec<FaceId> = geometry
                .of(link.target.as_deref())
                .into_iter()
                .filter_map(|e| if let EntityId::Face(id) = e { Some(id) } else { None })
                .collect();
            let Ok(group) = Group::of_faces(model, &faces) else { continue };
            let mut across: Vec<(usize, Vec<u64>)> = Vec::new();
            let corners_of = link.run.shape.corners();
            for (number, face) in link.run.faces().enumerate() {
                let Some(face) = linked.face(face) else { continue };
                let corners = || linked.boundary.corners[face].iter().map(|&n| linked.tag(n)).collect();
                let held = |id: &FaceId| joints.face(*id).and_then(|group| meeting(linked, face, group, tolerance));
                // On a group, the one of its faces that the mesh face lies on: at a thin edge its middle may be nearer to another.
                let single = faces.iter().filter_map(held).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
                match single.or_else(|| meeting(linked, face, &group, tolerance)) {
                    Some((_, cosine)) if cosine.abs() < ALONG => across.push((number, corners())),
                    Some((id, cosine)) => told.push(Told {
                        shell: shells[id.index()],
                        outward: cosine > 0.0,
                        run: runs.len(),
                        word: link.run.encoding.word(number * corners_of),
                        corners: corners(),
                    }),
                    None => {}
                }
            }
            let who = called("MeshSheet", sheet.name());
            if let Some((number, first)) = across.first() {
                findings.push_word(
                    Code::WrongSide,
                    link.run.origin,
                    link.run.encoding.word(number * corners_of),
                    || {
                        format!(
                            "{} faces of {who} do not run along the surface they are linked to, the first is {first:?}",
                            across.len()
                        )
                    },
                );
            }
            runs.push((link.run.origin, who));
        }
    }
    let mut sides: BTreeMap<usize, [usize; 2]> = BTreeMap::new();
    for one in &told {
        sides.entry(one.shell).or_default()[usize::from(one.outward)] += 1;
    }
    let mut wrong: BTreeMap<usize, Vec<&Told>> = BTreeMap::new();
    for one in &told {
        let [against, with] = sides[&one.shell];
        let own = if one.outward { with } else { against };
        if own as f64 <= (1.0 - ONE_SIDE) * (against + with) as f64 {
            wrong.entry(one.run).or_default().push(one);
        }
    }
    for (run, faces) in wrong {
        let (origin, who) = &runs[run];
        findings.push_word(Code::WrongSide, *origin, faces[0].word, || {
            let first = &faces[0].corners;
            format!(
                "{} faces of {who} have the volume on the other side of the surface, the first is {first:?}",
                faces.len()
            )
        });
    }
}

/// The CAD face at a mesh face's middle, and the cosine between their normals; `None` where the corners are off the CAD, which is reported
/// otherwise, or the surface has no normal.
fn meeting(linked: &LinkedMesh<'_>, face: usize, group: &Group, tolerance: f64) -> Option<(FaceId, f64)> {
    let corners = linked.mesh.points_of(&linked.boundary.corners[face]);
    if corners.into_iter().any(|x| group.distance(x) > tolerance) {
        return None;
    }
    let side = &linked.sides[face];
    let foot = group.closest(side.middle, None)?;
    match (foot.entity, group.evaluate_at(&foot)?) {
        (EntityId::Face(id), Evaluation::Surface(point)) => Some((id, point.normal?.dot(side.normal))),
        _ => None,
    }
}

/// The shell of every CAD face: faces that share an edge of the topology have one orientation.
fn shells(model: &Model) -> Vec<usize> {
    let mut shell: Vec<usize> = (0..model.faces().len()).collect();
    for edge in model.edges() {
        if let [a, b] = edge.faces[..] {
            let (from, to) = (shell[a.index()], shell[b.index()]);
            shell.iter_mut().filter(|s| **s == from).for_each(|s| *s = to);
        }
    }
    shell
}
