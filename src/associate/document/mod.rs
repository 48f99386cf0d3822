//! Candidates as a MeshLink document.

mod geometry;
mod model;
mod patches;
mod periodic;

use std::path::Path;

use cad::Model;
use linkage_schema::{Attribute, AttributeId, Document, GeometryFile, MeshFile, Origin};

use super::{Candidates, Numbering};
use crate::mesh::{Boundary, Mesh};
use geometry::Ids;
use model::Models;

/// A mesh that MeshLink's 32-bit indices cannot speak of.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("node number {0} is beyond {max}, the largest that MeshLink can write; renumber the mesh's nodes", max = u32::MAX)]
pub struct TooLarge(u64);

/// A document, and what of the mesh it does not say.
#[derive(Debug)]
pub struct Written {
    /// The document.
    pub document: Document,
    /// What was left out.
    pub notes: Vec<String>,
}

/// The document that says what the candidates say.
///
/// One model a zone of the mesh file, whose points it counts, or one for all, which has the mesh's node numbers. One sheet a patch, on its CAD
/// face or on the group of its CAD faces, each run of its faces on the one that holds them; one string a connected path on a CAD edge.
/// Entities are written as `face-3`, `edge-2`, `vertex-1`. Periodic pairs of patches of the mesh are linked to one another.
///
/// # Errors
/// [`TooLarge`].
pub fn document(
    candidates: &Candidates,
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    mesh_file: &Path,
) -> Result<Written, TooLarge> {
    let candidates = &candidates.clone().into_written(boundary);
    let numbering = Numbering::new(mesh);
    let ids = Ids::new(candidates, mesh, boundary);
    let models = Models::new(candidates, mesh, boundary, &numbering, &ids)?;
    let attribute = |number: u32, name: &str, value: String| {
        let id = AttributeId::new(number)?;
        Some(Attribute { id, name: Some(name.into()), value, origin: Origin::MADE })
    };
    let generator = format!("sagitta {}", env!("CARGO_PKG_VERSION"));
    let mut attributes =
        vec![attribute(1, "mesh generator", generator), attribute(2, "geometry format", model.format().to_string())];
    let pairs = periodic::pairs(mesh, boundary, &models, AttributeId::new(3));
    if !pairs.linkages.is_empty() {
        attributes.push(attribute(3, "linkage type", "periodic".to_owned()));
    }
    let (references, geometry_groups) = ids.geometry();
    let document = Document {
        version: "1.0".into(),
        attributes: attributes.into_iter().flatten().collect(),
        geometry_files: vec![GeometryFile {
            filename: file_name(model.path()),
            aref: AttributeId::new(2),
            references,
            origin: Origin::MADE,
        }],
        geometry_groups,
        mesh_files: vec![MeshFile {
            filename: file_name(mesh_file),
            aref: None,
            models: models.all,
            origin: Origin::MADE,
        }],
        transforms: pairs.transforms,
        linkages: pairs.linkages,
        ..Document::default()
    };
    Ok(Written { document, notes: pairs.notes })
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
