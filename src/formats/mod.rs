//! Mesh files: one file or folder a format, found by content when read and by name when written.
//!
//! A format is a folder with one [`Format`], and a line in [`REGISTRY`]; texts that name formats are made from there. Its
//! reader gets a file and returns a [`Mesh`] or a [`Flaw`], a fault with its place; its writer gets a file under a temporary
//! name. What happens to files on failure is dealt with here.

mod assembly;
#[cfg(feature = "cgns")]
pub mod cgns;
mod crossed;
mod detect;
mod error;
mod field;
mod foreign;
mod format;
mod from_faces;
mod gmf;
mod grid_layout;
#[cfg(feature = "cgns")]
mod hopr;
mod loss;
mod mfem;
pub mod msh;
mod names;
mod nektar;
mod node_order;
mod numbers;
mod openfoam;
mod options;
mod orders;
mod output;
mod part;
mod plot3d;
mod recognise;
mod registry;
mod repeats;
mod scanner;
pub mod solver;
mod su2;
mod target;
mod turned;
mod ugrid;
mod vtk;
mod well_formed;

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use format::Input;
use glam::DVec3;
use recognise::detect;

pub use error::{Error, Fault, Flaw, Place};
pub use field::{Field, Places, Support, Values};
pub use format::{Format, Holds, Reader, Writer};
pub use grid_layout::GridLayout;
pub use options::{ReadOptions, WriteOptions};
pub use orders::{NODE_ORDERS, NamedOrder};
pub use output::{check_file, write_bytes, write_file};
pub use part::abandon;
pub use registry::{REGISTRY, readable, table, writable};
pub use solver::Solver;
pub(crate) use target::{folder, followed};

use crate::element::Order;
use crate::mesh::Mesh;

/// Reads a mesh file; the format is found by content and name.
///
/// What reading changed or left out stands in [`Mesh::notes`].
///
/// # Errors
/// [`Error::Io`], [`Error::Format`] where the content is of no known format, [`Error::Content`] where it is damaged.
pub fn read(path: &Path) -> Result<Mesh, Error> {
    read_with(path, &ReadOptions::default())
}

/// As [`read`], with a choice of the process that parses CGNS files.
///
/// # Errors
/// Those of [`read`].
pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Mesh, Error> {
    let refused = |reason| Error::Format { file: path.to_path_buf(), reason };
    let faces = openfoam::faces(path);
    let own = faces.as_deref().unwrap_or(path);
    let input = Input::open(own)?;
    let format = detect(&input.head()).map_err(|refusal| refused(refusal.reason))?;
    options.check_length(input.length).map_err(refused)?;
    let Some(reader) = &format.reader else { return Err(refused(format!("{} is written only", format.name))) };
    let mut mesh = (reader.read)(input, options)?;
    names::clean(&mut mesh);
    crossed::uncross(&mut mesh);
    repeats::check(&mut mesh).map_err(|flaw| flaw.of(path))?;
    Ok(mesh)
}

/// Whether a file is of a mesh format by its content or name; it may be damaged, or of a format that is not read.
///
/// # Errors
/// [`Error::Io`].
pub fn is_mesh(path: &Path) -> Result<bool, Error> {
    let faces = openfoam::faces(path);
    Ok(detect(&Input::open(faces.as_deref().unwrap_or(path))?.head()).map_or_else(|refusal| refusal.is_mesh, |_| true))
}

/// Whether a mesh of about `expected` bytes could be written under this name, for a solver where one is given: to be asked before
/// long work, see [`check_file`].
///
/// # Errors
/// [`Error::Format`] for a name of no known format, those of [`check_file`].
pub fn check_output(path: &Path, expected: u64, solver: Option<&Solver>) -> Result<(), Error> {
    format_of(path, solver)?;
    check_file(path, expected)
}

/// The format that a file of this name is written in, for a solver where one is given.
fn format_of(path: &Path, solver: Option<&Solver>) -> Result<&'static Format, Error> {
    let refused = |reason| Error::Format { file: path.to_path_buf(), reason };
    if let Some(solver) = solver {
        return Ok(solver.intake(path).map_err(refused)?.format);
    }
    let of_name = registry::written().find(|format| format.is_name(path));
    of_name.ok_or_else(|| {
        let names = registry::names();
        refused(format!("the name ends in no format that is written; name it {names}"))
    })
}

/// Whether a solver takes a file of this name with this mesh, once the mesh is of an order.
///
/// # Errors
/// [`Error::Format`] for a name that the solver does not take, [`Error::Inexpressible`] for cells or orders that it does not.
pub fn check_solver(path: &Path, solver: &Solver, mesh: &Mesh, order: Order) -> Result<(), Error> {
    let file = path.to_path_buf();
    let intake = solver.intake(path).map_err(|reason| Error::Format { file: file.clone(), reason })?;
    match solver.refusal(intake, mesh, order) {
        Some(reason) => Err(Error::Inexpressible { file, reason }),
        None => Ok(()),
    }
}

