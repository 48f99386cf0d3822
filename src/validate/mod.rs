//! Does a linkage file belong to its mesh and its CAD: what `sagitta validate` finds.
//!
//! ```text
//!  alone        structure, contents, references (linkage-schema); faces given twice, strings that are no path   ML0.. to ML4..
//!  with a mesh  index base, another mesh, faces off the boundary, coverage, periodic pairs                      ML4..
//!  with CAD     references, kinds, distances, sides, parameters, sharp edges                                    ML5..
//! ```
//!
//! Where a defect would make hundreds of others (a file that counts from 0, a mesh of another case, a CAD in another unit), it is named once and
//! what follows from it is not.

mod alone;
mod coverage;
mod distances;
mod linked_mesh;
mod mesh_links;
mod parameters;
mod periodic;
mod references;
mod sharp_edges;
mod text;
mod wrong_sides;

use std::path::{Path, PathBuf};

use cad::{Aabb, Model, ReadOptions};
use linkage_schema::{Code, Findings, ModelLinks, Position, ReadError, Resolution, Severity};
use schemars::JsonSchema;
use serde::Serialize;

use crate::associate::{Numbering, ON_CAD, ReadLinearError, models_of, read_linear, sides};
use crate::formats;
use crate::mesh::Boundary;
pub use coverage::Coverage;
pub use distances::Measured;
use linked_mesh::LinkedMesh;
use references::Geometry;

/// Name and version of the JSON document.
pub const SCHEMA: &str = "sagitta-validation-2";

/// What is to be checked against what.
#[derive(Clone, Debug)]
pub struct Job {
    /// The linkage file.
    pub linkage: PathBuf,
    /// The mesh that it speaks of.
    pub mesh: Option<PathBuf>,
    /// The CAD that it speaks of.
    pub cad: Option<PathBuf>,
    /// How far a linked point may be from its CAD entity, in the mesh's unit. Default 1e-5 of the mesh's bounding-box diagonal.
    pub tolerance: Option<f64>,
    /// What the CAD is multiplied by; `None` finds the factor between units that fits.
    pub cad_scale: Option<f64>,
    /// How the CAD is read.
    pub reading: ReadOptions,
    /// How the mesh is read.
    pub mesh_reading: formats::ReadOptions,
}

/// Why nothing could be validated.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the causes say it
pub enum ValidateError {
    #[error(transparent)]
    Linkage(#[from] ReadError),
    #[error(transparent)]
    Mesh(#[from] ReadLinearError),
    #[error(transparent)]
    Cad(#[from] cad::ReadError),
}

/// What was found.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Validation {
    /// Name and version of this document.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// The linkage file.
    pub linkage: PathBuf,
    /// The mesh, if one was given.
    pub mesh: Option<PathBuf>,
    /// The CAD, if one was given.
    pub cad: Option<PathBuf>,
    /// What the CAD was multiplied by.
    pub cad_scale: f64,
    /// Findings, by their place in the file; of each kind the first 200.
    pub findings: Vec<Found>,
    /// How many there were, kept or not.
    pub errors: usize,
    /// Likewise.
    pub warnings: usize,
    /// Likewise; notes are no defects.
    pub notes: usize,
    /// Linked faces of each boundary patch of the mesh.
    pub coverage: Vec<Coverage>,
    /// How far the points of each sheet are from the CAD.
    pub sheets: Vec<Measured>,
    /// How far the points of each string are.
    pub strings: Vec<Measured>,
    /// How far single points are.
    pub points: Vec<Measured>,
    /// The tolerance for these distances.
    pub tolerance: Option<f64>,
}

/// A finding as it is reported.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Found {
    /// Its stable code.
    pub code: &'static str,
    /// `error`, `warning` or `note`.
    pub severity: &'static str,
    /// Line in the linkage file, from 1.
    pub line: Option<u32>,
    /// Byte in the line, from 1.
    pub column: Option<u32>,
    /// What is wrong.
    pub message: String,
    /// How to fix it.
    pub remedy: &'static str,
}

impl Validation {
    /// Whether there is nothing to fix; with `strict` notes count too.
    #[must_use]
    pub fn is_clean(&self, strict: bool) -> bool {
        self.errors + self.warnings == 0 && (!strict || self.notes == 0)
    }

    fn new(job: &Job) -> Validation {
        Validation {
            schema: SCHEMA,
            linkage: job.linkage.clone(),
            mesh: job.mesh.clone(),
            cad: job.cad.clone(),
            cad_scale: job.cad_scale.unwrap_or(1.0),
            findings: Vec::new(),
            errors: 0,
            warnings: 0,
            notes: 0,
            coverage: Vec::new(),
            sheets: Vec::new(),
            strings: Vec::new(),
            points: Vec::new(),
            tolerance: None,
        }
    }

