//! CAD edges for the mesh edges between faces on different CAD faces, and CAD vertices for their ends.

use std::collections::{BTreeMap, BTreeSet};

use cad::{EdgeId, EntityId, FaceId, Model, VertexId};

use super::Doubt;
use super::incidence::Incidence;
use crate::associate::{Candidate, Joints};
use crate::mesh::{Boundary, NodeId};

/// Mesh edges on CAD edges.
pub(super) struct Strings {
    pub(super) candidates: Vec<Candidate<[NodeId; 2]>>,
    pub(super) doubts: Vec<(usize, Doubt)>,
}

/// The CAD edge of every mesh edge that bounds what lies on one CAD face.
pub(super) fn strings(
    boundary: &Boundary,
    model: &Model,
    joints: &Joints<'_>,
    along: &[Vec<EdgeId>],
    classifications: &[Option<Vec<FaceId>>],
) -> Strings {
    let mut of_edge: BTreeMap<EdgeId, Vec<[NodeId; 2]>> = BTreeMap::new();
    let mut doubts = Vec::new();
    for (edge, faces) in boundary.edge_faces.iter().enumerate() {
        let around: BTreeSet<Option<&[FaceId]>> = faces.iter().map(|&f| classifications[f].as_deref()).collect();
        let decided: Vec<&[FaceId]> = around.iter().copied().flatten().collect();
        if decided.is_empty() || (around.len() == 1 && faces.len() > 1) {
            continue;
        }
        let bounds_all = |id: &&EdgeId| {
            decided.iter().all(|classification| joints.faces_of(**id).iter().any(|face| classification.contains(face)))
        };
        let real = |id: &&EdgeId| !joints.is_seam(**id);
        let found: Vec<EdgeId> = along[edge].iter().filter(bounds_all).filter(real).copied().collect();
        match (&found[..], &decided[..]) {
            (&[only], _) => of_edge.entry(only).or_default().push(boundary.edges[edge]),
            (_, &[first, second, ..]) => doubts.push((edge, Doubt::NoEdge([first[0].into(), second[0].into()]))),
            _ => {}
        }
    }
    let label = |id: EdgeId| match model.edge(id).map(|edge| edge.label.name.as_str()) {
        Some(name) if !name.is_empty() => name.to_owned(),
        _ => id.to_string(),
    };
    let candidate =
        |(id, items): (EdgeId, Vec<[NodeId; 2]>)| Candidate { label: label(id), items, entities: vec![id.into()] };
    Strings { candidates: of_edge.into_iter().map(candidate).collect(), doubts }
}

/// Nodes at the vertices of the CAD edges that strings lie on.
pub(super) fn points(
    boundary: &Boundary,
    model: &Model,
    incidence: &Incidence,
    strings: &Strings,
) -> Vec<Candidate<NodeId>> {
    let used: BTreeSet<VertexId> = strings
        .candidates
        .iter()
        .flat_map(|string| &string.entities)
        .filter_map(|entity| if let EntityId::Edge(id) = entity { model.edge(*id) } else { None })
        .flat_map(|edge| edge.ends.into_iter().flatten())
        .collect();
    let nodes: BTreeSet<NodeId> = boundary.edges.iter().flatten().copied().collect();
    let mut points: BTreeMap<VertexId, Vec<NodeId>> = BTreeMap::new();
    for node in nodes {
        if let Some(&vertex) = incidence.vertices[node.index()].iter().find(|id| used.contains(id)) {
            points.entry(vertex).or_default().push(node);
        }
    }
    let candidate =
        |(id, items): (VertexId, Vec<NodeId>)| Candidate { label: id.to_string(), items, entities: vec![id.into()] };
    // Two nodes at one vertex are one too many to say which is the corner.
    points.into_iter().filter(|(_, nodes)| nodes.len() == 1).map(candidate).collect()
}
