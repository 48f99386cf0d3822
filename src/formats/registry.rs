//! The list of formats, and the texts that are made from it.

use std::fmt::Write as _;

#[cfg(feature = "cgns")]
use super::cgns;
use super::format::{Format, Holds};
#[cfg(feature = "cgns")]
use super::hopr;
use super::{gmf, mfem, msh, nektar, openfoam, plot3d, su2, ugrid, vtk};
use crate::element::Cell;

/// All formats, the most telling marks first.
pub static REGISTRY: &[&Format] = &[
    &msh::FORMAT,
    #[cfg(feature = "cgns")]
    &hopr::FORMAT,
    #[cfg(feature = "cgns")]
    &cgns::FORMAT,
    &mfem::FORMAT,
    &gmf::FORMAT,
    &ugrid::FORMAT,
    &su2::FORMAT,
    &nektar::FORMAT,
    &vtk::VTU,
    &vtk::VTM,
    #[cfg(feature = "cgns")]
    &vtk::HDF,
    &vtk::LEGACY,
    &openfoam::FORMAT,
    &plot3d::FORMAT,
];

/// The formats that are written.
pub(super) fn written() -> impl Iterator<Item = &'static Format> {
    REGISTRY.iter().copied().filter(|format| format.writer.is_some())
}

/// Names of the formats that are read: `Gmsh MSH, CGNS or VTU`, with the given conjunction.
#[must_use]
pub fn readable(conjunction: &str) -> String {
    let read = REGISTRY.iter().filter(|format| format.reader.is_some());
    listed(read.map(|format| format.name.to_owned()), conjunction)
}

/// Endings of the files that are written and what they are good for: `.msh or .cgns for solvers, .vtu for pictures`.
#[must_use]
pub fn writable() -> String {
    let shows = |format: &&Format| format.writer.as_ref().is_some_and(|writer| writer.holds.fields);
    let (pictures, solvers): (Vec<_>, Vec<_>) = written().partition(shows);
    let endings = |formats: Vec<&Format>| listed(formats.iter().flat_map(|format| dotted(format)), "or");
    format!("{} for solvers, {} for pictures", endings(solvers), endings(pictures))
}

/// What a file that is to be written may be named.
pub(super) fn names() -> String {
    listed(written().flat_map(dotted), "or")
}

/// A format's endings with their dots.
fn dotted(format: &Format) -> impl Iterator<Item = String> + use<> {
    format.endings.iter().map(|ending| format!(".{ending}"))
}

/// Items with commas, the last behind a conjunction.
fn listed(items: impl Iterator<Item = String>, conjunction: &str) -> String {
    let mut items: Vec<String> = items.collect();
    let last = items.pop().unwrap_or_default();
    if items.is_empty() { last } else { format!("{} {conjunction} {last}", items.join(", ")) }
}

/// The formats and what they hold, as a table in Markdown.
#[must_use]
pub fn table() -> String {
    let mut text = "| format | names end in | read | written |\n|---|---|---|---|\n".to_owned();
    for format in REGISTRY {
        let endings = listed(dotted(format).map(|ending| format!("`{ending}`")), "or");
        let held = |holds: Option<&Holds>| holds.map_or_else(|| "-".to_owned(), told);
        let read = held(format.reader.as_ref().map(|reader| &reader.holds));
        let written = held(format.writer.as_ref().map(|writer| &writer.holds));
        // A string takes what is written to it.
        let _ = writeln!(text, "| {} | {endings} | {read} | {written} |", format.name);
    }
    text
}

/// What files hold, in a cell of the table.
fn told(holds: &Holds) -> String {
    let orders = if holds.highest.get() == 1 { "P1".to_owned() } else { format!("P1 to {}", holds.highest) };
    let dimensions = listed(holds.dimensions.iter().map(|dimension| format!("{dimension}D")), "and");
    let all = Cell::ALL.iter().all(|cell| holds.cells.contains(cell) || cell.dimension() < 2);
    let cells = match all {
        true => "all cells".to_owned(),
        false => listed(holds.cells.iter().map(|cell| cell.name().to_owned()), "and"),
    };
    let names = if holds.names { ", names of groups" } else { "" };
    let fields = if holds.fields { ", fields" } else { "" };
    format!("{orders}, {dimensions}, {cells}{names}{fields}; {}", holds.notes)
}
