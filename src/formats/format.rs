//! What the rest of the program knows of a mesh file format.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use glam::DVec3;

use super::detect::{Head, Verdict};
use super::error::Error;
use super::loss::Loss;
use super::options::{ReadOptions, WriteOptions};
use super::part::{Part, Unwritten};
use crate::element::{Cell, Order};
use crate::mesh::Mesh;

/// A mesh file format: its name, how its files are recognised, and how they are read and written.
pub struct Format {
    /// What people call it.
    pub name: &'static str,
    /// Endings of its files' names, without the dot, the usual one first.
    pub endings: &'static [&'static str],
    pub(super) detect: fn(&Head) -> Verdict,
    /// How it is read, where it is.
    pub reader: Option<Reader>,
    /// How it is written, where it is.
    pub writer: Option<Writer>,
}

/// How a format is read.
pub struct Reader {
    /// What is read of it.
    pub holds: Holds,
    pub(super) read: fn(Input, &ReadOptions) -> Result<Mesh, Error>,
}

/// The points of a mesh as the files of a format hold it; why they cannot hold it, where they cannot.
pub(super) type Held = fn(&Mesh) -> Result<Vec<DVec3>, String>;

/// How a format is written.
pub struct Writer {
    /// What is written to it.
    pub holds: Holds,
    /// What a mesh may have and files do not hold; it is told when there is something to lose.
    pub(super) loses: &'static [Loss],
    /// The points of a mesh as files hold it, of a format that does not hold them all.
    pub(super) held: Option<Held>,
    pub(super) write: fn(&mut Part, &Mesh, &WriteOptions) -> Result<(), Unwritten>,
}

/// What files of a format can hold, as far as it is read or written.
pub struct Holds {
    /// The highest order of elements; all from P1 on.
    pub highest: Order,
    /// Kinds of cells.
    pub cells: &'static [Cell],
    /// Dimensions of the mesh itself.
    pub dimensions: &'static [usize],
    /// Whether patches and groups have names.
    pub names: bool,
    /// Whether [`WriteOptions::fields`] are written.
    pub fields: bool,
    /// Versions, encodings, and what else a user must know, in one line.
    pub notes: &'static str,
}

impl Format {
    /// Whether a file's name has one of the format's endings.
    #[must_use]
    pub fn is_name(&self, path: &Path) -> bool {
        let own = path.extension();
        own.is_some_and(|own| self.endings.iter().any(|ending| own.eq_ignore_ascii_case(ending)))
    }
}

impl Holds {
    /// Why a mesh does not fit, where it does not.
    pub(super) fn refusal(&self, mesh: &Mesh) -> Option<String> {
        let foreign = mesh.blocks().iter().find(|block| !block.tags.is_empty() && !self.cells.contains(&block.cell));
        match foreign {
            _ if mesh.order() > self.highest => {
                Some(format!("the format has no elements of {}; {} is its highest order", mesh.order(), self.highest))
            }
            Some(block) => Some(format!("the format has no {}", block.cell)),
            None => None,
        }
    }
}

/// Bytes asked of the system at a time.
const BUFFER: usize = 1 << 20;

/// Bytes of a file's head that are looked at to find its format.
pub(super) const HEAD: usize = 4096;

/// A file that is to be read.
pub(super) struct Input<'a> {
    /// Its name.
    pub(super) path: &'a Path,
    /// Its length in bytes.
    pub(super) length: u64,
    /// Its first bytes, [`HEAD`] at most.
    pub(super) head: Vec<u8>,
    /// All of it, from the beginning.
    pub(super) content: BufReader<File>,
}

impl<'a> Input<'a> {
    /// A regular file.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub(super) fn open(path: &'a Path) -> Result<Input<'a>, Error> {
        let failed = |source| Error::Io { file: path.to_path_buf(), action: "read", source };
        let file = cad::regular::open(path).map_err(failed)?;
        let length = file.metadata().map_err(failed)?.len();
        let mut content = BufReader::with_capacity(BUFFER, file);
        let head = content.fill_buf().map_err(failed)?;
        let head = head[..head.len().min(HEAD)].to_vec();
        Ok(Input { path, length, head, content })
    }

    /// What tells the format.
    pub(super) fn head(&self) -> Head<'_> {
        Head::new(self.path, &self.head)
    }

    /// The whole content in memory.
    pub(super) fn whole(mut self) -> Result<Vec<u8>, Error> {
        let mut whole = Vec::new();
        let failed = |source| Error::Io { file: self.path.to_path_buf(), action: "read", source };
        self.content.read_to_end(&mut whole).map_err(failed)?;
        Ok(whole)
    }
}
