//! `sagitta convert`.

use std::path::PathBuf;

use clap::Args;

use super::form::{self, Form};
use super::{input, signals};
use crate::cli::exit::DONE;
use crate::cli::files::Files;
use crate::cli::help::OUTPUT;
use crate::cli::output::{Beside, Failure, print};

/// Options of `sagitta convert`.
#[derive(Args)]
pub(super) struct Options {
    #[arg(help = form::mesh("A mesh of order 1 to 4"))]
    mesh: PathBuf,
    #[arg(short, long, value_name = "OUT", help = form::output("The mesh to write"), help_heading = OUTPUT)]
    output: PathBuf,
    #[command(flatten)]
    form: Form,
}

/// Reads a mesh and writes it in another format.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    Files::of_mesh(&options.mesh).writes_mesh(Some(&options.output), options.form.solver()).check()?;
    options.form.check(std::slice::from_ref(&options.output))?;
    let mesh = input::mesh(&options.mesh)?;
    signals::result_is(&options.output, DONE);
    let written = options.form.write(&options.output, &mesh, &[])?;
    let mut beside = Beside::default();
    let notes: String = mesh.notes().iter().chain(&written).map(|note| format!("note: {note}\n")).collect();
    beside.tell(print(&format!("{notes}written: {}", options.output.display())));
    Ok(beside.exit_code(DONE))
}