    fn close(mut self, findings: &Findings) -> Validation {
        let mut found: Vec<_> = findings.iter().collect();
        found.sort_by_key(|finding| finding.position());
        self.findings = found.into_iter().map(Found::new).collect();
        self.errors = findings.errors();
        self.warnings = findings.of(Severity::Warning);
        self.notes = findings.of(Severity::Note);
        self
    }
}

impl Found {
    fn new(finding: &linkage_schema::Finding) -> Found {
        let position = finding.position();
        Found {
            code: finding.code.id(),
            severity: match finding.severity() {
                Severity::Note => "note",
                Severity::Warning => "warning",
                Severity::Error => "error",
            },
            line: position.map(|p: Position| p.line.get()),
            column: position.map(|p: Position| p.column.get()),
            message: finding.message.clone(),
            remedy: finding.code.remedy(),
        }
    }
}

/// Validates a linkage file, with its mesh and its CAD as far as they are given.
///
/// # Errors
/// [`ValidateError`]: a file that cannot be read. A linkage file that is broken is a finding.
pub fn validate(job: &Job) -> Result<Validation, ValidateError> {
    let mut validation = Validation::new(job);
    let mesh = job.mesh.as_deref().map(|path| read_linear(path, &job.mesh_reading)).transpose()?;
    let read = |path: &Path, scale| Model::read(path, &ReadOptions { scale, ..job.reading.clone() });
    let mut model = job.cad.as_deref().map(|path| read(path, validation.cad_scale)).transpose()?;
    let reading = match linkage_schema::read_path(&job.linkage) {
        Ok(reading) => reading,
        Err(error @ (ReadError::Open { .. } | ReadError::Io { .. })) => return Err(error.into()),
        Err(error) => return Ok(validation.close(&broken(&job.linkage, &error))),
    };
    let mut findings = reading.findings.clone();
    let resolution = linkage_schema::resolve(&reading.document);
    findings.append(&resolution.findings);
    let models: Vec<&ModelLinks<'_>> = of_this_mesh(&resolution, job.mesh.as_deref(), &mut findings);
    alone::check(&reading.document, &models, &mut findings);
    let geometry = Geometry::new(&reading.document, &resolution, model.as_ref(), &mut findings);
    let boundary = mesh.as_ref().map(Boundary::new).unwrap_or_default();
    if let Some(mesh) = &mesh {
        let sides = sides(mesh, &boundary);
        let numbering = Numbering::new(mesh);
        let models = of_known_zones(&models, &numbering, &mut findings);
        let linked = LinkedMesh::new(mesh, &boundary, &sides, &numbering, &models, &mut findings);
        if let Some(linked) = linked {
            mesh_links::check(&linked, &models, &mut findings);
            validation.coverage = coverage::check(&linked, &models, &mut findings);
            periodic::check(&linked, &resolution, &mut findings);
            let fitting = model.as_ref().and_then(|model| distances::unit_factor(&linked, &models, model, &geometry));
            if let (None, Some(cad), Some(factor)) = (job.cad_scale, &job.cad, fitting) {
                validation.cad_scale = factor;
                model = Some(read(cad, factor)?);
            }
            if let Some(model) = &model {
                with_cad(job, &linked, &models, model, &geometry, &mut findings, &mut validation);
            }
        }
    }
    // Without the file, which was there a moment ago, findings stay at their elements.
    let again = cad::regular::open(&job.linkage).map(std::io::BufReader::new);
    again.and_then(|stream| findings.place_words(stream)).unwrap_or_default();
    Ok(validation.close(&findings))
}

/// The checks that need all three.
fn with_cad(
    job: &Job,
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
    findings: &mut Findings,
    validation: &mut Validation,
) {
    let size = Aabb::of_points(linked.mesh.points().iter().copied()).diagonal();
    let tolerance = job.tolerance.unwrap_or(ON_CAD * size);
    validation.tolerance = Some(tolerance);
    if !distances::same_scale(linked, models, model, geometry, findings) {
        return;
    }
    let measured = distances::check(linked, models, model, geometry, tolerance, findings);
    [validation.sheets, validation.strings, validation.points] = measured;
    wrong_sides::check(linked, models, model, geometry, tolerance, findings);
    parameters::check(linked, models, model, geometry, tolerance, findings);
    sharp_edges::check(linked, models, model, geometry, job.tolerance, findings);
}

/// A file of which nothing could be read, as a finding.
fn broken(file: &Path, error: &ReadError) -> Findings {
    let mut findings = Findings::default();
    let position = error.position().unwrap_or(Position::START);
    let text = error.to_string();
    let message = text.strip_prefix(&format!("{}:{position}: ", file.display())).unwrap_or(&text).to_owned();
    findings.push(Code::Unreadable, position.into(), || message);
    findings
}

/// The models of the given mesh file: of the one that the document names, if it does.
fn of_this_mesh<'r, 'a>(
    resolution: &'r Resolution<'a>,
    mesh: Option<&Path>,
    findings: &mut Findings,
) -> Vec<&'r ModelLinks<'a>> {
    let all = || resolution.models.iter();
    let Some(path) = mesh else { return all().collect() };
    let own = models_of(resolution, path);
    if !own.is_empty() {
        return own;
    }
    if let Some(first) = resolution.models.first() {
        findings.push(Code::OtherMeshFile, first.file.origin, || {
            format!("the linkage names mesh {:?}, but {} was given", first.file.filename, path.display())
        });
    }
    all().collect()
}

/// The models of the zones that the mesh file has.
fn of_known_zones<'r, 'a>(
    models: &[&'r ModelLinks<'a>],
    numbering: &Numbering<'_>,
    findings: &mut Findings,
) -> Vec<&'r ModelLinks<'a>> {
    let mut known = Vec::new();
    for links in models {
        match numbering.part(&links.model.reference) {
            Ok(_) => known.push(*links),
            Err(error) => findings.push(Code::UnknownZone, links.model.origin, || error.to_string()),
        }
    }
    known
}

/// What people call a container.
fn called(what: &str, name: Option<&str>) -> String {
    name.map_or_else(|| what.to_owned(), |name| format!("{what} {name:?}"))
}
