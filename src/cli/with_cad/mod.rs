//! The commands that read CAD.

mod curve;
mod groups;
mod keeper;
mod link;
mod model;
mod points;
mod progress;
mod project;
mod reading;
mod trace;
mod validate;
mod values;

use clap::Subcommand;

use super::examples::EXAMPLES;
use super::output::Failure;

pub(super) use model::describe;
pub(super) use values::positive;

#[derive(Subcommand)]
pub(super) enum Command {
    /// Curve a linear mesh onto its CAD
    #[command(after_help = EXAMPLES)]
    Curve(Box<curve::Options>),
    /// Write the linkage file of a mesh: which of its faces, edges and points lie on which CAD entities
    #[command(after_help = EXAMPLES)]
    Link(link::Options),
    /// Check a linkage file: alone, against its mesh, against its CAD
    #[command(after_help = EXAMPLES)]
    Validate(validate::Options),
    /// List the entities and ready groups of a CAD file, by the references that commands and linkage files take
    #[command(after_help = EXAMPLES)]
    Groups(groups::Options),
    /// Project points on CAD: the closest point of a set of faces and edges, and whether it is proven
    #[command(after_help = EXAMPLES)]
    Project(project::Options),
}

/// Runs one of them; gives its exit code.
pub(super) fn run(command: &Command) -> Result<u8, Failure> {
    match command {
        Command::Curve(options) => curve::run(options),
        Command::Link(options) => link::run(options),
        Command::Validate(options) => validate::run(options),
        Command::Groups(options) => groups::run(options),
        Command::Project(options) => project::run(options),
    }
}
