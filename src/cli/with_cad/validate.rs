//! `sagitta validate`.

use std::path::PathBuf;

use clap::Args;

use super::reading::Reading;
use super::values::positive;
use crate::cli::exit::{DONE, FINDINGS};
use crate::cli::help::{INPUT, OUTPUT};
use crate::cli::output::{Failure, print};
use crate::cli::told;
use crate::report::Told;
use crate::validate::{self, Job};

/// Options of `sagitta validate`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    /// The MeshLink file
    linkage: PathBuf,
    /// The linear mesh that it was written for
    #[arg(long, value_name = "FILE", help_heading = INPUT)]
    mesh: Option<PathBuf>,
    /// The CAD that it was written for: STEP, IGES or BREP
    #[arg(long, value_name = "FILE", help_heading = INPUT)]
    cad: Option<PathBuf>,
    /// How far a linked point may be from its CAD entity [default: 1e-5 of the mesh's bounding-box diagonal]
    #[arg(long, value_name = "T", value_parser = positive, help_heading = INPUT)]
    tolerance: Option<f64>,
    #[command(flatten)]
    reading: Reading,
    /// Print the findings as JSON
    #[arg(long, help_heading = OUTPUT)]
    json: bool,
    /// Count notes as findings
    #[arg(long, help_heading = OUTPUT)]
    strict: bool,
}

/// Validates a linkage file and prints what was found.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let validation = validate::validate(&Job {
        linkage: options.linkage.clone(),
        mesh: options.mesh.clone(),
        cad: options.cad.clone(),
        tolerance: options.tolerance,
        cad_scale: options.reading.scale(),
        reading: options.reading.options(),
        mesh_reading: crate::cli::input::reading(),
    })?;
    let code = if validation.is_clean(options.strict) { DONE } else { FINDINGS };
    if options.json {
        print(&serde_json::to_string_pretty(&Told { document: &validation, run: told::run(code) })?)?;
    } else {
        print(&validation.to_string())?;
    }
    Ok(code)
}
