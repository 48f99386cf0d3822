//! The commands of the `sagitta` program.
//!
//! Exit codes: 0 done and certified, or clean; 1 `validate` has findings; 2 could not run; 3 certified with some faces not on the CAD;
//! 4 not certified (`project`: some feet not proven); 5 stopped early, certified. Results go to stdout, progress and errors to stderr.

mod check;
mod convert;
mod curve;
mod explain;
mod form;
mod groups;
mod info;
mod keeper;
mod link;
mod points;
mod progress;
mod project;
mod reading;
mod trace;
mod validate;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::formats::cgns;

/// Done, everything certified and on the CAD.
const DONE: u8 = 0;
/// A linkage file has findings.
const FINDINGS: u8 = 1;
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
  sagitta link fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step \\
      -o weeble_link.xml
  sagitta validate fixtures/weeble/weeble.meshlink.xml \\
      --mesh fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step
  sagitta explain ML503
  sagitta info fixtures/weeble/weeble.step
  sagitta groups fixtures/weeble/weeble.step
  sagitta project fixtures/weeble/weeble.step fixtures/samples/points.csv \\
      --group face:2,face:3 -o feet.csv --report feet.json
  sagitta convert weeble_p3.msh -o weeble_p3.cgns

Exit codes: 0 done and certified, or clean; 1 findings (validate only);
2 could not run; 3 certified with some faces not on the CAD; 4 not certified
(project: some feet not proven to be the closest); 5 stopped early but certified.";

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
    /// Write a mesh in another format, with its patches and groups
    #[command(after_help = EXAMPLES)]
    Convert(convert::Options),
    /// Write the linkage file of a mesh: which of its faces, edges and points lie on which CAD entities
    #[command(after_help = EXAMPLES)]
    Link(link::Options),
    /// Check a linkage file: alone, against its mesh, against its CAD
    #[command(after_help = EXAMPLES)]
    Validate(validate::Options),
    /// Tell what the code of a finding means
    #[command(after_help = EXAMPLES)]
    Explain(explain::Options),
    /// Tell what a CAD, mesh or linkage file holds
    #[command(after_help = EXAMPLES)]
    Info(info::Options),
    /// List the entities and ready groups of a CAD file, by the references that commands and linkage files take
    #[command(after_help = EXAMPLES)]
    Groups(groups::Options),
    /// Project points on CAD: the closest point of a set of faces and edges, and whether it is proven
    #[command(after_help = EXAMPLES)]
    Project(project::Options),
}

/// Runs the program with its arguments, the first of which is its name.
#[must_use]
pub fn run(arguments: Vec<OsString>) -> ExitCode {
    if let [_, word, path] = arguments.as_slice() {
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
            // Nothing can be told to someone whose stderr is gone.
            let _ = error.print();
            return code.into();
        }
    };
    let outcome = match program.command {
        Command::Curve(options) => curve::run(&options),
        Command::Check(options) => check::run(&options),
        Command::Convert(options) => convert::run(&options),
        Command::Link(options) => link::run(&options),
        Command::Validate(options) => validate::run(&options),
        Command::Explain(options) => explain::run(&options),
        Command::Info(options) => info::run(&options),
        Command::Groups(options) => groups::run(&options),
        Command::Project(options) => project::run(&options),
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
