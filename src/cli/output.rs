//! What commands hand out: results on stdout, messages on stderr, JSON files. A reader that went away is no failure: a mesh is written
//! although nobody reads on (`sagitta curve ... 2>&1 | head -1`). What goes wrong beside the result costs an exit code and nothing else.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

use cad::Aabb;

use crate::cli::exit::{DONE, SIDE_FILE};
use crate::formats;

/// Whatever stops a command; its message is complete.
pub(super) type Failure = Box<dyn std::error::Error>;

/// Prints a result on stdout.
///
/// # Errors
/// Stdout takes nothing more, for another reason than that its reader went away: a full disk.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(format!("standard output: cannot be written: {error}").into())
        }
        _ => Ok(()),
    }
}

/// Writes a line on stderr; where that fails there is no one left to say so to.
pub(super) fn message(text: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Writes a JSON document through a temporary name.
pub(super) fn write_json(path: &Path, document: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_vec_pretty(document)?;
    formats::write_bytes(path, &text)?;
    Ok(())
}

/// What is handed out beside the result: what goes wrong with it is told, and the work goes on.
#[derive(Default)]
pub(super) struct Beside {
    failed: bool,
}

impl Beside {
    /// Tells of a failure.
    pub(super) fn tell<E: Display>(&mut self, outcome: Result<(), E>) {
        if let Err(failure) = outcome {
            self.failed = true;
            message(format_args!("sagitta: {failure}"));
        }
    }

    /// The exit code of a command that would end with `code` otherwise: what that says of the result is worth more.
    pub(super) fn exit_code(&self, code: u8) -> u8 {
        if self.failed && code == DONE { SIDE_FILE } else { code }
    }
}

/// A box in words.
pub(super) fn bounds(bounds: Aabb) -> String {
    let [a, b] = [bounds.min, bounds.max];
    format!("box ({}, {}, {}) to ({}, {}, {})", a.x, a.y, a.z, b.x, b.y, b.z)
}
