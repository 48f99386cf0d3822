//! Where the association of a mesh comes from: a linkage file, its entity tags, and its geometry, each for what those before leave open.

use std::collections::BTreeSet;

use cad::{Aabb, EntityId, Kind, Model};
use rustc_hash::{FxHashMap, FxHashSet};

use super::flaws::flaws;
use super::host::{is_host, kind_of};
use super::side::SMOOTH;
use super::witnesses::{combined, completed};
use super::{
    AssociateError, Association, Candidates, Doubt, Inference, Linkage, LinkageError, ON_CAD, Tolerance, associate,
    infer, linked, sides,
};
use crate::mesh::{Boundary, EntityKey, Mesh};

/// Where tags do not hold, geometry is used if at least this fraction of the faces of every smooth part that it covers is decided.
const DECIDED: f64 = 0.9;
/// This many faces on CAD of a shape of its own are no chance.
const OWN_SHAPE: usize = 3;

/// What is asked for an association.
#[derive(Clone, Copy, Debug)]
pub struct Sources<'a> {
    /// A MeshLink document.
    pub linkage: Option<&'a Linkage>,
    /// Whether the mesh's entity tags may be the CAD's numbers.
    pub by_tags: bool,
    /// How far a node may be from its CAD entity where geometry decides; [`Tolerance::of`] the mesh where it is not given.
    pub tolerance: Option<f64>,
    /// How far a node may be from what a file or tag names; fraction of the mesh's bounding-box diagonal.
    pub max_offset: f64,
    /// Patches that stay straight.
    pub straight: &'a BTreeSet<EntityKey>,
}

impl<'a> Sources<'a> {
    /// Linkage, tags and geometry at their default tolerances; `straight` patches stay straight.
    #[must_use]
    pub fn new(linkage: Option<&'a Linkage>, straight: &'a BTreeSet<EntityKey>) -> Sources<'a> {
        Sources { linkage, by_tags: true, tolerance: None, max_offset: 1e-3, straight }
    }
}

/// Candidates, checked against the CAD, and where they come from.
#[derive(Debug)]
pub struct Classified {
    /// The candidates.
    pub candidates: Candidates,
    /// The association that they make.
    pub association: Association,
    /// What was inferred, where linkage and tags did not say all.
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

/// Classifies the boundary of a mesh on its CAD: by the linkage where there is one, else by entity tags where they are this CAD's; what these
/// leave open, by geometry.
///
/// # Errors
/// [`ClassifyError`]; where tags do not hold and geometry does not decide either, what is wrong with the tags.
pub fn classify(
    sources: &Sources<'_>,
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
) -> Result<Classified, ClassifyError> {
    let classifier = Classifier { sources, mesh, boundary, model };
    let mut classified = match sources.linkage {
        Some(linkage) => classifier.by_linkage(linkage)?,
        None => classifier.without_linkage()?,
    };
    let association = &mut classified.association;
    association.notes.extend(flaws(model, &association.surfaces));
    Ok(classified)
}

/// Whether geometry decides everything, and something otherwise than the tags say: these are another file's numbers. Tags are held to points
/// by a fraction of the mesh's size, and a mesh with a far field is so large that both sides of a wing are near each other.
fn contradicts(inference: &Inference, tags: &Candidates) -> bool {
    let of = |candidates: &Candidates| -> FxHashMap<usize, Vec<EntityId>> {
        let linked = candidates.sheets.iter().filter(|sheet| !sheet.entities.is_empty());
        linked.flat_map(|sheet| sheet.items.iter().map(|&face| (face, sheet.entities.clone()))).collect()
    };
    let (found, said) = (of(&inference.candidates), of(tags));
    let otherwise = |(face, on): (&usize, &Vec<EntityId>)| {
        found.get(face).is_some_and(|own| on.iter().any(|entity| !own.contains(entity)))
    };
    inference.faces.is_empty() && said.iter().any(otherwise)
}

struct Classifier<'a> {
    sources: &'a Sources<'a>,
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    model: &'a Model,
}

