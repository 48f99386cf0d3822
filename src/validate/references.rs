//! What the file's references mean in the CAD.

use std::cell::RefCell;

use cad::{EntityId, Model};
use linkage_schema::{Code, Document, Findings, GeometryFile, GeometryId, Resolution, Target};
use rustc_hash::FxHashMap;

use super::called;
use crate::associate::{own_geometry, same_file};

/// Extensions and format names of geometry that OpenCASCADE cannot read.
const FOREIGN: [&str; 5] = ["nmb", "x_t", "x_b", "prt", "catpart"];

/// The CAD entities of every reference, where there is a CAD file that OpenCASCADE read.
#[derive(Debug, Default)]
pub(super) struct Geometry {
    entities: FxHashMap<GeometryId, Vec<EntityId>>,
    /// Those of targets that were asked for: a large group may be asked for often.
    targets: RefCell<FxHashMap<GeometryId, Vec<EntityId>>>,
}

impl Geometry {
    /// Looks all references up, and finds those that lead nowhere and those of the wrong kind.
    pub(super) fn new(
        document: &Document,
        resolution: &Resolution<'_>,
        model: Option<&Model>,
        findings: &mut Findings,
    ) -> Geometry {
        let mut geometry = Geometry::default();
        let own = model.map(|model| own_geometry(document, model.path()));
        for file in &document.geometry_files {
            let given = model.is_some_and(|model| same_file(&file.filename, model.path()));
            if let Some(format) = unreadable(file, resolution).filter(|_| !given) {
                findings.push(Code::UnreadableGeometry, file.origin, || {
                    format!("{:?} is geometry of the format {format}, which OpenCASCADE cannot read", file.filename)
                });
                continue;
            }
            if own.as_ref().is_some_and(|own| !own.iter().any(|own| std::ptr::eq(*own, file))) {
                findings.push(Code::UnreadableGeometry, file.origin, || {
                    format!("{:?} is another CAD file than the one given", file.filename)
                });
                continue;
            }
            if let Some(model) = model {
                geometry.look_up(file, model, findings);
            }
        }
        if model.is_some() {
            resolution.models.iter().for_each(|links| geometry.kinds(links, findings));
        }
        geometry
    }

    fn look_up(&mut self, file: &GeometryFile, model: &Model, findings: &mut Findings) {
        if !same_file(&file.filename, model.path()) {
            findings.push(Code::OtherCadFile, file.origin, || {
                format!("the linkage names CAD {:?}, but {} was given", file.filename, model.path().display())
            });
        }
        for reference in &file.references {
            match model.resolve(&reference.reference) {
                Ok(found) => {
                    // Of doubled ids the first holds.
                    self.entities.entry(reference.id).or_insert(found);
                }
                Err(error) => findings.push(Code::UnknownReference, reference.origin, || error.to_string()),
            }
        }
    }

    /// The entities of a target; none where it was not found, or not looked for.
    pub(super) fn of(&self, target: Option<&Target<'_>>) -> Vec<EntityId> {
        let Some(target) = target else { return Vec::new() };
        if let Some(known) = self.targets.borrow().get(&target.id) {
            return known.clone();
        }
        let members = target.entities.iter();
        let mut all: Vec<EntityId> =
            members.flat_map(|entity| self.entities.get(&entity.id).into_iter().flatten().copied()).collect();
        all.sort_unstable();
        all.dedup();
        self.targets.borrow_mut().insert(target.id, all.clone());
        all
    }

    /// The entities of one reference.
    pub(super) fn of_id(&self, id: GeometryId) -> &[EntityId] {
        self.entities.get(&id).map_or(&[], |found| found)
    }

    fn kinds(&self, links: &linkage_schema::ModelLinks<'_>, findings: &mut Findings) {
        for sheet in &links.sheets {
            for link in &sheet.faces {
                let wrong = self.of(link.target.as_deref()).into_iter().find(|e| !matches!(e, EntityId::Face(_)));
                if let Some(entity) = wrong {
                    findings.push(Code::WrongKind, link.run.origin, || {
                        format!("{} is linked to {entity}, which is not a face", called("MeshSheet", sheet.name()))
                    });
                }
            }
        }
        for string in &links.strings {
            for link in &string.edges {
                let wrong = self.of(link.target.as_deref()).into_iter().find(|e| matches!(e, EntityId::Vertex(_)));
                if let Some(entity) = wrong {
                    findings.push(Code::WrongKind, link.run.origin, || {
                        format!("{} is linked to {entity}, which is not an edge", called("MeshString", string.name()))
                    });
                }
            }
        }
    }
}

/// The format of a geometry file that OpenCASCADE cannot read, by its attribute or its name.
fn unreadable(file: &GeometryFile, resolution: &Resolution<'_>) -> Option<String> {
    let foreign = |word: &str| FOREIGN.iter().any(|own| word.trim().eq_ignore_ascii_case(own));
    let told = resolution.attribute(file.aref, "geometry format").filter(|word| foreign(word));
    let by_name = || file.filename.rsplit_once('.').map(|(_, extension)| extension).filter(|word| foreign(word));
    told.or_else(by_name).map(str::to_uppercase)
}
