//! `sagitta groups`.

use std::path::PathBuf;

use cad::Model;
use clap::Args;

use super::reading::in_a_child;
use super::values::seconds;
use crate::cli::exit::DONE;
use crate::cli::output::{Failure, print};
use crate::report::Groups;

/// Options of `sagitta groups`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    /// A CAD file: STEP, IGES or BREP
    cad: PathBuf,
    /// Print them as JSON
    #[arg(long)]
    json: bool,
    /// Seconds after which reading the CAD is abandoned
    #[arg(long, value_name = "S", default_value_t = 300.0, value_parser = seconds)]
    cad_timeout: f64,
}

/// Lists the entities and groups of a CAD file.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let model = Model::read(&options.cad, &in_a_child(options.cad_timeout, 1.0))?;
    let groups = Groups::new(&model);
    print(&if options.json { serde_json::to_string_pretty(&groups)? } else { groups.to_string() })?;
    Ok(DONE)
}
