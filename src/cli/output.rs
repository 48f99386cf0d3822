//! What commands hand out: results on stdout, messages on stderr, JSON files. A reader that went away is no failure: a mesh is written
//! although nobody reads on (`sagitta curve ... 2>&1 | head -1`). What goes wrong beside the result costs an exit code and nothing else.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

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

/// How something is written above the lines that are redrawn on the terminal.
type Above = Box<dyn Fn(&mut dyn FnMut()) + Send>;

static ABOVE: Mutex<Option<Above>> = Mutex::new(None);

/// From here on messages are written in this way; `None` is for a terminal without lines that are redrawn.
#[cfg(feature = "cad")]
pub(super) fn write_messages(above: Option<Above>) {
    *ABOVE.lock().unwrap_or_else(PoisonError::into_inner) = above;
}

/// Writes a line on stderr; where that fails there is no one left to say so to.
pub(super) fn message(text: impl Display) {
    let text = without_numbers_of_errors(&text.to_string());
    let mut write = || {
        let _ = writeln!(io::stderr().lock(), "{text}");
    };
    match &*ABOVE.lock().unwrap_or_else(PoisonError::into_inner) {
        Some(above) => above(&mut write),
        None => write(),
    }
}

/// A message without the system's numbers of errors, which say nothing beside its words.
fn without_numbers_of_errors(text: &str) -> String {
    const BEGIN: &str = " (os error ";
    let mut parts = text.split(BEGIN);
    let mut told = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match part.split_once(')') {
            Some((number, rest)) if number.bytes().all(|byte| byte.is_ascii_digit()) => told += rest,
            _ => told = told + BEGIN + part,
        }
    }
    told
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

#[cfg(test)]
mod tests {
    use super::without_numbers_of_errors;

    #[test]
    fn errors_are_told_without_the_systems_numbers() {
        for (text, told) in [
            ("a: No such file (os error 2)", "a: No such file"),
            ("a: no (os error 13); b (os error 2): c", "a: no; b: c"),
            ("a (os error x) (os error 5", "a (os error x) (os error 5"),
        ] {
            assert_eq!(without_numbers_of_errors(text), told);
        }
    }
}
