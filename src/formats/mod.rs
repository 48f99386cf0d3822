//! Mesh files: one file or folder a format, found by content when read and by name when written.
//!
//! A format's reader takes a stream and its length and returns a [`Mesh`] or a [`Flaw`], a fault with its place; its
//! writer takes a stream. Files, their names and what happens to them on failure are dealt with here. Node orders come
//! from [`crate::element::order`], element numbers from [`crate::element::type_code`].

mod assembly;
pub mod cgns;
mod detect;
mod error;
mod field;
pub mod msh;
mod numbers;
mod output;
mod plot3d;
mod scanner;
mod skin;
mod su2;
mod turned;
mod ugrid;
mod vtk;

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use detect::{Format, HEAD, Refusal, detect};
use numbers::Numbers;

pub use error::{Error, Fault, Flaw, Place};
pub use field::{Field, Support, Values};

use crate::mesh::Mesh;

const UNKNOWN_NAME: &str = "the name ends in no known format; name it .msh, .cgns or .vtu";

/// Bytes asked of the system at a time.
const BUFFER: usize = 1 << 20;

/// How files are read.
#[derive(Clone, Debug)]
pub struct ReadOptions {
    /// Program that calls [`cgns::serve_reader`] when its first argument is [`cgns::READER_SUBCOMMAND`]; default this very
    /// program.
    pub reader: PathBuf,
}

impl Default for ReadOptions {
    fn default() -> ReadOptions {
        ReadOptions { reader: std::env::current_exe().unwrap_or_else(|_| PathBuf::from("/proc/self/exe")) }
    }
}

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

/// Reads a mesh file; the format is found by content and name.
///
/// What reading changed or left out stands in [`Mesh::notes`].
///
/// # Errors
/// [`Error::Io`], [`Error::Format`] where the content is of no known format, [`Error::Content`] where it is damaged.
pub fn read(path: &Path) -> Result<Mesh, Error> {
    read_with(path, &ReadOptions::default())
}

/// As [`read`], with a choice of the program that reads CGNS files.
///
/// # Errors
/// Those of [`read`].
pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Mesh, Error> {
    let failed = |source| Error::Io { file: path.to_path_buf(), action: "read", source };
    let of_format = |reason| Error::Format { file: path.to_path_buf(), reason };
    let (mut input, length) = open(path)?;
    let head = input.fill_buf().map_err(failed)?;
    let format = detect(path, &head[..head.len().min(HEAD)]).map_err(|refusal| of_format(refusal.reason))?;
    let flaw = |flaw: Flaw| flaw.of(path);
    match format {
        Format::Msh => msh::read(input, length).map_err(flaw),
        Format::Cgns => {
            drop(input);
            cgns::read(path, length, options)
        }
        Format::Ugrid => {
            let encoding = ugrid::encoding(path, head, length).map_err(of_format)?;
            let mut mesh = ugrid::read(&mut Numbers::new(input, length, encoding)).map_err(flaw)?;
            ugrid::name_surfaces(&mut mesh, path)?;
            Ok(mesh)
        }
        Format::Su2 => su2::read(input, length).map_err(flaw),
        Format::LegacyVtk => vtk::read_legacy(input, length).map_err(flaw),
        Format::Vtu => {
            let mut content = Vec::new();
            input.read_to_end(&mut content).map_err(failed)?;
            vtk::read_xml(&content).map_err(flaw)
        }
        Format::Plot3d => {
            let head = head.to_vec();
            plot3d::read(input, &head, path, length)
        }
    }
}

/// Whether a file is of a mesh format by its content or name; it may be damaged, or of a format that is not read.
///
/// # Errors
/// [`Error::Io`].
pub fn is_mesh(path: &Path) -> Result<bool, Error> {
    let (mut input, _) = open(path)?;
    let head = input.fill_buf().map_err(|source| Error::Io { file: path.to_path_buf(), action: "read", source })?;
    Ok(!matches!(detect(path, &head[..head.len().min(HEAD)]), Err(Refusal { is_mesh: false, .. })))
}

/// A regular file and its length.
fn open(path: &Path) -> Result<(BufReader<File>, u64), Error> {
    let failed = |source| Error::Io { file: path.to_path_buf(), action: "read", source };
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if !metadata.is_file() {
        return Err(failed(std::io::Error::other("it is not a regular file")));
    }
    Ok((BufReader::with_capacity(BUFFER, file), metadata.len()))
}

/// Whether a mesh could be written under this name: to be asked before long work.
///
/// # Errors
/// [`Error::Format`] for a name of no known format, [`Error::Io`] where the folder does not exist.
pub fn check_output(path: &Path) -> Result<(), Error> {
    let known =
        |extension: &std::ffi::OsStr| ["msh", "cgns", "vtu"].iter().any(|known| extension.eq_ignore_ascii_case(known));
    if !path.extension().is_some_and(known) {
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
    write_file(path, |out| std::io::Write::write_all(out, bytes))
}

/// As [`write_bytes`], for content too large to be gathered first.
///
/// # Errors
/// As [`write_bytes`].
pub fn write_file(
    path: &Path,
    content: impl FnOnce(&mut std::io::BufWriter<std::fs::File>) -> std::io::Result<()>,
) -> Result<(), Error> {
    output::write_whole(path, |out| Ok(content(out)?))
}

/// Whether a file of this name would show [`WriteOptions::fields`].
#[must_use]
pub fn shows_fields(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vtu"))
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
        Some("cgns") => output::write_by_name(path, |part| cgns::write(part, mesh)),
        Some("vtu") => output::write_whole(path, |out| vtk::write(out, mesh, options.fields, options.volume_only)),
        _ => Err(Error::Format { file: path.to_path_buf(), reason: UNKNOWN_NAME.into() }),
    }
}
