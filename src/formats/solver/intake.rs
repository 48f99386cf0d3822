//! What a solver takes: which files, and of them which cells, orders and names.

use std::fmt;
use std::path::Path;

use super::names::NameRule;
use crate::element::{Cell, Order};
use crate::formats::format::Format;
use crate::formats::options::{Encoding, Version};
use crate::mesh::Mesh;

/// A program that curved meshes are made for.
pub struct Solver {
    /// The word that chooses it.
    pub name: &'static str,
    /// What people call it, with the version whose reader was looked at.
    pub title: &'static str,
    /// The files that it takes, the best first.
    pub intakes: &'static [Intake],
}

impl fmt::Debug for Solver {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl PartialEq for Solver {
    fn eq(&self, other: &Solver) -> bool {
        self.name == other.name
    }
}

/// Files of one format, as a solver takes them.
pub struct Intake {
    /// The format.
    pub format: &'static Format,
    /// Endings of the files' names that choose it, the usual one first.
    pub endings: &'static [&'static str],
    /// Version, of a format that has several.
    pub version: Version,
    /// Encoding, of a format that has several.
    pub encoding: Encoding,
    /// The cells that it takes, each with the highest order.
    pub cells: &'static [(Cell, usize)],
    /// Whether all cells of a mesh must be of one kind.
    pub one_kind: bool,
    /// What it wants of groups; `None` takes them as they are.
    pub groups: Option<Groups>,
    /// What else it cannot take of a mesh, and why.
    pub misfit: fn(&Mesh) -> Option<String>,
    /// What a user must know beside, in one line.
    pub notes: &'static str,
}

/// What a solver wants of the groups of cells and boundary elements.
pub struct Groups {
    /// Name of the one group of all cells, where it wants one.
    pub cells: Option<&'static str>,
    /// Whether a boundary element may be in one group only.
    pub one_each: bool,
    /// What names may be.
    pub names: NameRule,
}

impl Solver {
    /// How the solver takes a file of this name.
    ///
    /// # Errors
    /// The endings that it takes.
    pub fn intake(&self, path: &Path) -> Result<&'static Intake, String> {
        let own = path.extension();
        let is = |intake: &&Intake| own.is_some_and(|own| intake.endings.iter().any(|e| own.eq_ignore_ascii_case(e)));
        self.intakes.iter().find(is).ok_or_else(|| {
            let endings = self.intakes.iter().flat_map(|intake| intake.endings).map(|ending| format!(".{ending}"));
            let endings: Vec<String> = endings.collect();
            format!("{} takes files whose names end in {}", self.title, endings.join(" or "))
        })
    }

    /// Why it cannot take a mesh once that is of an order, where it cannot.
    #[must_use]
    pub fn refusal(&self, intake: &Intake, mesh: &Mesh, order: Order) -> Option<String> {
        let counts = mesh.counts();
        let top = mesh.dimension();
        let kinds: Vec<(Cell, usize)> = counts.into_iter().filter(|(cell, _)| cell.dimension() == top).collect();
        let beyond = kinds.iter().find(|(cell, _)| intake.highest(*cell).is_none_or(|highest| order.get() > highest));
        let reason = match beyond {
            Some((cell, count)) => format!("has no {cell} of {order} (the mesh has {count})"),
            None if intake.one_kind && kinds.len() > 1 => {
                let kinds: Vec<String> = kinds.iter().map(|(cell, count)| format!("{count} {cell}")).collect();
                format!("takes meshes of one kind of cell, and this one has {}", kinds.join(", "))
            }
            None => return (intake.misfit)(mesh).map(|reason| format!("{}: {reason}", self.title)),
        };
        Some(format!("{} {reason}; it takes {}{}", self.title, intake.takes(), self.elsewhere(intake)))
    }

    /// Other files of the same solver.
    fn elsewhere(&self, intake: &Intake) -> String {
        let others = self.intakes.iter().filter(|other| !std::ptr::eq(*other, intake));
        let text = |other: &Intake| format!("; in a .{} file {}", other.endings[0], other.takes());
        others.map(text).collect()
    }
}

impl Intake {
    /// The highest order of a cell; `None` where it is not taken.
    #[must_use]
    pub fn highest(&self, cell: Cell) -> Option<usize> {
        self.cells.iter().find(|(own, _)| *own == cell).map(|&(_, highest)| highest)
    }

    /// The cells that it takes, in words.
    #[must_use]
    pub fn takes(&self) -> String {
        let volume = self.cells.iter().filter(|(cell, _)| Cell::VOLUME.contains(cell));
        let told = |&(cell, highest): &(Cell, usize)| match highest {
            1 => format!("{cell} of P1"),
            highest => format!("{cell} of P1 to P{highest}"),
        };
        volume.map(told).collect::<Vec<_>>().join(", ")
    }
}
