//! A file that appears under its name only when it is complete.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use super::Error;

/// Bytes gathered before the system is asked to write.
const BUFFER: usize = 4 << 20;

/// Writes a file under a temporary name beside its target, and gives it its name when all went well.
///
/// Nothing is left behind on failure, and a file that had the name stays as it was.
///
/// # Errors
/// [`Error::Io`], also where the name belongs to something that is not a file; whatever `content` returns.
pub(super) fn write(path: &Path, content: impl FnOnce(&mut Part) -> Result<(), Unwritten>) -> Result<(), Error> {
    let failed = |action| move |source| Error::Io { file: path.to_path_buf(), action, source };
    // A link stays a link: its target is replaced.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    if fs::metadata(&target).is_ok_and(|m| !m.is_file()) {
        return Err(failed("write")(io::Error::other("it exists and is not a regular file")));
    }
    let mut part = Part::create(&target).map_err(failed("create"))?;
    content(&mut part).map_err(|unwritten| match unwritten {
        Unwritten::Io(source) => failed("write")(source),
        Unwritten::Inexpressible(reason) => Error::Inexpressible { file: path.to_path_buf(), reason },
    })?;
    part.rename(&target).map_err(failed("write"))
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
    path: PathBuf,
    file: File,
    kept: bool,
}

impl Part {
    fn create(target: &Path) -> io::Result<Part> {
        let name = target.file_name().ok_or_else(|| io::Error::other("the path names no file"))?;
        let mut part = std::ffi::OsString::from(".");
        part.push(name);
        part.push(format!(".{}.part", std::process::id()));
        let path = target.with_file_name(part);
        let file = OpenOptions::new().write(true).create(true).truncate(true).open(&path)?;
        Ok(Part { path, file, kept: false })
    }

    /// The temporary name, for a library that opens files itself.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Hands the file out to be written to.
    ///
    /// # Errors
    /// What the content returns, and the system.
    pub(super) fn stream(
        &mut self,
        content: impl FnOnce(&mut BufWriter<File>) -> Result<(), Unwritten>,
    ) -> Result<(), Unwritten> {
        let mut out = BufWriter::with_capacity(BUFFER, self.file.try_clone()?);
        content(&mut out)?;
        Ok(out.flush()?)
    }

    fn rename(mut self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        self.kept = true;
        Ok(())
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        if !self.kept {
            // Nothing more can be done about a leftover than to try.
            let _ = fs::remove_file(&self.path);
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
}
