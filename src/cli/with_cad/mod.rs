//! The commands that read CAD.

mod cad_file;
mod curve;
mod groups;
mod link;
mod live;
mod model;
mod points;
mod progress;
mod project;
mod reading;
mod room;
mod row;
mod spline;
mod validate;
mod values;

use std::num::NonZeroUsize;

use clap::Subcommand;

use super::help;
use super::output::Failure;

pub(super) use cad_file::CadFile;
pub(super) use model::describe;
pub(super) use room::Room;
pub(super) use values::seconds;

#[derive(Subcommand)]
pub(super) enum Command {
    /// Curve a linear mesh onto its CAD
    #[command(after_help = help::short(), after_long_help = help::curve())]
    Curve(Box<curve::Options>),
    /// Write the linkage file of a mesh: which of its faces, edges and points lie on which CAD entities
    #[command(after_help = help::short(), after_long_help = help::link())]
    Link(link::Options),
    /// Check a linkage file: alone, against its mesh, against its CAD
    #[command(after_help = help::short(), after_long_help = help::validate())]
    Validate(validate::Options),
    /// List the entities and groups of a CAD file, by the references that commands and linkage files take
    #[command(after_help = help::short(), after_long_help = help::groups())]
    Groups(groups::Options),
    /// Project points onto CAD: the closest point of a set of faces and edges, and whether it is proven
    #[command(after_help = help::short(), after_long_help = help::project())]
    Project(project::Options),
    /// Make CAD of an airfoil's coordinates: the C2 spline through them, with a corner at the trailing edge only
    #[command(after_help = help::short(), after_long_help = help::spline())]
    Spline(spline::Options),
}

impl Command {
    /// The number of threads that is asked for.
    pub(super) fn threads(&self) -> Option<NonZeroUsize> {
        match self {
            Command::Curve(options) => options.threads,
            Command::Project(options) => options.threads,
            _ => None,
        }
    }
}

/// Runs one of them; gives its exit code.
pub(super) fn run(command: &Command) -> Result<u8, Failure> {
    match command {
        Command::Curve(options) => curve::run(options),
        Command::Link(options) => link::run(options),
        Command::Validate(options) => validate::run(options),
        Command::Groups(options) => groups::run(options),
        Command::Project(options) => project::run(options),
        Command::Spline(options) => spline::run(options),
    }
}
