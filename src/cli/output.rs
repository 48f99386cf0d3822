//! What commands hand out: text on stdout, JSON files, and why they could not.

use std::io::Write;
use std::path::Path;

use crate::formats;

/// Whatever stops a command; its message is complete.
pub(super) type Failure = Box<dyn std::error::Error>;

/// Prints a result on stdout; a reader that went away is no failure.
pub(super) fn print(text: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout().lock(), "{text}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Writes a JSON document through a temporary name.
pub(super) fn write_json(path: &Path, document: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_vec_pretty(document)?;
    formats::write_bytes(path, &text)?;
    Ok(())
}
