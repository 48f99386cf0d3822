//! Mesh files: one file or folder a format, found by content when read and by name when written.
//!
//! A format's reader takes a stream and its length and returns a [`Mesh`] or a [`Flaw`], a fault with its place; its
//! writer takes a stream. Files, their names and what happens to them on failure are dealt with here. Node orders come
//! from [`crate::element::order`], element numbers from [`crate::element::type_code`].

mod error;
mod field;
pub mod msh;
mod output;
mod vtu;

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

pub use error::{Error, Fault, Flaw, Place};
pub use field::{Field, Support, Values};

use crate::mesh::Mesh;

const UNKNOWN_NAME: &str = "the name ends in no known format; name it .msh or .vtu";

/// Bytes asked of the system at a time.
const BUFFER: usize = 1 << 20;

/// How files are written, where a format leaves a choice.
#[derive(Clone, Copy, Debug, Default)]
pub struct WriteOptions<'a> {
    /// Version of MSH files.
    pub msh_version: msh::Version,
    /// Encoding of MSH files.
    pub msh_encoding: msh::Encoding,
    /// VTU without the cells below the top dimension.
    pub volume_only: bool,
    /// Values to show, in VTU files.
    pub fields: &'a [Field],
}

/// The formats that can be told apart by their first bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Msh,
}

/// What a file seems to be, by its first bytes; else what to tell the user.
fn detect(head: &[u8]) -> Result<Format, &'static str> {
    let text = head.trim_ascii_start();
    if text.starts_with(b"$") {
        return Ok(Format::Msh);
    }
    Err(if head.is_empty() {
        "the file is empty"
    } else if head.starts_with(b"\x89HDF\r\n\x1a\n") {
        "an HDF5 (CGNS?) file; only Gmsh MSH files are read: convert it"
    } else if head.starts_with(b"ISO-10303-21") {
        "a STEP file, which is CAD, not a mesh"
    } else if text.starts_with(b"<") {
        "an XML file; only Gmsh MSH files are read: convert it"
    } else {
        "not a mesh file of a known format; Gmsh MSH 4.1 and 2.2 are read"
    })
}

/// Reads a mesh file; the format is found by content.
///
/// # Errors
/// [`Error::Io`], [`Error::Format`] where the content is of no known format, [`Error::Content`] where it is damaged.
pub fn read(path: &Path) -> Result<Mesh, Error> {
    let failed = |source| Error::Io { file: path.to_path_buf(), action: "read", source };
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if !metadata.is_file() {
        return Err(failed(std::io::Error::other("it is not a regular file")));
    }
    let mut input = BufReader::with_capacity(BUFFER, file);
    let head = input.fill_buf().map_err(failed)?;
    let format = detect(head).map_err(|reason| Error::Format { file: path.to_path_buf(), reason: reason.into() })?;
    match format {
        Format::Msh => msh::read(input, metadata.len()).map_err(|flaw| flaw.of(path)),
    }
}

/// Whether a mesh could be written under this name: to be asked before long work.
///
/// # Errors
/// [`Error::Format`] for a name of no known format, [`Error::Io`] where the folder does not exist.
pub fn check_output(path: &Path) -> Result<(), Error> {
    let known = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("msh") || e.eq_ignore_ascii_case("vtu"));
    if !known {
        return Err(Error::Format { file: path.to_path_buf(), reason: UNKNOWN_NAME.into() });
    }
    check_folder(path)
}

/// Whether the folder of a file that is to be written exists.
///
/// # Errors
/// [`Error::Io`].
pub fn check_folder(path: &Path) -> Result<(), Error> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match std::fs::metadata(folder) {
        Ok(metadata) if metadata.is_dir() => Ok(()),
        Ok(_) => Err(std::io::Error::other("its folder is no folder")),
        Err(error) => Err(error),
    }
    .map_err(|source| Error::Io { file: path.to_path_buf(), action: "create", source })
}

/// Writes bytes under a temporary name, renamed when complete.
///
/// # Errors
/// [`Error::Io`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    output::write_whole(path, |out| Ok(std::io::Write::write_all(out, bytes)?))
}

/// Writes a mesh file; the format is that of the name's extension.
///
/// The file appears under its name only when it is complete. Equal meshes make equal bytes.
///
/// # Errors
/// [`Error::Io`], [`Error::Format`] for a name of no known format, [`Error::Inexpressible`] where the format lacks
/// what the mesh holds.
pub fn write(path: &Path, mesh: &Mesh, options: &WriteOptions<'_>) -> Result<(), Error> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    match extension.to_str() {
        Some("msh") => {
            output::write_whole(path, |out| msh::write(out, mesh, options.msh_version, options.msh_encoding))
        }
        Some("vtu") => output::write_whole(path, |out| vtu::write(out, mesh, options.fields, options.volume_only)),
        _ => Err(Error::Format { file: path.to_path_buf(), reason: UNKNOWN_NAME.into() }),
    }
}
