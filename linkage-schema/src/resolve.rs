//! Resolving: ids become what they stand for, and what does not stand for anything becomes a finding.

mod checks;
mod elements;
mod links;
mod tables;

use std::path::Path;
use std::sync::Arc;

pub use elements::{ElementPair, MeshElement};
pub use links::{EdgeLink, EntityLink, FaceLink, ModelLinks, PointLink, SheetLinks, StringLinks};
pub use tables::{Entity, Target};

use crate::{Attribute, AttributeId, Document, Findings, GeometryId, Refused};
use tables::{AttributeTable, GeometryTable, TransformTable};

/// A document with all its references followed.
#[derive(Debug)]
pub struct Resolution<'a> {
    /// The mesh models of all mesh files, in the order of the document.
    pub models: Vec<ModelLinks<'a>>,
    /// Mesh elements of which one follows the other.
    pub pairs: Vec<ElementPair<'a>>,
    /// What is wrong.
    pub findings: Findings,
    geometry: GeometryTable<'a>,
    attributes: AttributeTable<'a>,
}

/// Follows all references of a document.
pub fn resolve(document: &Document) -> Resolution<'_> {
    let mut findings = Findings::default();
    let attributes = AttributeTable::new(document, &mut findings);
    let geometry = GeometryTable::new(document, &mut findings);
    let transforms = TransformTable::new(document, &mut findings);
    checks::attribute_references(document, &attributes, &mut findings);
    let mut models = Vec::new();
    for file in &document.mesh_files {
        for model in &file.models {
            models.push(links::model(file, model, &geometry, &mut findings));
            checks::model(model, &mut findings);
        }
    }
    let pairs = elements::pairs(document, &transforms, &mut findings);
    Resolution { models, pairs, findings, geometry, attributes }
}

impl<'a> Resolution<'a> {
    /// What a `gref` stands for.
    pub fn target(&self, gref: GeometryId) -> Option<&Arc<Target<'a>>> {
        self.geometry.get(gref)
    }

    /// The attributes behind an `aref`, groups opened, each once.
    pub fn attributes(&self, aref: Option<AttributeId>) -> Vec<&'a Attribute> {
        aref.map(|id| self.attributes.open(id)).unwrap_or_default()
    }

    /// The value of the attribute with this name behind an `aref`, without blanks around it.
    pub fn attribute(&self, aref: Option<AttributeId>, name: &str) -> Option<&'a str> {
        let attributes = self.attributes(aref);
        attributes.into_iter().find(|attribute| attribute.name.as_deref() == Some(name)).map(|found| found.value.trim())
    }

    /// The resolution, if it has no errors; `file` is the document's name in the message.
    pub fn accept(self, file: &Path) -> Result<Self, Refused> {
        Refused::check(file, &self.findings)?;
        Ok(self)
    }
}
