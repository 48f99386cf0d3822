//! The files of a command: none that it writes is one that it reads, or another that it writes; and those that it writes are tried before
//! the work begins.

use std::ffi::OsString;
use std::fs::{self, File, Metadata};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

use crate::cli::output::Failure;
use crate::formats::{self, Solver};

/// Bytes that a file beside the result may have.
const SMALL: u64 = 1 << 12;

/// A mesh that is written has at least one byte for so many of the one that it is made from: text becomes binary.
const SHRINKS: u64 = 4;

/// Pairs of a file that is written and one that is read that may be one: a run that goes on keeps its state where it was.
const ONE: [(&str, &str); 1] = [("--checkpoint", "--resume")];

/// What a command reads and writes, each with its option or what the help calls it.
#[derive(Default)]
pub(super) struct Files {
    read: Vec<(&'static str, PathBuf)>,
    written: Vec<(&'static str, PathBuf)>,
    /// The mesh that is written.
    output: Option<PathBuf>,
    /// Further meshes that are written, for no solver.
    meshes: Vec<PathBuf>,
    /// The solver that it is for.
    solver: Option<&'static Solver>,
    /// Bytes that it has at least.
    expected: u64,
}

/// Two files of a command that are one.
#[derive(Debug, thiserror::Error)]
#[error("{file}: {role} is the same file as {other}, which would be lost; give another name")]
struct Clash {
    file: String,
    role: &'static str,
    other: String,
}

impl Files {
    /// Those of a command that reads a mesh.
    pub(super) fn of_mesh(path: &Path) -> Files {
        let expected = fs::metadata(path).map_or(0, |metadata| metadata.len() / SHRINKS);
        let files = Files { expected, ..Files::default() };
        let beside = formats::beside(path).into_iter();
        beside.fold(files.reads("the mesh", Some(path)), |files, path| {
            files.reads("a file read with the mesh", Some(path))
        })
    }

    /// Adds one that is read, where it is given.
    pub(super) fn reads(mut self, role: &'static str, path: Option<impl Into<PathBuf>>) -> Files {
        self.read.extend(path.map(|path| (role, path.into())));
        self
    }

    /// Adds one that is written, where it is given.
    pub(super) fn writes(mut self, role: &'static str, path: Option<impl Into<PathBuf>>) -> Files {
        self.written.extend(path.map(|path| (role, path.into())));
        self
    }

    /// Adds the mesh that is written, and the solver that it is for, where they are given.
    pub(super) fn writes_mesh(mut self, path: Option<impl Into<PathBuf>>, solver: Option<&'static Solver>) -> Files {
        self.solver = solver;
        self.output = path.map(Into::into);
        let output = self.output.clone();
        self.writes("--output", output)
    }

    /// Adds further files with a mesh that are written.
    pub(super) fn writes_meshes_beside(
        mut self,
        role: &'static str,
        paths: impl IntoIterator<Item = impl Into<PathBuf>>,
    ) -> Files {
        for path in paths {
            let path = path.into();
            self.meshes.push(path.clone());
            self.written.push((role, path));
        }
        self
    }

    /// Whether all is well.
    ///
    /// # Errors
    /// Two of the files are one, or one cannot be written.
    pub(super) fn check(&self) -> Result<(), Failure> {
        self.apart()?;
        self.outside_folders()?;
        if let Some(output) = &self.output {
            formats::check_output(output, self.expected, self.solver)?;
        }
        for path in &self.meshes {
            formats::check_output(path, self.expected, None)?;
        }
        for (_, path) in &self.written {
            formats::check_file(path, SMALL)?;
        }
        Ok(())
    }

    /// Whether no other file lies in a folder that is written along with a mesh.
    fn outside_folders(&self) -> Result<(), Failure> {
        for (role, path) in &self.written {
            let Some(folder) = formats::folder_beside(path).and_then(|folder| folder.canonicalize().ok()) else {
                continue;
            };
            let lies_inside = |own: &Path| {
                let target = formats::followed(own).and_then(|target| formats::folder(&target).canonicalize());
                target.is_ok_and(|parent| parent == folder)
            };
            if let Some((other, own)) = self.read.iter().chain(&self.written).find(|(_, own)| lies_inside(own)) {
                let (file, folder, own) = (path.display(), folder.display(), own.display());
                return Err(format!(
                    "{file}: {role} writes to the folder {folder}, in which {other} is ({own}); give another name"
                )
                .into());
            }
        }
        Ok(())
    }

    /// Whether no file is written that is anything else.
    fn apart(&self) -> Result<(), Clash> {
        let named = |(role, path): &(&'static str, PathBuf)| (*role, path.clone(), identity(path));
        let read: Vec<_> = self.read.iter().map(named).collect();
        let written: Vec<_> = self.written.iter().map(named).collect();
        let (stdout, stderr) = (std::io::stdout(), std::io::stderr());
        let streams = [("standard output", of_stream(stdout.as_fd())), ("standard error", of_stream(stderr.as_fd()))];
        for (n, (role, path, own)) in written.iter().enumerate() {
            let Some(own) = own else { continue };
            let others = read.iter().chain(&written[..n]);
            let others = others.map(|(other, name, identity)| (*other, (name != path).then_some(name), identity));
            let streams = streams.iter().map(|(other, identity)| (*other, None, identity));
            let mut all = others.chain(streams).filter(|(other, ..)| !ONE.contains(&(role, other)));
            if let Some((other, name, _)) = all.find(|(.., identity)| identity.as_ref() == Some(own)) {
                let name = name.map_or_else(String::new, |name| format!(" ({})", name.display()));
                return Err(Clash { file: path.display().to_string(), role, other: format!("{other}{name}") });
            }
        }
        Ok(())
    }
}

/// What tells a file from all others, whatever it is called.
#[derive(PartialEq, Eq)]
enum Identity {
    There {
        device: u64,
        inode: u64,
    },
    /// One that is not there yet, by its folder.
    New {
        device: u64,
        inode: u64,
        name: OsString,
    },
}

impl Identity {
    fn of(metadata: &Metadata) -> Identity {
        Identity::There { device: metadata.dev(), inode: metadata.ino() }
    }
}

/// The file behind a name and its links; `None` where there can be none.
fn identity(path: &Path) -> Option<Identity> {
    if let Ok(metadata) = fs::metadata(path) {
        return Some(Identity::of(&metadata));
    }
    let target = formats::followed(path).ok()?;
    let folder = fs::metadata(formats::folder(&target)).ok()?;
    Some(Identity::New { device: folder.dev(), inode: folder.ino(), name: target.file_name()?.to_owned() })
}

/// The file that a stream goes to.
fn of_stream(stream: BorrowedFd) -> Option<Identity> {
    let metadata = File::from(stream.try_clone_to_owned().ok()?).metadata().ok()?;
    metadata.is_file().then(|| Identity::of(&metadata))
}