/// The files that are read with a mesh file: beside it, or in the folder that it stands for.
#[must_use]
pub fn beside(path: &Path) -> Vec<PathBuf> {
    if ugrid::FORMAT.is_name(path) { ugrid::mapbc::beside(path).into_iter().collect() } else { openfoam::files(path) }
}

/// The folder that files are written to along with a mesh of this name, where its format has one.
#[must_use]
pub fn folder_beside(path: &Path) -> Option<PathBuf> {
    vtk::VTM.is_name(path).then(|| vtk::folder_of(path))
}

/// Whether a file of this name would show [`WriteOptions::fields`].
#[must_use]
pub fn shows_fields(path: &Path, solver: Option<&Solver>) -> bool {
    let format = format_of(path, solver).ok();
    format.and_then(|format| format.writer.as_ref()).is_some_and(|writer| writer.holds.fields)
}

/// Whether a file is written as MSH by its name.
#[must_use]
pub fn is_msh(path: &Path) -> bool {
    msh::FORMAT.is_name(path)
}

/// Whether a file of this name has boundary elements only where [`WriteOptions::volume_only`] does not leave them out.
#[must_use]
pub fn may_be_volume_only(path: &Path) -> bool {
    shows_fields(path, None) && !vtk::VTM.is_name(path)
}

/// Writes a mesh file; the format is that of the name's ending.
///
/// The file appears under its name only when it is complete. Equal meshes make equal bytes. Returns notes of what was left out and
/// of what the file does not hold.
///
/// # Errors
/// [`Error::Io`], [`Error::Format`] for a name of no known format, [`Error::Inexpressible`] where the format lacks
/// what the mesh holds.
pub fn write(path: &Path, mesh: &Mesh, options: &WriteOptions<'_>) -> Result<Vec<String>, Error> {
    write_as(format_of(path, None)?, path, &mesh.without_unmarked(), options)
}

/// Writes a mesh file as a solver takes it; the format is one of the solver's, by the name's ending. Otherwise as [`write()`].
///
/// # Errors
/// Those of [`write()`] and of [`check_solver`].
pub fn write_for(path: &Path, mesh: &Mesh, solver: &Solver, options: &WriteOptions<'_>) -> Result<Vec<String>, Error> {
    check_solver(path, solver, mesh, mesh.order())?;
    let refused = |reason| Error::Inexpressible { file: path.to_path_buf(), reason };
    let intake = solver.intake(path).map_err(refused)?;
    let options = WriteOptions { msh_version: intake.version, msh_encoding: intake.encoding, ..*options };
    let Some(groups) = &intake.groups else {
        return write_as(intake.format, path, &mesh.without_unmarked(), &options);
    };
    let (prepared, mut notes) = solver::prepare(mesh, groups).map_err(refused)?;
    notes.extend(write_as(intake.format, path, &prepared, &options)?);
    Ok(notes)
}

fn write_as(format: &Format, path: &Path, mesh: &Mesh, options: &WriteOptions<'_>) -> Result<Vec<String>, Error> {
    let refused = |reason| Error::Inexpressible { file: path.to_path_buf(), reason };
    let Some(writer) = &format.writer else { return Err(refused(format!("{} is not written", format.name))) };
    let (mesh, left_out) =
        if options.physical_only { solver::physical_only(mesh) } else { (Cow::Borrowed(mesh), None) };
    if let Some(reason) = writer.holds.refusal(&mesh) {
        return Err(refused(reason));
    }
    let moved = match writer.held {
        Some(held) => moved(&mesh, &held(&mesh).map_err(refused)?),
        None => None,
    };
    output::write(path, |part| (writer.write)(part, &mesh, options))?;
    Ok(left_out.into_iter().chain(moved).chain(writer.loses.iter().filter_map(|loss| loss.note(&mesh))).collect())
}

/// The points of a mesh as a solver has it from a file of this name; `None` where the file holds all of them.
///
/// # Errors
/// Those of [`check_solver`]; [`Error::Inexpressible`].
pub fn held(path: &Path, solver: &Solver, mesh: &Mesh) -> Result<Option<Vec<DVec3>>, Error> {
    let file = path.to_path_buf();
    let intake = solver.intake(path).map_err(|reason| Error::Format { file: file.clone(), reason })?;
    let held = intake.format.writer.as_ref().and_then(|writer| writer.held);
    held.map(|held| held(mesh)).transpose().map_err(|reason| Error::Inexpressible { file, reason })
}

/// A note of nodes that a file does not hold, and where its reader has them.
fn moved(mesh: &Mesh, held: &[DVec3]) -> Option<String> {
    let apart = mesh.points().iter().zip(held).filter(|(own, held)| own != held);
    let (count, most) =
        apart.fold((0, 0.0f64), |(count, most), (own, held)| (count + 1, most.max(own.distance(*held))));
    (count > 0).then(|| {
        format!("{count} nodes inside cells have no place in the file: its reader has them up to {most:.1e} away, where the faces put them")
    })
}
