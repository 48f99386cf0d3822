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
mod gmf;
mod grid_layout;
pub mod msh;
mod names;
mod node_order;
mod numbers;
mod options;
mod output;
mod part;
mod plot3d;
mod recognise;
mod registry;
mod repeats;
mod scanner;
mod su2;
mod target;
mod turned;
mod ugrid;
mod vtk;

use std::path::{Path, PathBuf};

use format::Input;
use recognise::{case_folder, detect};

pub use error::{Error, Fault, Flaw, Place};
pub use field::{Field, Support, Values};
pub use format::{Format, Holds, Reader, Writer};
pub use grid_layout::GridLayout;
pub use options::{ReadOptions, WriteOptions};
pub use output::{check_file, write_bytes, write_file};
pub use part::abandon;
pub use registry::{REGISTRY, readable, table, writable};
pub(crate) use target::{folder, followed};

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
    if let Some(refusal) = case_folder(path) {
        return Err(refused(refusal.reason));
    }
    let input = Input::open(path)?;
    let format = detect(&input.head()).map_err(|refusal| refused(refusal.reason))?;
    options.check_length(input.length).map_err(refused)?;
    let mut mesh = (format.reader.read)(input, options)?;
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
    if case_folder(path).is_some() {
        return Ok(true);
    }
    Ok(detect(&Input::open(path)?.head()).map_or_else(|refusal| refusal.is_mesh, |_| true))
}

/// Whether a mesh of about `expected` bytes could be written under this name: to be asked before long work, see [`check_file`].
///
/// # Errors
/// [`Error::Format`] for a name of no known format, those of [`check_file`].
pub fn check_output(path: &Path, expected: u64) -> Result<(), Error> {
    of_name(path)?;
    check_file(path, expected)
}

/// The format that a file of this name is written in.
fn of_name(path: &Path) -> Result<&'static Writer, Error> {
    let known = registry::written().find(|format| format.is_name(path));
    known.and_then(|format| format.writer.as_ref()).ok_or_else(|| Error::Format {
        file: path.to_path_buf(),
        reason: format!("the name ends in no format that is written; name it {}", registry::names()),
    })
}

/// The file beside a mesh file that is read with it, where there is one.
#[must_use]
pub fn beside(path: &Path) -> Option<PathBuf> {
    if ugrid::FORMAT.is_name(path) { ugrid::mapbc::beside(path) } else { None }
}

/// Whether a file of this name would show [`WriteOptions::fields`].
#[must_use]
pub fn shows_fields(path: &Path) -> bool {
    of_name(path).is_ok_and(|writer| writer.holds.fields)
}

/// Writes a mesh file; the format is that of the name's ending.
///
/// The file appears under its name only when it is complete. Equal meshes make equal bytes.
///
/// # Errors
/// [`Error::Io`], [`Error::Format`] for a name of no known format, [`Error::Inexpressible`] where the format lacks
/// what the mesh holds.
pub fn write(path: &Path, mesh: &Mesh, options: &WriteOptions<'_>) -> Result<(), Error> {
    let writer = of_name(path)?;
    if let Some(reason) = writer.holds.refusal(mesh) {
        return Err(Error::Inexpressible { file: path.to_path_buf(), reason });
    }
    output::write(path, |part| (writer.write)(part, mesh, options))
}
