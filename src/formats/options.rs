//! Choices of reading and writing.

use std::path::PathBuf;

use super::field::Field;
use super::grid_layout::GridLayout;

/// How files are read.
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    /// Program in which CGNS files are parsed; default none, which parses them in this process.
    ///
    /// Some malformed CGNS files make the HDF5 library crash, hang or eat up the memory. Who reads files of strangers gives a
    /// program here, which may be his own: it must call `cgns::serve_reader` with the second argument when its first is
    /// `cgns::READER_SUBCOMMAND`, before anything else. It is run with limits of time and memory, and whatever happens to it is
    /// an error here.
    pub reader: Option<PathBuf>,
    /// Bytes of memory that reading one file may take, about; default half of the machine's.
    ///
    /// A file whose mesh takes more is refused, at once where its length tells; so are arrays that expand to more.
    pub memory_limit: Option<u64>,
    /// How a binary PLOT3D file is written, where its length fits several ways.
    pub grid_layout: Option<GridLayout>,
}

/// Bytes of memory that a mesh takes for each byte of its file, at least.
const MEMORY_OF_FILE: u64 = 2;

impl ReadOptions {
    /// The memory that reading may take, in bytes.
    pub(super) fn memory(&self) -> u64 {
        self.memory_limit.unwrap_or_else(cad::memory::half_of_machine)
    }

    /// Whether the mesh of a file of `length` bytes can be read at all.
    ///
    /// # Errors
    /// What to tell the user.
    pub(super) fn check_length(&self, length: u64) -> Result<(), String> {
        let (needed, limit) = (length.saturating_mul(MEMORY_OF_FILE), self.memory());
        if needed <= limit {
            return Ok(());
        }
        Err(format!(
            "reading {} MB takes {} MB of memory at least, and the limit is {} MB; raise it (--memory-limit), or is it no mesh?",
            length >> 20,
            needed >> 20,
            limit >> 20
        ))
    }
}

/// How files are written, where a format leaves a choice.
#[derive(Clone, Copy, Debug, Default)]
pub struct WriteOptions<'a> {
    /// Version of MSH files.
    pub msh_version: Version,
    /// Encoding of MSH files.
    pub msh_encoding: Encoding,
    /// VTU without the cells below the top dimension.
    pub volume_only: bool,
    /// Without the elements below the mesh's own dimension that belong to no physical group.
    pub physical_only: bool,
    /// Values to show, in files for viewers; in MSH files as views.
    pub fields: &'a [Field],
}

/// Versions of MSH files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// 4.1: nodes and elements in blocks by entity.
    #[default]
    V4_1,
    /// 2.2: what older readers take; keeps no boundaries of entities and no node parameters.
    V2_2,
}

impl Version {
    /// All versions that are written.
    pub const ALL: [Version; 2] = [Version::V4_1, Version::V2_2];

    /// What a file of the version says of itself.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Version::V4_1 => "4.1",
            Version::V2_2 => "2.2",
        }
    }
}

/// How the numbers of MSH files are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// As bytes, little-endian.
    #[default]
    Binary,
    /// As text: larger and slower, for readers that take nothing else.
    Ascii,
}
