//! `sagitta link`.

use std::path::PathBuf;

use clap::Args;

use super::reading::Reading;
use super::values::positive;
use crate::associate::{LinkJob, Linked};
use crate::cli::exit::DONE;
use crate::cli::files::Files;
use crate::cli::help::{INPUT, OUTPUT};
use crate::cli::output::{Beside, Failure, print, write_json};
use crate::cli::tips::not_exchanged;
use crate::cli::{form, input, signals, told};
use crate::formats;
use crate::report::Told;

/// Options of `sagitta link`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    #[arg(help = form::mesh("The linear mesh"))]
    mesh: PathBuf,
    /// The CAD that the mesh was made on: STEP, IGES or BREP
    #[arg(long, value_name = "FILE", help_heading = INPUT)]
    cad: PathBuf,
    /// The MeshLink file to write
    #[arg(short, long, value_name = "LINK.xml", help_heading = OUTPUT)]
    output: PathBuf,
    /// How far a node may be from its CAD entity [default: 1e-5 of the mesh's bounding-box diagonal, at most a tenth of the shortest edge at the node]
    #[arg(long, value_name = "T", value_parser = positive, help_heading = INPUT)]
    tolerance: Option<f64>,
    #[command(flatten)]
    reading: Reading,
    /// Ignore the mesh's entity tags
    #[arg(long, help_heading = INPUT)]
    ignore_tags: bool,
    /// Also write what was associated, and what not, as JSON
    #[arg(long, value_name = "R.json", help_heading = OUTPUT)]
    report: Option<PathBuf>,
}

/// Associates a mesh with its CAD and writes the linkage.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    Files::of_mesh(&options.mesh)
        .reads("--cad", Some(&options.cad))
        .writes("--output", Some(&options.output))
        .writes("--report", options.report.as_ref())
        .check()?;
    not_exchanged(&options.mesh, &options.cad)?;
    let job = LinkJob {
        mesh: options.mesh.clone(),
        cad: options.cad.clone(),
        cad_scale: options.reading.scale(),
        tolerance: options.tolerance,
        by_tags: !options.ignore_tags,
        reading: options.reading.options(),
        mesh_reading: input::reading(),
    };
    let Linked { text, summary } = job.run()?;
    signals::result_is(&options.output, DONE);
    formats::write_bytes(&options.output, &text)?;
    let mut beside = Beside::default();
    if let Some(path) = &options.report {
        beside.tell(write_json(path, &Told { document: &summary, run: told::run(DONE) }));
    }
    beside.tell(print(&format!("{summary}\nwritten: {}", options.output.display())));
    Ok(beside.exit_code(DONE))
}
