//! The commands of the `sagitta` program.
//!
//! Exit codes: 0 done and certified, or clean; 1 `validate` has findings; 2 could not run; 3 certified with some faces not on the CAD;
//! 4 not certified (`project`: some feet not proven); 5 stopped early, certified. Results go to stdout, progress and errors to stderr.

mod check;
mod convert;
mod examples;
#[cfg_attr(not(feature = "cad"), allow(dead_code))] // some codes are of commands that need CAD
mod exit;
mod explain;
mod form;
mod info;
mod output;
#[cfg(feature = "cad")]
mod with_cad;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::formats::cgns;
use examples::EXAMPLES;
use exit::{COULD_NOT_RUN, DONE};

/// Curves linear viscous meshes onto their CAD: P1 in, P2, P3 or P4 out, every element certified valid.
#[derive(Parser)]
#[command(name = "sagitta", version, after_help = EXAMPLES)]
struct Program {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "cad")]
    #[command(flatten)]
    WithCad(with_cad::Command),
    /// Certify any mesh of order 1 to 4: is every element's Jacobian positive everywhere?
    #[command(after_help = EXAMPLES)]
    Check(check::Options),
    /// Write a mesh in another format, with its patches and groups
    #[command(after_help = EXAMPLES)]
    Convert(convert::Options),
    /// Tell what the code of a finding means
    #[command(after_help = EXAMPLES)]
    Explain(explain::Options),
    /// Tell what a CAD, mesh or linkage file holds
    #[command(after_help = EXAMPLES)]
    Info(info::Options),
}

/// Runs the program with its arguments, the first of which is its name.
#[must_use]
pub fn run(arguments: Vec<OsString>) -> ExitCode {
    if let [_, word, path] = arguments.as_slice() {
        #[cfg(feature = "cad")]
        if word == cad::READER_SUBCOMMAND {
            return cad::serve_reader(Path::new(path));
        }
        if word == cgns::READER_SUBCOMMAND {
            return cgns::serve_reader(Path::new(path));
        }
    }
    let program = match Program::try_parse_from(arguments) {
        Ok(program) => program,
        Err(error) => {
            let code = if error.use_stderr() { COULD_NOT_RUN } else { DONE };
            // Nothing can be reported to someone whose stderr is gone.
            let _ = error.print();
            return code.into();
        }
    };
    let outcome = match program.command {
        #[cfg(feature = "cad")]
        Command::WithCad(command) => with_cad::run(&command),
        Command::Check(options) => check::run(&options),
        Command::Convert(options) => convert::run(&options),
        Command::Explain(options) => explain::run(&options),
        Command::Info(options) => info::run(&options),
    };
    match outcome {
        Ok(code) => code.into(),
        Err(error) => {
            eprintln!("sagitta: {error}");
            COULD_NOT_RUN.into()
        }
    }
}
