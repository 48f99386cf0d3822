//! Where the association of a mesh comes from: a linkage file, its entity tags, or its geometry.

use std::collections::BTreeMap;

use cad::Model;

use super::witnesses::combined;
use super::{
    AssociateError, Association, Candidates, Inference, Linkage, LinkageError, Tolerance, associate, infer, linked,
};
use crate::mesh::{Boundary, Mesh};

/// Candidates, checked against the CAD, and where they come from.
#[derive(Debug)]
pub struct Classified {
    /// The candidates.
    pub candidates: Candidates,
    /// The association that they make.
    pub association: Association,
    /// What was inferred, where neither a linkage file nor tags said it.
    pub inference: Option<Inference>,
    /// Where they come from, for people.
    pub source: String,
}

/// Why a mesh could not be classified.
#[derive(Debug, thiserror::Error)]
pub enum ClassifyError {
    /// The linkage file cannot be used.
    #[error(transparent)]
    Linkage(#[from] LinkageError),
    /// Mesh and CAD do not belong together.
    #[error(transparent)]
    Associate(#[from] AssociateError),
}

/// Classifies the boundary of a mesh on its CAD: by the linkage where there is one, else by entity tags where they are this CAD's, else
/// by geometry.
///
/// `choose` may strike out candidates before they are checked against
/// the CAD. `max_offset` is that of [`associate`].
///
/// # Errors
/// [`ClassifyError`]; where tags do not hold and geometry does not decide either, what is wrong with the tags.
pub fn classify(
    linkage: Option<&Linkage>,
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    max_offset: f64,
    choose: &dyn Fn(&mut Candidates),
) -> Result<Classified, ClassifyError> {
    let held = |mut candidates: Candidates, inference: Option<Inference>, source: String| {
        choose(&mut candidates);
        let mut association = associate(mesh, boundary, model, &candidates, max_offset)?;
        association.notes.extend(model.losses());
        association.notes.append(&mut candidates.notes);
        Ok::<_, AssociateError>(Classified { candidates, association, inference, source })
    };
    if let Some(linkage) = linkage {
        let (candidates, file) = (linked(linkage, mesh, boundary, model)?, linkage.file.display());
        let trusted = candidates.trusted;
        let mut classified = held(candidates, None, format!("linkage file {file}"))?;
        if !trusted {
            let note = "names another CAD file; its references were looked up in the given one";
            classified.association.notes.push(format!("{file} {note}"));
        }
        return Ok(classified);
    }
    let tags = Candidates::by_tags(mesh, boundary, model);
    let mut asked = tags.clone();
    choose(&mut asked);
    let by_tags = match held(tags.clone(), None, "the mesh's entity tags".into()) {
        Ok(classified) if asked.sheets.iter().all(|sheet| !sheet.entities.is_empty()) => return Ok(classified),
        Err(error) if !error.tags_are_of_no_use() => return Err(error.into()),
        other => other,
    };
    // Faces of which the tags say nothing that holds are left to geometry.
    let mut inference = infer(mesh, boundary, model, &Tolerance::of(mesh));
    if by_tags.is_err() && !is_usable(boundary, &inference) {
        return Ok(by_tags?); // mesh and CAD of different sizes or positions may have some faces in common
    }
    let Some((candidates, source)) = combined(&tags, &mut inference, mesh, boundary, model, max_offset) else {
        let mut classified = by_tags?;
        classified.inference = Some(inference);
        return Ok(classified);
    };
    let mut classified = held(candidates, None, source.into())?;
    let [faces, edges] = [inference.undecided(), inference.edges.len()];
    classified.association.notes.push(format!(
        "the mesh's entity tags do not match the CAD's numbers; mesh and CAD were associated by geometry, with {faces} faces and {edges} edges undecided (--dry-run shows the association)"
    ));
    classified.inference = Some(inference);
    Ok(classified)
}

/// Where tags do not hold, geometry is used if at least this fraction of the faces of every patch that it covers is decided.
const DECIDED: f64 = 0.9;

/// Whether something was decided, and of every patch nearly all or nothing.
fn is_usable(boundary: &Boundary, inference: &Inference) -> bool {
    let mut counts: BTreeMap<_, [usize; 2]> = BTreeMap::new();
    for face in &boundary.faces {
        counts.entry(face.entity).or_default()[0] += 1;
    }
    for (face, _) in &inference.faces {
        counts.entry(boundary.faces[*face].entity).or_default()[1] += 1;
    }
    let decided = |[all, open]: &[usize; 2]| *all - *open;
    counts.values().any(|count| decided(count) > 0)
        && counts.values().all(|count| decided(count) == 0 || decided(count) as f64 >= DECIDED * count[0] as f64)
}