impl Classifier<'_> {
    fn by_linkage(&self, linkage: &Linkage) -> Result<Classified, ClassifyError> {
        let (candidates, file) = (linked(linkage, self.mesh, self.boundary, self.model)?, linkage.file.display());
        let source = format!("linkage file {file}");
        let mut classified = self.held(candidates.clone(), None, source.clone())?;
        let mut notes = Vec::new();
        if !candidates.trusted {
            let note = "names another CAD file; its references were looked up in the given one";
            notes.push(format!("{file} {note}"));
        }
        if !self.is_whole(&candidates) {
            let inference = self.infer();
            let completed = completed(&candidates, &inference, self.boundary, self.sources.straight);
            let mut left = self.left(inference, &candidates);
            if let Some((all, faces)) = completed {
                let what = format!("{file} says nothing of {} boundary faces that lie on the CAD", faces.len());
                match self.held(all, None, format!("{source}, and geometry")) {
                    Ok(whole) => {
                        classified = whole;
                        notes.push(format!("{what}; geometry says where"));
                    }
                    Err(why) => {
                        notes.push(format!("{what}, and what geometry says of them does not go with it: {why}"));
                        left.faces.extend(faces.into_iter().map(|(face, on)| (face, Doubt::Unfit(on))));
                    }
                }
            }
            classified.inference = Some(left);
        }
        classified.association.notes.extend(notes);
        Ok(classified)
    }

    fn without_linkage(&self) -> Result<Classified, AssociateError> {
        let (mesh, boundary, model) = (self.mesh, self.boundary, self.model);
        let tags =
            if self.sources.by_tags { Candidates::by_tags(mesh, boundary, model) } else { Candidates::default() };
        let by_tags = self.held(tags.clone(), None, "the mesh's entity tags".into());
        let is_near = |own: &Classified| own.association.farthest <= ON_CAD * self.model.diagonal();
        match &by_tags {
            Ok(own) if self.is_whole(&tags) && is_near(own) => return by_tags,
            _ => {}
        }
        let mut inference = self.infer();
        let contradicted = contradicts(&inference, &tags);
        match &by_tags {
            Ok(_) if self.is_whole(&tags) && !contradicted => return by_tags,
            Err(error) if !error.tags_are_of_no_use() && !contradicted => return by_tags,
            _ => {}
        }
        if contradicted {
            return self.by_geometry(inference.candidates.clone(), inference, "geometry");
        }
        if by_tags.is_err() && !self.is_usable(&inference) {
            // Mesh and CAD of different sizes or positions may have some faces in common.
            return by_tags.map_err(|error| self.explained(error, &inference));
        }
        let combined = combined(&tags, &mut inference, mesh, boundary, model, self.sources.max_offset);
        let Some((candidates, source)) = combined else {
            let mut classified = by_tags?;
            classified.inference = Some(inference);
            return Ok(classified);
        };
        self.by_geometry(candidates, inference, source)
    }

    fn by_geometry(
        &self,
        candidates: Candidates,
        inference: Inference,
        source: &str,
    ) -> Result<Classified, AssociateError> {
        let [faces, edges] = [inference.undecided(), inference.edges.len()];
        let mut classified = self.held(candidates, Some(inference), source.into())?;
        let why = if self.sources.by_tags { "the mesh's entity tags do not match the CAD's numbers; " } else { "" };
        classified.association.notes.push(format!(
            "{why}mesh and CAD were associated by geometry, with {faces} faces and {edges} edges undecided (--dry-run shows the association)"
        ));
        Ok(classified)
    }

    fn infer(&self) -> Inference {
        let tolerance = self.sources.tolerance.map_or_else(|| Tolerance::of(self.mesh), Tolerance::fixed);
        infer(self.mesh, self.boundary, self.model, &tolerance)
    }

    /// Checked against the CAD, without what is to stay straight.
    fn held(
        &self,
        mut candidates: Candidates,
        inference: Option<Inference>,
        source: String,
    ) -> Result<Classified, AssociateError> {
        candidates.leave_straight(self.boundary, self.sources.straight);
        let offset = self.sources.max_offset;
        let mut association = associate(self.mesh, self.boundary, self.model, &candidates, offset)?;
        association.notes.extend(self.model.losses());
        association.notes.append(&mut candidates.notes);
        Ok(Classified { candidates, association, inference, source })
    }

    /// Whether candidates say of every boundary face that is not to stay straight where it lies.
    fn is_whole(&self, candidates: &Candidates) -> bool {
        let said = candidates.linked_faces();
        let stays = |face: usize| self.sources.straight.contains(&self.boundary.faces[face].entity);
        (0..self.boundary.faces.len()).all(|face| said.contains(&face) || stays(face))
    }

    /// An inference without doubts of faces of which others say where they lie.
    fn left(&self, mut inference: Inference, candidates: &Candidates) -> Inference {
        let said = candidates.linked_faces();
        inference.faces.retain(|(face, _)| !said.contains(face));
        inference
    }

    /// Whether something was decided; and of every smooth part of a patch nearly all or nothing, or else something that no other CAD has by chance.
    fn is_usable(&self, inference: &Inference) -> bool {
        let open: FxHashSet<usize> = inference.faces.iter().map(|(face, _)| *face).collect();
        let whole = |part: &Vec<usize>| {
            let decided = part.iter().filter(|face| !open.contains(face)).count();
            decided == 0 || decided as f64 >= DECIDED * part.len() as f64
        };
        open.len() < self.boundary.faces.len()
            && (self.smooth_parts().iter().all(whole) || self.has_own_shape(&inference.candidates))
    }

    /// The boundary faces, by patch and by the sharp edges of the mesh within it.
    fn smooth_parts(&self) -> Vec<Vec<usize>> {
        let (boundary, sides) = (self.boundary, sides(self.mesh, self.boundary));
        let entity = |face: usize| boundary.faces[face].entity;
        let mut neighbours = vec![Vec::new(); boundary.faces.len()];
        for faces in &boundary.edge_faces {
            let &[a, b] = &faces[..] else { continue };
            if entity(a) == entity(b) && sides[a].normal.dot(sides[b].normal) >= SMOOTH {
                neighbours[a].push(b);
                neighbours[b].push(a);
            }
        }
        let (mut seen, mut parts) = (vec![false; boundary.faces.len()], Vec::new());
        for first in 0..boundary.faces.len() {
            let (mut part, mut next) = (Vec::new(), vec![first]);
            while let Some(face) = next.pop() {
                if !std::mem::replace(&mut seen[face], true) {
                    part.push(face);
                    next.extend(&neighbours[face]);
                }
            }
            parts.extend((!part.is_empty()).then_some(part));
        }
        parts
    }

    /// Whether faces were found on CAD of a shape that no scaled or shifted copy of it has in common with it.
    fn has_own_shape(&self, candidates: &Candidates) -> bool {
        let is_own = |entity: &EntityId| {
            let kind = kind_of(self.model, *entity).filter(|_| is_host(self.boundary, *entity));
            let common =
                |kind| matches!(kind, Kind::Plane | Kind::Cone | Kind::Cylinder | Kind::Extrusion | Kind::Line);
            kind.is_some_and(|kind| !common(kind))
        };
        let own = candidates.sheets.iter().filter(|sheet| sheet.entities.iter().any(is_own));
        own.map(|sheet| sheet.items.len()).sum::<usize>() >= OWN_SHAPE
    }

    /// What is wrong, where neither tags nor geometry find anything: units, or how far the mesh is off the CAD.
    fn explained(&self, error: AssociateError, inference: &Inference) -> AssociateError {
        if !matches!(error, AssociateError::Nothing { .. }) {
            return error;
        }
        let size = Aabb::of_points(self.mesh.points().iter().copied()).diagonal();
        let found_none = inference.candidates.sheets.is_empty();
        if let Some(factor) = cad::unit_factor(size, self.model.diagonal()).filter(|_| found_none) {
            return AssociateError::Scale { mesh: size, cad: self.model.diagonal(), factor };
        }
        let beside = inference.faces.iter().filter_map(|(face, doubt)| Some((*face, doubt.distance()?)));
        match beside.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((face, distance)) => {
                let label = self.mesh.label(self.boundary.faces[face].entity);
                AssociateError::Apart { label, distance, tolerance: 2.0 * distance }
            }
            None => error,
        }
    }
}
