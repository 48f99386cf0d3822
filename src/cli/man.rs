//! `sagitta man`.

use std::path::{Path, PathBuf};

use clap::{Args, Command};
use clap_mangen::Man;

use crate::cli::exit::DONE;
use crate::cli::output::Failure;
use crate::formats;

/// Options of `sagitta man`.
#[derive(Args)]
pub(super) struct Options {
    /// The folder for them, which is there
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

/// Writes a page of the program and one of each command.
pub(super) fn run(options: &Options, mut program: Command) -> Result<u8, Failure> {
    program.build();
    write(&options.folder, &program)?;
    for command in program.get_subcommands().filter(|command| !command.is_hide_set()) {
        write(&options.folder, command)?;
    }
    Ok(DONE)
}

fn write(folder: &Path, command: &Command) -> Result<(), Failure> {
    let page = Man::new(command.clone());
    let mut text = Vec::new();
    page.render(&mut text)?;
    formats::write_bytes(&folder.join(page.get_filename()), &text)?;
    Ok(())
}
