//! A file that appears under its name only when it is complete.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::Error;

/// Bytes gathered before the system is asked to write.
const BUFFER: usize = 4 << 20;

/// Mode of a new file, of which the user's mask takes away.
const MODE: u32 = 0o666;

/// Writes a file under a temporary name in its target's folder, and gives it its name when all went well and is on disk.
///
/// Nothing is left behind on failure, and a file that had the name stays as it was. A file that is replaced hands its mode on. A
/// link stays a link: the file that it leads to is replaced.
///
/// # Errors
/// [`Error::Io`], also where the name belongs to something that is not a file; whatever `content` returns.
pub(super) fn write(path: &Path, content: impl FnOnce(&mut Part) -> Result<(), Unwritten>) -> Result<(), Error> {
    let failed = |action| move |source| Error::Io { file: path.to_path_buf(), action, source };
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let replaced = fs::metadata(&target).ok();
    if replaced.as_ref().is_some_and(|metadata| !metadata.is_file()) {
        return Err(failed("write")(io::Error::other("it exists and is not a regular file")));
    }
    let mut part = Part::create(path, &target, replaced.map(|old| old.permissions())).map_err(failed("create"))?;
    content(&mut part).map_err(|unwritten| match unwritten {
        Unwritten::Io(source) => failed("write")(source),
        Unwritten::Inexpressible(reason) => Error::Inexpressible { file: path.to_path_buf(), reason },
    })?;
    part.complete(&target).map_err(failed("write"))
}

/// The folder that a file is in.
pub(super) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Why a content was not written.
#[derive(Debug)]
pub(super) enum Unwritten {
    /// The system refused.
    Io(io::Error),
    /// The format lacks what the mesh holds.
    Inexpressible(String),
}

impl From<io::Error> for Unwritten {
    fn from(error: io::Error) -> Unwritten {
        Unwritten::Io(error)
    }
}

/// The file under its temporary name; removed when dropped before it got its own.
pub(super) struct Part {
    file: NamedTempFile,
    /// The name that it will have, as it was asked for.
    name: PathBuf,
}

impl Part {
    /// A new file that no link leads elsewhere: its name is taken by nothing.
    fn create(name: &Path, target: &Path, mode: Option<Permissions>) -> io::Result<Part> {
        if target.file_name().is_none() {
            return Err(io::Error::other("the path names no file"));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".sagitta-").suffix(".part").permissions(Permissions::from_mode(MODE));
        let file = builder.tempfile_in(folder(target))?;
        if let Some(mode) = mode {
            file.as_file().set_permissions(mode)?;
        }
        Ok(Part { file, name: name.to_path_buf() })
    }

    /// Whether its name will have this ending, for a format that has several.
    pub(super) fn is_named(&self, ending: &str) -> bool {
        self.name.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
    }

    /// The temporary name, for a library that opens files itself.
    #[cfg(feature = "cgns")]
    pub(super) fn path(&self) -> &Path {
        self.file.path()
    }

    /// Hands the file out to be written to.
    ///
    /// # Errors
    /// What the content returns, and the system.
    pub(super) fn stream(
        &mut self,
        content: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), Unwritten>,
    ) -> Result<(), Unwritten> {
        let mut out = BufWriter::with_capacity(BUFFER, self.file.as_file_mut());
        content(&mut out)?;
        Ok(out.flush()?)
    }

    /// Gives the file its name, once it is on disk.
    fn complete(self, target: &Path) -> io::Result<()> {
        self.file.as_file().sync_all()?;
        self.file.persist(target).map_err(|refused| refused.error)?;
        match File::open(folder(target)).and_then(|folder| folder.sync_all()) {
            // Some file systems cannot, and some folders may not be read; the file has its name all the same.
            Err(error)
                if !matches!(
                    error.kind(),
                    ErrorKind::InvalidInput | ErrorKind::Unsupported | ErrorKind::PermissionDenied
                ) =>
            {
                Err(error)
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mesh.msh");
        fs::write(&path, "old").unwrap();
        let failed = write(&path, |part| {
            part.stream(|out| Ok(out.write_all(b"half")?))?;
            Err(Unwritten::Inexpressible("because".into()))
        });
        assert!(failed.is_err_and(|e| e.to_string().ends_with("mesh.msh: cannot be written: because")));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
        write(&path, |part| part.stream(|out| Ok(out.write_all(b"new")?))).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_is_no_file_is_not_replaced() {
        let dir = tempfile::tempdir().unwrap();
        assert!(write(dir.path(), |_| Ok(())).is_err());
        assert!(write(&dir.path().join("none/mesh.msh"), |_| Ok(())).is_err());
    }

    #[test]
    fn a_replaced_file_hands_its_mode_on_and_a_new_one_has_the_users() {
        let dir = tempfile::tempdir().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        let (plain, path) = (dir.path().join("plain"), dir.path().join("mesh.msh"));
        File::create(&plain).unwrap();
        write(&path, |_| Ok(())).unwrap();
        assert_eq!(mode(&path), mode(&plain));
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        write(&path, |_| Ok(())).unwrap();
        assert_eq!(mode(&path), 0o640);
    }

    #[test]
    fn a_link_stays_a_link() {
        let dir = tempfile::tempdir().unwrap();
        let (path, link) = (dir.path().join("mesh.msh"), dir.path().join("link.msh"));
        fs::write(&path, "old").unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write(&link, |part| part.stream(|out| Ok(out.write_all(b"new")?))).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn many_writers_of_one_name_leave_one_whole_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mesh.msh");
        std::thread::scope(|scope| {
            for text in ["first", "other"] {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..20 {
                        write(path, |part| part.stream(|out| Ok(out.write_all(text.as_bytes())?))).unwrap();
                    }
                });
            }
        });
        assert!(["first", "other"].contains(&fs::read_to_string(&path).unwrap().as_str()));
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }
}
