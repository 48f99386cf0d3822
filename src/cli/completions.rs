//! `sagitta completions`.

use clap::{Args, Command};
use clap_complete::Shell;

use crate::cli::exit::DONE;
use crate::cli::output::{Failure, print};

/// Options of `sagitta completions`.
#[derive(Args)]
pub(super) struct Options {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Prints what a shell reads to complete commands and options of the program.
pub(super) fn run(options: &Options, mut program: Command) -> Result<u8, Failure> {
    let name = program.get_name().to_owned();
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut program, name, &mut script);
    print(std::str::from_utf8(&script)?.trim_end())?;
    Ok(DONE)
}
