//! A file under its temporary name, and those that killed runs left behind.
//!
//! Who writes to one holds a lock on it, which ends with the process: one that can be locked is left over. Where the file system has no
//! locks nothing is taken away.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, Permissions, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use rustix::fs::OFlags;
use tempfile::{NamedTempFile, TempPath};

use super::target::{Target, folder};

/// Bytes gathered before the system is asked to write.
const BUFFER: usize = 4 << 20;

/// Mode of a new file, of which the user's mask takes away.
const MODE: u32 = 0o666;

/// Bits of a mode that a new file takes over from the one that it replaces.
const RIGHTS: u32 = 0o777;

/// Bytes of a file's name that its temporary name has, too: a name has 255 at most.
const NAME: usize = 200;

const MARK: &str = ".sagitta-";
const ENDING: &str = ".part";

/// Tries until a temporary name is locked: a run that clears away may be the first to lock it.
const TRIES: usize = 100;

/// Files of this process.
struct Files {
    /// Temporary ones.
    live: Vec<PathBuf>,
    /// What got its name, as that was asked for.
    named: Vec<PathBuf>,
}

static FILES: Mutex<Files> = Mutex::new(Files { live: Vec::new(), named: Vec::new() });

fn files() -> MutexGuard<'static, Files> {
    FILES.lock().unwrap_or_else(PoisonError::into_inner) // lists of names are whole at any time
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
    file: File,
    path: TempPath,
    /// The name that it will have, as it was asked for.
    name: PathBuf,
}

impl Part {
    /// A new file beside its target that no link leads elsewhere: its name was taken by nothing. What killed runs left of the same
    /// target is removed.
    pub(super) fn create(name: &Path, target: &Target) -> io::Result<Part> {
        let Some(own) = target.path.file_name() else { return Err(io::Error::other("the path names no file")) };
        let (folder, prefix) = (folder(&target.path), prefix(own));
        clear(folder, &prefix);
        for _ in 0..TRIES {
            let (file, path) = new(folder, &prefix)?.into_parts();
            let part = Part { file, path, name: name.to_path_buf() };
            if let Err(TryLockError::WouldBlock) = part.file.try_lock() {
                continue; // another run takes it for a left one
            }
            let metadata = part.file.metadata()?;
            if metadata.nlink() == 0 {
                continue; // that run has removed it
            }
            if let Some(mode) = &target.mode {
                part.file.set_permissions(Permissions::from_mode(mode.mode() & RIGHTS))?;
            }
            return Ok(part);
        }
        Err(io::Error::other("no temporary file can be kept beside it"))
    }

    /// Whether its name will have this ending, for a format that has several.
    pub(super) fn is_named(&self, ending: &str) -> bool {
        self.name.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
    }

    /// The name that it will have.
    pub(super) fn name(&self) -> &Path {
        &self.name
    }

    /// The temporary name, for a library that opens files itself.
    #[cfg(feature = "cgns")]
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Hands the file out to be written to.
    ///
    /// # Errors
    /// What the content returns, and the system.
    pub(super) fn stream(
        &mut self,
        content: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), Unwritten>,
    ) -> Result<(), Unwritten> {
        let mut out = BufWriter::with_capacity(BUFFER, &mut self.file);
        content(&mut out)?;
        Ok(out.flush()?)
    }

    /// Gives the file its name, once it is on disk.
    pub(super) fn complete(mut self, target: &Target) -> io::Result<()> {
        self.file.sync_all()?;
        let (own, named) = (self.file.metadata()?, fs::symlink_metadata(&self.path)?);
        if (own.dev(), own.ino()) != (named.dev(), named.ino()) {
            self.path.disable_cleanup(true);
            return Err(io::Error::other("someone has put something else in the place of its temporary file"));
        }
        let mut files = files(); // an end at this moment waits until it is known what is there
        fs::rename(&self.path, &target.path)?;
        self.path.disable_cleanup(true);
        if !files.named.contains(&self.name) {
            files.named.push(self.name.clone());
        }
        match File::open(folder(&target.path)).and_then(|folder| folder.sync_all()) {
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

impl Drop for Part {
    fn drop(&mut self) {
        let path: &Path = &self.path;
        files().live.retain(|own| own != path);
    }
}

/// Creates a file, known to [`abandon`].
fn new(folder: &Path, prefix: &OsStr) -> io::Result<NamedTempFile> {
    let mut files = files();
    let mut builder = tempfile::Builder::new();
    let builder = builder.prefix(prefix).suffix(ENDING).permissions(Permissions::from_mode(MODE));
    let file = builder.tempfile_in(folder)?;
    files.live.push(file.path().to_path_buf());
    Ok(file)
}

/// How temporary names of a file begin.
fn prefix(name: &OsStr) -> OsString {
    let bytes = name.as_bytes();
    let mut prefix = OsString::from(".");
    prefix.push(OsStr::from_bytes(&bytes[..bytes.len().min(NAME)]));
    prefix.push(MARK);
    prefix
}

/// Removes what killed runs left; what cannot be looked at stays.
fn clear(folder: &Path, prefix: &OsStr) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let left =
        |name: &OsStr| name.as_bytes().starts_with(prefix.as_bytes()) && name.as_bytes().ends_with(ENDING.as_bytes());
    for entry in entries.flatten().filter(|entry| left(&entry.file_name())) {
        if entry.file_type().is_ok_and(|kind| kind.is_file()) {
            let _ = remove_left(&entry.path());
        }
    }
}

/// Removes a temporary file that nobody writes to.
fn remove_left(path: &Path) -> io::Result<()> {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    // Some network file systems lock only what is open for writing.
    let file = File::options().read(true).write(true).custom_flags(flags.bits().cast_signed()).open(path)?;
    match file.try_lock() {
        Ok(()) => fs::remove_file(path),
        Err(TryLockError::WouldBlock) => Ok(()),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// Removes the temporary files of this process, which is about to end: no file is made or gets its name from here on. Returns those
/// that got theirs before, as they were asked for.
pub fn abandon() -> Vec<PathBuf> {
    let mut files = files();
    for path in &files.live {
        let _ = fs::remove_file(path); // it may have got its name
    }
    let named = std::mem::take(&mut files.named);
    std::mem::forget(files); // whoever waits for it waits for the end
    named
}
