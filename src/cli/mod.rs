//! The commands of the `sagitta` program.
//!
//! Exit codes: 0 done and certified; 2 could not run; 3 certified with some faces not on the CAD; 4 not certified;
//! 5 stopped early, certified. Results go to stdout, progress and errors to stderr.

mod check;
mod curve;
mod info;
mod progress;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Done, everything certified and on the CAD.
const DONE: u8 = 0;
/// Wrong use or bad input: nothing was written.
const COULD_NOT_RUN: u8 = 2;
/// Certified, but some boundary faces are not on the CAD as they should be.
const GIVEN_UP: u8 = 3;
/// Not every element is proven valid.
const NOT_CERTIFIED: u8 = 4;
/// Ended before it was done; certified.
const STOPPED: u8 = 5;
/// Interrupted twice: ended at once, nothing was written.
const INTERRUPTED: u8 = 130;

// Narrow, as clap breaks longer lines on an 80-column terminal, where they can no longer be pasted.
const EXAMPLES: &str = "\
Examples:
  sagitta curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --order 3 -o weeble_p3.msh
  sagitta curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      --linkage fixtures/weeble/weeble.meshlink.xml --order 2 \\
      -o weeble_p2.vtu --report weeble_p2.json
  sagitta check weeble_p3.msh --linear fixtures/weeble/weeble.msh
  sagitta info fixtures/weeble/weeble.step

Exit codes: 0 done and certified, 2 could not run, 3 certified with some faces
not on the CAD, 4 not certified, 5 stopped early but certified.";

/// Curves linear viscous meshes onto their CAD: P1 in, P2, P3 or P4 out, every element certified valid.
#[derive(Parser)]
#[command(name = "sagitta", version, after_help = EXAMPLES)]
struct Program {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Curve a linear mesh onto its CAD
    #[command(after_help = EXAMPLES)]
    Curve(Box<curve::Options>),
    /// Certify any mesh of order 1 to 4: is every element's Jacobian positive everywhere?
    #[command(after_help = EXAMPLES)]
    Check(check::Options),
    /// Tell what a CAD, mesh or linkage file holds
    #[command(after_help = EXAMPLES)]
    Info(info::Options),
}

/// Runs the program with its arguments, the first of which is its name.
#[must_use]
pub fn run(arguments: Vec<OsString>) -> ExitCode {
    if let [_, word, path] = arguments.as_slice()
        && word == cad::READER_SUBCOMMAND
    {
        return cad::serve_reader(Path::new(path));
    }
    let program = match Program::try_parse_from(arguments) {
        Ok(program) => program,
        Err(error) => {
            let code = if error.use_stderr() { COULD_NOT_RUN } else { DONE };
            // Nothing can be told to someone whose stderr is gone.
            let _ = error.print();
            return code.into();
        }
    };
    let outcome = match program.command {
        Command::Curve(options) => curve::run(&options),
        Command::Check(options) => check::run(&options),
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

/// Whatever stops a command; its message is complete.
type Failure = Box<dyn std::error::Error>;

/// Prints a result on stdout; a reader that went away is no failure.
fn print(text: &str) -> Result<(), Failure> {
    use std::io::Write;
    match writeln!(std::io::stdout().lock(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Writes a JSON document through a temporary name.
fn write_json(path: &Path, document: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_vec_pretty(document)?;
    crate::formats::write_bytes(path, &text)?;
    Ok(())
}
