//! Options of commands that write a mesh: how it is written.

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};

use super::help::OUTPUT;
use super::output::Failure;
use crate::formats::{self, Field, Solver, WriteOptions, msh, solver};
use crate::mesh::Mesh;

/// Help of a mesh that is read.
pub(super) fn mesh(what: &str) -> String {
    format!("{what}: {}", formats::readable("or"))
}

/// Help of a mesh that is written.
pub(super) fn output(what: &str) -> String {
    format!("{what}: {}", formats::writable())
}

/// The words that choose a solver.
fn solvers() -> PossibleValuesParser {
    PossibleValuesParser::new(solver::SOLVERS.iter().map(|solver| PossibleValue::new(solver.name).help(solver.title)))
}

/// Where a format leaves a choice.
#[derive(Args)]
pub(super) struct Form {
    /// Write what this solver takes, as it takes it: version, encoding, named boundary; refused at once where it cannot
    /// take the mesh or its order
    #[arg(long = "for", value_name = "SOLVER", value_parser = solvers(), conflicts_with_all = ["msh_version", "ascii"], help_heading = OUTPUT)]
    solver: Option<String>,
    /// Leave out points, lines and faces that belong to no physical group, as Gmsh does
    #[arg(long, help_heading = OUTPUT, hide_short_help = true)]
    physical_only: bool,
    /// VTU and VTKHDF: leave the boundary elements out, for readers that refuse mixed dimensions
    #[arg(long, help_heading = OUTPUT, hide_short_help = true)]
    volume_only: bool,
    /// Version of the MSH file [default: 4.1]
    #[arg(long, value_name = "VERSION", value_enum, help_heading = OUTPUT, hide_short_help = true)]
    msh_version: Option<msh::Version>,
    /// MSH: write text rather than binary
    #[arg(long, help_heading = OUTPUT, hide_short_help = true)]
    ascii: bool,
}

impl Form {
    /// The solver that the mesh is for.
    pub(super) fn solver(&self) -> Option<&'static Solver> {
        self.solver.as_deref().and_then(solver::by_name)
    }

    /// Whether what is chosen is of use for one of the files to write.
    pub(super) fn check(&self, outputs: &[PathBuf]) -> Result<(), Failure> {
        let is_msh = |path: &PathBuf| formats::is_msh(path);
        let unused = [
            ("--msh-version", self.msh_version.is_some() && !outputs.iter().any(is_msh), "an MSH file"),
            ("--ascii", self.ascii && !outputs.iter().any(is_msh), "an MSH file"),
            (
                "--volume-only",
                self.volume_only && !outputs.iter().any(|path| formats::may_be_volume_only(path)),
                "a VTU or VTKHDF file",
            ),
        ];
        match unused.iter().find(|(_, unused, _)| *unused) {
            Some((option, _, file)) => {
                Err(format!("{option} is for {file}, and none is written; leave it away").into())
            }
            None => Ok(()),
        }
    }

    /// Writes a mesh as chosen, with fields to show; returns notes of what was changed and of what the file does not hold.
    pub(super) fn write(&self, path: &Path, mesh: &Mesh, fields: &[Field]) -> Result<Vec<String>, formats::Error> {
        let options = self.options(fields);
        match self.solver() {
            Some(solver) => formats::write_for(path, mesh, solver, &options),
            None => formats::write(path, mesh, &options),
        }
    }

    /// Writes a mesh as chosen, but for no solver; returns notes as [`Form::write`].
    #[cfg(feature = "cad")]
    pub(super) fn write_beside(
        &self,
        path: &Path,
        mesh: &Mesh,
        fields: &[Field],
    ) -> Result<Vec<String>, formats::Error> {
        formats::write(path, mesh, &self.options(fields))
    }

    fn options<'a>(&self, fields: &'a [Field]) -> WriteOptions<'a> {
        WriteOptions {
            msh_version: self.msh_version.unwrap_or_default(),
            msh_encoding: if self.ascii { msh::Encoding::Ascii } else { msh::Encoding::Binary },
            volume_only: self.volume_only,
            physical_only: self.physical_only,
            fields,
        }
    }
}

impl ValueEnum for msh::Version {
    fn value_variants<'a>() -> &'a [msh::Version] {
        &msh::Version::ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.name()))
    }
}
