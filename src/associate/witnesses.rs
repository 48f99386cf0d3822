//! Tags and geometry as two witnesses of what lies on what: each face goes by the one that holds.

use cad::Model;
use rustc_hash::FxHashSet;

use super::{Candidate, Candidates, Inference, associate};
use crate::mesh::{Boundary, Mesh};

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
