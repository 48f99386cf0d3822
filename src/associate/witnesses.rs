//! Linkage, tags and geometry as witnesses of what lies on what: each face goes by the strongest one that holds.

use std::collections::{BTreeMap, BTreeSet};

use cad::{EntityId, Model};
use rustc_hash::FxHashSet;

use super::{Candidate, Candidates, Inference, associate};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

/// The candidates of geometry, and where it leaves faces open those of the tags that hold; with where they come from, for people. `None`
/// where geometry knows of no face that the tags do not know of.
///
/// Faces on which the tags hold are no longer doubts of the inference.
pub(super) fn combined(
    tags: &Candidates,
    inference: &mut Inference,
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    max_offset: f64,
) -> Option<(Candidates, &'static str)> {
    let holds = |sheet: &&Candidate<usize>| {
        let alone = Candidates { sheets: vec![(*sheet).clone()], ..Candidates::default() };
        associate(mesh, boundary, model, &alone, max_offset).is_ok()
    };
    let held: Vec<&Candidate<usize>> = tags.sheets.iter().filter(holds).collect();
    let said: FxHashSet<usize> = held.iter().flat_map(|sheet| sheet.items.iter().copied()).collect();
    let sheets = &inference.candidates.sheets;
    let found: FxHashSet<usize> = sheets.iter().flat_map(|sheet| sheet.items.iter().copied()).collect();
    inference.faces.retain(|(face, _)| !said.contains(face));
    if found.is_subset(&said) {
        return None;
    }
    let mut candidates = inference.candidates.clone();
    for sheet in held {
        let items: Vec<usize> = sheet.items.iter().copied().filter(|face| !found.contains(face)).collect();
        if !items.is_empty() {
            candidates.sheets.push(Candidate { items, ..sheet.clone() });
        }
    }
    Some((candidates, if said.is_empty() { "geometry" } else { "geometry and the mesh's entity tags" }))
}

/// The candidates of a linkage file, and those of geometry for the faces of which it says nothing; and these faces, by index, with the CAD face of
/// each. `None` where geometry knows of none either.
pub(super) fn completed(
    linkage: &Candidates,
    inference: &Inference,
    boundary: &Boundary,
    straight: &BTreeSet<EntityKey>,
) -> Option<(Candidates, BTreeMap<usize, EntityId>)> {
    let said = linkage.linked_faces();
    let is_left = |face: &usize| !said.contains(face) && !straight.contains(&boundary.faces[*face].entity);
    let mut candidates = linkage.clone();
    let mut left = BTreeMap::new();
    for sheet in &inference.candidates.sheets {
        let items: Vec<usize> = sheet.items.iter().copied().filter(is_left).collect();
        left.extend(sheet.entities.first().into_iter().flat_map(|&on| items.iter().map(move |&face| (face, on))));
        if !items.is_empty() {
            candidates.sheets.push(Candidate { items, ..sheet.clone() });
        }
    }
    let beside = |edge: usize| boundary.edge_faces[edge].iter().any(|face| left.contains_key(face));
    add_edges(&mut candidates, inference, boundary, beside);
    (!left.is_empty()).then_some((candidates, left))
}

/// Adds the mesh edges and points that geometry finds on CAD edges and vertices, but for those of which something is said already: at boundary edges
/// that are `asked` for, by index.
pub(super) fn add_edges(
    candidates: &mut Candidates,
    inference: &Inference,
    boundary: &Boundary,
    asked: impl Fn(usize) -> bool,
) {
    let linked = candidates.strings.iter().filter(|string| !string.entities.is_empty());
    let said: FxHashSet<usize> =
        linked.flat_map(|string| &string.items).filter_map(|&ends| boundary.edge(ends)).collect();
    let is_asked = |ends: &[NodeId; 2]| boundary.edge(*ends).is_some_and(|edge| !said.contains(&edge) && asked(edge));
    let mut ends: FxHashSet<NodeId> = FxHashSet::default();
    for string in &inference.candidates.strings {
        let items: Vec<[NodeId; 2]> = string.items.iter().copied().filter(is_asked).collect();
        ends.extend(items.iter().flatten());
        if !items.is_empty() {
            candidates.strings.push(Candidate { items, ..string.clone() });
        }
    }
    let linked = candidates.points.iter().filter(|point| !point.entities.is_empty());
    let known: FxHashSet<NodeId> = linked.flat_map(|point| point.items.iter().copied()).collect();
    for point in &inference.candidates.points {
        let items: Vec<NodeId> =
            point.items.iter().copied().filter(|node| ends.contains(node) && !known.contains(node)).collect();
        if !items.is_empty() {
            candidates.points.push(Candidate { items, ..point.clone() });
        }
    }
}
