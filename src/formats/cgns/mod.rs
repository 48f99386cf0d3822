//! CGNS (HDF5), unstructured zones: read in a child process, written by ourselves.
//!
//! A file is a tree of nodes with a name, a label and an array. The HDF5 library, which malformed files make crash, sees a
//! file only in a child process (`child`), which hands the tree on as plain bytes; `tree` takes it apart, and the mesh is
//! made from it in safe code.

mod child;
mod conditions;
mod connections;
mod fault;
mod labels;
mod node;
mod read;
mod sections;
mod tree;
mod type_code;
mod write;

use std::os::unix::process::ExitStatusExt;
use std::time::Duration;

use cad::child::{ChildError, Limits, run};

use super::detect::{Head, Refusal, Verdict};
use super::format::{Format, Holds, Input, Reader, Writer};
use super::{Error, ReadOptions};
use crate::element::{Cell, Order};
use crate::mesh::Mesh;

pub use child::{READER_SUBCOMMAND, serve_reader};

/// CGNS on HDF5.
pub(super) static FORMAT: Format = Format {
    name: "CGNS",
    endings: &["cgns"],
    detect,
    reader: Reader {
        holds: Holds {
            notes: "unstructured zones; one type a section or MIXED, with or without offsets; conditions by list, range, \
                    vertices, family; zones joined",
            ..HOLDS
        },
        read,
    },
    writer: Some(Writer {
        holds: Holds {
            notes: "one zone, one section a type; conditions, families, numbers of groups and entities (`Ordinal_t`)",
            ..HOLDS
        },
        write: |part, mesh, _| write::write(part.path(), mesh),
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: true, fields: false, notes: "" };

fn detect(head: &Head) -> Verdict {
    if head.bytes.starts_with(b"\x89HDF\r\n\x1a\n") {
        return Verdict::ByContent;
    }
    if head.bytes.get(4..).is_some_and(|rest| rest.starts_with(b"ADF Database Version")) {
        return Verdict::Refused(Refusal::unread(
            "a CGNS file in the old ADF form; rewrite it as HDF5: adf2hdf IN.cgns OUT.cgns (Debian package cgns-convert)",
        ));
    }
    Verdict::No
}

/// Address space of the child beside four times the file's length.
const MEMORY: u64 = 1 << 30;
/// Seconds that reading may take, beside one for every ten megabytes.
const SECONDS: u64 = 60;

/// Reads a mesh.
///
/// # Errors
/// [`Error`]: also where the HDF5 library crashes or hangs, which happens to the child process only.
fn read(input: Input, options: &ReadOptions) -> Result<Mesh, Error> {
    let Input { path, length, .. } = input;
    let refused = |reason: String| Error::Format { file: path.to_path_buf(), reason };
    let limits = Limits {
        timeout: Duration::from_secs(SECONDS + length / 10_000_000),
        memory: MEMORY.saturating_add(length.saturating_mul(4)),
    };
    // Reading needs no lock, and some file systems have none.
    let unlocked = ("HDF5_USE_FILE_LOCKING", "FALSE".to_owned());
    let outcome = run(&options.reader, READER_SUBCOMMAND, path, &[unlocked], limits).map_err(|error| match error {
        ChildError::TimedOut { .. } => {
            refused(format!("reading took longer than {} s and was ended: a malformed file", limits.timeout.as_secs()))
        }
        ChildError::Run(source) => {
            let what = format!("the reading process {} cannot be run: {source}", options.reader.display());
            Error::Io { file: path.to_path_buf(), action: "read", source: std::io::Error::other(what) }
        }
    })?;
    let tree = tree::Tree::parse(&outcome.bytes).map_err(|failure| match failure {
        tree::Failure::Told(cause) => refused(format!("the HDF5 library cannot read it: {cause}")),
        // Rust's allocator aborts where it gets no memory.
        tree::Failure::Cut if outcome.status.signal() == Some(6) => {
            refused(format!("reading needs more than {} MB of memory: a malformed file", limits.memory >> 20))
        }
        tree::Failure::Cut => {
            refused(format!("the HDF5 library failed while reading it ({}): the file is malformed", outcome.status))
        }
    })?;
    read::mesh(&tree).map_err(|flaw| flaw.of(path))
}
