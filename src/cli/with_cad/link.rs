//! `sagitta link`.

use std::path::PathBuf;

use cad::{Model, ReadOptions};
use clap::Args;

use super::reading::Reading;
use super::values::positive;
use crate::associate::{self, Proposal, propose};
use crate::cli::exit::DONE;
use crate::cli::files::Files;
use crate::cli::output::{Beside, Failure, print, write_json};
use crate::cli::{form, input};
use crate::formats;
use crate::mesh::{Boundary, Mesh, Skin};
use crate::validate::read_linear;

/// Options of `sagitta link`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    #[arg(help = form::mesh("The linear mesh"))]
    mesh: PathBuf,
    /// The CAD that the mesh was made on: STEP, IGES or BREP
    #[arg(long, value_name = "FILE")]
    cad: PathBuf,
    /// The MeshLink file to write
    #[arg(short, long, value_name = "LINK.xml")]
    output: PathBuf,
    /// How far a node may be from its CAD entity [default: 1e-5 of the mesh's bounding-box diagonal, at most a tenth of the shortest edge at the node]
    #[arg(long, value_name = "T", value_parser = positive)]
    tolerance: Option<f64>,
    #[command(flatten)]
    reading: Reading,
    /// Ignore the mesh's entity tags
    #[arg(long)]
    ignore_tags: bool,
    /// Also write what was associated, and what not, as JSON
    #[arg(long, value_name = "R.json")]
    report: Option<PathBuf>,
}

/// A mesh that is not on the CAD.
#[derive(Debug, thiserror::Error)]
#[error(
    "{mesh} and {cad}: no face of the mesh lies on the CAD within tolerance; the mesh's bounding-box diagonal is {size:.6}, the CAD's {cad_size:.6}: {hint}"
)]
struct Nothing {
    mesh: String,
    cad: String,
    size: f64,
    cad_size: f64,
    hint: String,
}

/// Associates a mesh with its CAD and writes the linkage.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    Files::of_mesh(&options.mesh)
        .reads("--cad", Some(&options.cad))
        .writes("--output", Some(&options.output))
        .writes("--report", options.report.as_ref())
        .check()?;
    let mesh = read_linear(&options.mesh, &input::reading())?;
    let skin = Skin::of(&mesh);
    let mesh = mesh.with_unmarked(&skin);
    let boundary = Boundary::new(&mesh);
    let reading = options.reading.options();
    let mut model = Model::read(&options.cad, &reading)?;
    let proposal = |model: &Model| propose(&mesh, &boundary, model, options.tolerance, !options.ignore_tags);
    let mut found = proposal(&model);
    if let (true, None, Some(scale)) = (found.candidates.sheets.is_empty(), options.reading.scale(), found.factor) {
        model = Model::read(&options.cad, &ReadOptions { scale, ..reading })?;
        found = proposal(&model);
    }
    let Proposal { candidates, inference, source, factor } = found;
    if candidates.sheets.is_empty() {
        let hint = factor.map_or_else(
            || "are they in the same unit and position? If the mesh is off its CAD, raise --tolerance".to_owned(),
            |factor| format!("if the CAD is in another unit, give --cad-scale {factor} (or --cad-scale auto)"),
        );
        return Err(Box::new(Nothing {
            mesh: options.mesh.display().to_string(),
            cad: options.cad.display().to_string(),
            size: size_of(&mesh),
            cad_size: model.diagonal(),
            hint,
        }));
    }
    let written = associate::document(&candidates, &mesh, &boundary, &model, &options.mesh)?;
    let mut text = Vec::new();
    linkage_schema::write(&written.document, &mut text)?;
    formats::write_bytes(&options.output, &text)?;
    let mut summary = associate::summary(source, &mesh, &boundary, &model, &candidates, inference.as_ref());
    summary.notes.extend(mesh.notes().iter().cloned().chain(model.losses()).chain(written.notes));
    let mut beside = Beside::default();
    if let Some(path) = &options.report {
        beside.tell(write_json(path, &summary));
    }
    beside.tell(print(&format!("{summary}\nwritten: {}", options.output.display())));
    Ok(beside.exit_code(DONE))
}

fn size_of(mesh: &Mesh) -> f64 {
    cad::Aabb::of_points(mesh.points().iter().copied()).diagonal()
}
