//! The reading child: a process that parses a file for its parent, as malformed ones make the HDF5 library crash or hang.

use std::io::BufWriter;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use cad::child::{ChildError, Limits, run};

use super::dump;
use crate::formats::Error;

/// First argument with which a program must call [`serve_reader`]; the second is the file.
pub const READER_SUBCOMMAND: &str = "__read-cgns";

/// Seconds that reading may take, beside one for every ten megabytes.
const SECONDS: u64 = 60;

/// Body of the hidden subcommand: reads the tree and writes it to standard output.
#[must_use]
pub fn serve_reader(path: &Path) -> ExitCode {
    cad::child::keep_to_limits();
    let Some(out) = cad::child::take_stdout() else { return ExitCode::FAILURE };
    let length = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    match dump::write(path, dump::room(length), &mut BufWriter::with_capacity(1 << 20, out)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

/// What the child says of a file of `length` bytes.
///
/// # Errors
/// [`Error`]: also where the library crashed or hung.
pub(super) fn ask(program: &Path, path: &Path, length: u64) -> Result<Vec<u8>, Error> {
    let refused = |reason: String| Error::Format { file: path.to_path_buf(), reason };
    let limits = Limits { timeout: Duration::from_secs(SECONDS + length / 10_000_000), memory: dump::room(length) };
    let outcome = run(program, READER_SUBCOMMAND, path, &[], limits).map_err(|error| match error {
        ChildError::TimedOut { .. } => {
            refused(format!("reading took longer than {} s and was ended: a malformed file", limits.timeout.as_secs()))
        }
        ChildError::Run(source) => {
            let what = format!("the reading process {} cannot be run: {source}", program.display());
            Error::Io { file: path.to_path_buf(), action: "read", source: std::io::Error::other(what) }
        }
    })?;
    if outcome.killed().is_some() {
        let what = format!("the reading process was killed ({}); {}", outcome.status, ChildError::KILLED);
        return Err(Error::Io { file: path.to_path_buf(), action: "read", source: std::io::Error::other(what) });
    }
    match (outcome.status.success(), outcome.status.signal()) {
        (true, _) => Ok(outcome.bytes),
        // Rust's allocator aborts where it gets no memory.
        (_, Some(6)) => {
            Err(refused(format!("reading needs more than {} MB of memory: a malformed file", limits.memory >> 20)))
        }
        _ => Err(refused(format!(
            "the HDF5 library failed while reading it ({}): the file is malformed",
            outcome.status
        ))),
    }
}
