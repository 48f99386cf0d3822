//! Where an output goes: a name followed through links, and what stands there already.

use std::fs::{self, File, Permissions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Links that are followed, as the system does.
const LINKS: usize = 40;

/// A file that is to be written or replaced.
pub(super) struct Target {
    /// Its name behind all links.
    pub(super) path: PathBuf,
    /// The mode of the file that it replaces.
    pub(super) mode: Option<Permissions>,
}

impl Target {
    /// Follows a name.
    ///
    /// # Errors
    /// The name is that of something that is no file, of a file that may not be written, or of none.
    pub(super) fn of(name: &Path) -> io::Result<Target> {
        match fs::metadata(name) {
            Ok(metadata) if !metadata.is_file() => Err(io::Error::other("it exists and is not a regular file")),
            // The superuser may write to such a file, too, and a rename asks for no right on it.
            Ok(metadata) if metadata.permissions().readonly() => {
                let told = "it exists and is read-only; make it writable (chmod u+w), or give another name";
                Err(io::Error::new(ErrorKind::PermissionDenied, told))
            }
            Ok(metadata) => {
                File::options().write(true).open(name)?; // whoever may not write to a file does not replace it either
                Ok(Target { path: fs::canonicalize(name)?, mode: Some(metadata.permissions()) })
            }
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Target { path: followed(name)?, mode: None }),
            Err(error) => Err(error),
        }
    }
}

/// The name that a name leads to, of which the last part need not exist.
///
/// # Errors
/// Links in a circle, or a path without a file's name.
pub(crate) fn followed(name: &Path) -> io::Result<PathBuf> {
    let mut path = name.to_path_buf();
    for _ in 0..LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = folder(&path).join(next),
            Err(_) if path.file_name().is_none() => return Err(io::Error::other("the path names no file")),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many links, or links in a circle"))
}

/// The folder that a file is in.
pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
