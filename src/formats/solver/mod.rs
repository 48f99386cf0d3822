//! Solvers, and the files that each of them takes as they are written.
//!
//! [`SOLVERS`] is one table: files, versions, cells and orders, names. A mesh that a solver cannot take is refused before
//! anything is done with it; one that it can is made ready, with a note of what was changed.

mod groups;
mod intake;
mod names;
mod table;

pub use intake::{Groups, Intake, Solver};
pub use names::NameRule;
pub use table::SOLVERS;

pub(super) use groups::{physical_only, prepare};

/// The solver of a name.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Solver> {
    SOLVERS.iter().find(|solver| solver.name == name)
}
