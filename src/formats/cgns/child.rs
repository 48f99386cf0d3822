//! The reading child: a process that parses a file for its parent, as malformed ones make the HDF5 library crash or hang.

use std::io::BufWriter;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use cad::child::{ChildError, Limits, run};

use super::dump;
use super::fault::CgnsFault;
use crate::formats::error::{Error, Flaw, Place};

/// First argument with which a program must call [`serve_reader`]; the second is the file.
pub const READER_SUBCOMMAND: &str = "__read-cgns";

/// Variable in which the parent hands the memory that reading may take (bytes) to the child.
const ROOM_VARIABLE: &str = "SAGITTA_READER_ROOM";

/// Address space of the child beside what its answer takes, in bytes: the program itself, and the library's own.
const OWN: u64 = 1 << 30;

/// Seconds that reading may take, beside one for every ten megabytes.
const SECONDS: u64 = 60;

/// Body of the hidden subcommand: reads the tree and writes it to standard output.
#[must_use]
pub fn serve_reader(path: &Path) -> ExitCode {
    cad::child::keep_to_limits();
    let Some(out) = cad::child::take_stdout() else { return ExitCode::FAILURE };
    let length = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    let memory = std::env::var(ROOM_VARIABLE).ok().and_then(|text| text.parse().ok()).unwrap_or(u64::MAX);
    // Where the library crashes the parent tells at which node.
    let visit = |node: &str| cad::child::warn(node);
    match dump::write(path, dump::room(length, memory), &mut BufWriter::with_capacity(1 << 20, out), visit) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

/// What the child says of the user's file `path` of `length` bytes, which stands in `file`, where reading may take `memory` bytes.
///
/// # Errors
/// [`Error`]: also where the library crashed or hung.
pub(super) fn ask(program: &Path, path: &Path, file: &Path, length: u64, memory: u64) -> Result<Vec<u8>, Error> {
    // The child tells of each node before it looks at it.
    let flaw = |nodes: &[String], fault: CgnsFault| {
        let node = nodes.last().cloned().unwrap_or_else(|| "/".to_owned());
        Flaw::new(Place::Node(node), fault).of(path)
    };
    let room = dump::room(length, memory);
    let limits = Limits {
        timeout: Duration::from_secs(SECONDS + length / 10_000_000),
        memory: OWN.saturating_add(room.saturating_mul(2)),
        output: room.saturating_mul(2),
    };
    let outcome =
        run(program, READER_SUBCOMMAND, file, &[(ROOM_VARIABLE, memory.to_string())], limits).map_err(|error| {
            match error {
                ChildError::TimedOut { warnings } => flaw(&warnings, CgnsFault::Slow(limits.timeout.as_secs())),
                ChildError::TooMuch => flaw(&[], CgnsFault::TooMuch(limits.output >> 20)),
                ChildError::Run(source) => {
                    let what = format!("the reading process {} cannot be run: {source}", program.display());
                    Error::Io { file: path.to_path_buf(), action: "read", source: std::io::Error::other(what) }
                }
            }
        })?;
    if outcome.killed().is_some() {
        let what = format!("the reading process was killed ({}); {}", outcome.status, ChildError::KILLED);
        return Err(Error::Io { file: path.to_path_buf(), action: "read", source: std::io::Error::other(what) });
    }
    match (outcome.status.success(), outcome.status.signal()) {
        (true, _) => Ok(outcome.bytes),
        // Rust's allocator aborts where it gets no memory.
        (_, Some(6)) => Err(flaw(&outcome.warnings, CgnsFault::Memory(limits.memory >> 20))),
        _ => Err(flaw(&outcome.warnings, CgnsFault::Crash(outcome.status.to_string()))),
    }
}
