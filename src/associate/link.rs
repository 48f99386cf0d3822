//! A linkage file from files: which of a mesh's boundary lies on which CAD.

use std::path::{Path, PathBuf};

use cad::{Aabb, Model, ReadOptions};

use super::{Proposal, Summary, TooLarge, Written, document, propose, summary};
use crate::element::Order;
use crate::formats;
use crate::mesh::{Boundary, Mesh, Skin};

/// What is to be linked, and how.
#[derive(Clone, Debug)]
pub struct LinkJob {
    /// The linear mesh.
    pub mesh: PathBuf,
    /// The CAD it was made on.
    pub cad: PathBuf,
    /// What the CAD is multiplied by; `None` finds the factor between known units that makes it fit.
    pub cad_scale: Option<f64>,
    /// How far a node may be from its CAD entity where geometry decides, in the mesh's unit; `None` takes what the mesh allows.
    pub tolerance: Option<f64>,
    /// Whether the mesh's entity tags may be the CAD's numbers.
    pub by_tags: bool,
    /// How the CAD is read.
    pub reading: ReadOptions,
    /// How the mesh is read.
    pub mesh_reading: formats::ReadOptions,
}

/// A linkage, and what of the mesh it links.
#[derive(Debug)]
pub struct Linked {
    /// The MeshLink document, as a file has it.
    pub text: Vec<u8>,
    /// What was associated, and what not.
    pub summary: Summary,
}

/// Why a linear mesh could not be read.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the causes say it
pub enum ReadLinearError {
    #[error(transparent)]
    Mesh(#[from] formats::Error),
    #[error("{}: is of order {order}; linkage files refer to linear meshes: give the one that it was made from", mesh.display())]
    NotLinear { mesh: PathBuf, order: Order },
}

/// Why a mesh was not linked.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the causes say it
pub enum LinkError {
    #[error(transparent)]
    Mesh(#[from] ReadLinearError),
    #[error(transparent)]
    Cad(#[from] cad::ReadError),
    /// The mesh is not on the CAD.
    #[error(
        "{mesh} and {cad}: no face of the mesh lies on the CAD within tolerance; the mesh's bounding-box diagonal is {size:.6}, the CAD's {cad_size:.6}: {hint}"
    )]
    Nothing { mesh: String, cad: String, size: f64, cad_size: f64, hint: String },
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    #[error(transparent)]
    Write(#[from] linkage_schema::WriteError),
}

/// Reads a mesh that linkage can speak of: a linear one.
///
/// # Errors
/// [`ReadLinearError`].
pub fn read_linear(path: &Path, reading: &formats::ReadOptions) -> Result<Mesh, ReadLinearError> {
    linear(path, formats::read_with(path, reading)?)
}

fn linear(path: &Path, mesh: Mesh) -> Result<Mesh, ReadLinearError> {
    if mesh.order() != Order::LINEAR {
        return Err(ReadLinearError::NotLinear { mesh: path.to_owned(), order: mesh.order() });
    }
    Ok(mesh)
}

impl LinkJob {
    /// Reads the files and associates the mesh with its CAD.
    ///
    /// # Errors
    /// [`LinkError`].
    pub fn run(&self) -> Result<Linked, LinkError> {
        self.run_on(formats::read_with(&self.mesh, &self.mesh_reading).map_err(ReadLinearError::Mesh)?)
    }

    /// As [`LinkJob::run`], on a mesh that is in memory: [`LinkJob::mesh`] is what messages and the linkage call it.
    ///
    /// # Errors
    /// Those of [`LinkJob::run`].
    pub fn run_on(&self, mesh: Mesh) -> Result<Linked, LinkError> {
        let mesh = linear(&self.mesh, mesh)?;
        let skin = Skin::of(&mesh);
        let mesh = mesh.with_unmarked(&skin);
        let boundary = Boundary::new(&mesh);
        let read = |scale| Model::read(&self.cad, &ReadOptions { scale, ..self.reading.clone() });
        let mut model = read(self.cad_scale.unwrap_or(1.0))?;
        let proposal = |model: &Model| propose(&mesh, &boundary, model, self.tolerance, self.by_tags);
        let mut found = proposal(&model);
        if let (true, None, Some(scale)) = (found.candidates.sheets.is_empty(), self.cad_scale, found.factor) {
            model = read(scale)?;
            found = proposal(&model);
        }
        let Proposal { candidates, inference, source, factor } = found;
        if candidates.sheets.is_empty() {
            return Err(self.nothing(&mesh, &model, factor));
        }
        let written = document(&candidates, &mesh, &boundary, &model, &self.mesh)?;
        let Written { document, notes } = written;
        let mut text = Vec::new();
        linkage_schema::write(&document, &mut text)?;
        let mut summary = summary(source, &mesh, &boundary, &model, &candidates, inference.as_ref());
        summary.notes.extend(mesh.notes().iter().cloned().chain(model.losses()).chain(notes));
        Ok(Linked { text, summary })
    }

    fn nothing(&self, mesh: &Mesh, model: &Model, factor: Option<f64>) -> LinkError {
        let hint = factor.map_or_else(
            || "are they in the same unit and position? If the mesh is off its CAD, raise --tolerance".to_owned(),
            |factor| format!("if the CAD is in another unit, give --cad-scale {factor} (or --cad-scale auto)"),
        );
        LinkError::Nothing {
            mesh: self.mesh.display().to_string(),
            cad: self.cad.display().to_string(),
            size: Aabb::of_points(mesh.points().iter().copied()).diagonal(),
            cad_size: model.diagonal(),
            hint,
        }
    }
}
