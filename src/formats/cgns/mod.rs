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
mod write;

use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::time::Duration;

use cad::child::{ChildError, Limits, run};

use super::{Error, ReadOptions};
use crate::mesh::Mesh;

pub use child::{READER_SUBCOMMAND, serve_reader};
pub use fault::CgnsFault;
pub(super) use write::write;

/// Address space of the child beside four times the file's length.
const MEMORY: u64 = 1 << 30;
/// Seconds that reading may take, beside one for every ten megabytes.
const SECONDS: u64 = 60;

/// Reads a mesh.
///
/// # Errors
/// [`Error`]: also where the HDF5 library crashes or hangs, which happens to the child process only.
pub(super) fn read(path: &Path, length: u64, options: &ReadOptions) -> Result<Mesh, Error> {
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
