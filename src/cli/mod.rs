//! The commands of the `sagitta` program.
//!
//! Arguments are parsed here and results printed; the work is that of the library. Results go to stdout, progress and messages to stderr.
//!
//! Exit codes: 0 done and certified, or clean; 1 `validate` has findings; 2 could not run; 3 certified with some faces off the CAD;
//! 4 not certified (`project`: some closest points not proven); 5 stopped early, certified; 6 as 0, but something beside the result
//! could not be written; 130 interrupted before there was anything to keep, or twice.

mod check;
mod completions;
mod convert;
#[cfg_attr(not(feature = "cad"), allow(dead_code))] // some codes are of commands that need CAD
mod exit;
mod explain;
mod files;
mod form;
mod help;
mod info;
mod input;
mod man;
mod output;
mod page;
mod picture;
mod report;
mod signals;
mod threads;
mod tips;
mod told;
#[cfg(feature = "cad")]
mod with_cad;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

#[cfg(feature = "cgns")]
use crate::formats::cgns;
use exit::{COULD_NOT_RUN, DONE};
use output::message;

/// Curves linear viscous meshes onto their CAD: P1 in, P2, P3 or P4 out, every element certified valid.
#[derive(Parser)]
#[command(name = "sagitta", version, after_help = help::short(), after_long_help = help::program())]
struct Program {
    #[command(flatten)]
    reading: input::Reading,
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    #[cfg(feature = "cad")]
    #[command(flatten)]
    WithCad(with_cad::Command),
    /// Certify a mesh of order 1 to 4: is every element's Jacobian positive everywhere?
    #[command(after_help = help::short(), after_long_help = help::check())]
    Check(check::Options),
    /// Write a mesh in another format, with its patches and groups
    #[command(after_help = help::short(), after_long_help = help::convert())]
    Convert(convert::Options),
    /// Explain the codes of findings
    #[command(after_help = help::short(), after_long_help = help::explain())]
    Explain(explain::Options),
    /// Describe a CAD, mesh or linkage file
    #[command(after_help = help::short(), after_long_help = help::info())]
    Info(info::Options),
    /// Print the completions of a shell
    #[command(after_help = help::short(), after_long_help = help::completions())]
    Completions(completions::Options),
    /// Write the manual pages of all commands
    #[command(after_help = help::short(), after_long_help = help::man())]
    Man(man::Options),
    /// Draw a mesh: its curved boundary, a section, its worst elements; no display is needed
    #[command(after_help = help::short(), after_long_help = help::picture())]
    Picture(picture::Options),
    /// Make a page for a browser of a JSON report and its mesh
    #[command(after_help = help::short(), after_long_help = help::report())]
    Report(report::Options),
}

/// Reads a file in a child process.
type Reader = fn(&Path) -> ExitCode;

/// Hidden subcommands, each with a file: what reads it in a child process, as malformed files crash the libraries that do.
const READERS: &[(&str, Reader)] = &[
    #[cfg(feature = "cad")]
    (cad::READER_SUBCOMMAND, cad::serve_reader),
    #[cfg(feature = "cgns")]
    (cgns::READER_SUBCOMMAND, cgns::serve_reader),
];

/// Runs the program with its arguments, the first of which is its name.
#[must_use]
pub fn run(arguments: Vec<OsString>) -> ExitCode {
    if let [_, word, path] = arguments.as_slice()
        && let Some((_, serve)) = READERS.iter().find(|(subcommand, _)| word == subcommand)
    {
        return serve(Path::new(path));
    }
    if let Err(error) = signals::take_over() {
        message(format_args!("sagitta: signals cannot be taken over: {error}"));
        return COULD_NOT_RUN.into();
    }
    let program = match parsed(arguments) {
        Ok(program) => program,
        Err(error) if error.use_stderr() => {
            message(tips::told(&error));
            return COULD_NOT_RUN.into();
        }
        // Help, or the version.
        Err(text) => return if text.print().is_ok() { DONE } else { COULD_NOT_RUN }.into(),
    };
    program.reading.choose();
    match run_command(&program.command) {
        Ok(code) => code.into(),
        Err(error) => {
            message(format_args!("sagitta: {error}"));
            COULD_NOT_RUN.into()
        }
    }
}

fn parsed(arguments: Vec<OsString>) -> Result<Program, clap::Error> {
    let mut program = Program::command();
    let matches = program.try_get_matches_from_mut(arguments)?;
    told::keep(&program, &matches);
    Program::from_arg_matches(&matches).map_err(|error| error.format(&mut program))
}

fn run_command(command: &Command) -> Result<u8, output::Failure> {
    threads::start(match command {
        #[cfg(feature = "cad")]
        Command::WithCad(command) => command.threads(),
        _ => None,
    })?;
    match command {
        #[cfg(feature = "cad")]
        Command::WithCad(command) => with_cad::run(command),
        Command::Check(options) => check::run(options),
        Command::Convert(options) => convert::run(options),
        Command::Explain(options) => explain::run(options),
        Command::Info(options) => info::run(options),
        Command::Completions(options) => completions::run(options, Program::command()),
        Command::Man(options) => man::run(options, Program::command()),
        Command::Picture(options) => picture::run(options),
        Command::Report(options) => report::run(options),
    }
}
