//! What a linkage file of a mesh would say: by the mesh's entity tags where they are the CAD's numbers, else by geometry.

use cad::{Aabb, Model};

use super::witnesses::{add_edges, combined};
use super::{AssociateError, Candidates, Inference, Tolerance, associate, infer};
use crate::mesh::{Boundary, Mesh};

/// A point may be this far from what its tag names, as a fraction of the mesh's bounding-box diagonal.
const MAX_OFFSET: f64 = 1e-3;

/// Candidates for a linkage file.
#[derive(Debug)]
pub struct Proposal {
    /// The candidates; no sheet among them where no face of the mesh is on the CAD.
    pub candidates: Candidates,
    /// What they were inferred from, where the tags do not hold.
    pub inference: Option<Inference>,
    /// Where they come from, for people.
    pub source: &'static str,
    /// The ratio of units by which CAD and mesh differ in size, if they do.
    pub factor: Option<f64>,
}

/// Proposes what lies on what. `tolerance` is how far a node may be from its CAD entity, [`Tolerance::of`] the mesh where it is not
/// given; `by_tags` says whether tags are used at all.
#[must_use]
pub fn propose(mesh: &Mesh, boundary: &Boundary, model: &Model, tolerance: Option<f64>, by_tags: bool) -> Proposal {
    let size = Aabb::of_points(mesh.points().iter().copied()).diagonal();
    let mut factor = cad::unit_factor(size, model.diagonal());
    let tags = if by_tags { Candidates::by_tags(mesh, boundary, model) } else { Candidates::default() };
    let is_whole = tags.sheets.iter().all(|sheet| !sheet.entities.is_empty());
    let by_tags = by_tags.then(|| associate(mesh, boundary, model, &tags, MAX_OFFSET));
    let tolerance = tolerance.map_or_else(|| Tolerance::of(mesh), Tolerance::fixed);
    let of_tags = |mut candidates: Candidates, inference: Option<Inference>| {
        // Meshes whose faces have tags may have no elements on edges and at corners.
        let inference = inference.unwrap_or_else(|| infer(mesh, boundary, model, &tolerance));
        add_edges(&mut candidates, &inference, boundary, |_| true);
        Proposal { candidates, inference: None, source: "the mesh's entity tags", factor: None }
    };
    match &by_tags {
        Some(Ok(_)) if is_whole => return of_tags(tags, None),
        Some(Err(AssociateError::Scale { factor: own, .. })) => factor = Some(*own),
        _ => {}
    }
    let mut inference = infer(mesh, boundary, model, &tolerance);
    match combined(&tags, &mut inference, mesh, boundary, model, MAX_OFFSET) {
        Some((candidates, source)) => Proposal { candidates, inference: Some(inference), source, factor },
        None if matches!(by_tags, Some(Ok(_))) => of_tags(tags, Some(inference)),
        None => Proposal { candidates: Candidates::default(), inference: Some(inference), source: "geometry", factor },
    }
}
