//! What is told of likely mistakes of use, beside what is wrong.

use std::path::Path;

use clap::error::{ContextKind, ContextValue, ErrorKind};

#[cfg(feature = "cad")]
use super::output::Failure;
use crate::formats;

/// Endings of the names of CAD files.
const CAD: [&str; 6] = ["step", "stp", "iges", "igs", "brep", "brp"];

/// An error of use as this program tells it.
pub(super) fn told(error: &clap::Error) -> String {
    let text = error.render().to_string();
    let text = text.strip_prefix("error: ").unwrap_or(&text).trim_end();
    let tip = tip(error).map_or_else(String::new, |tip| format!("\n\n  tip: {tip}"));
    format!("sagitta: {text}{tip}")
}

fn tip(error: &clap::Error) -> Option<String> {
    let (kind, tip): (_, fn(&str) -> Option<String>) = match error.kind() {
        ErrorKind::InvalidSubcommand => (ContextKind::InvalidSubcommand, command),
        ErrorKind::UnknownArgument => (ContextKind::InvalidArg, argument),
        _ => return None,
    };
    match error.get(kind) {
        Some(ContextValue::String(word)) => tip(word),
        _ => None,
    }
}

/// Of a file where a command is expected.
fn command(word: &str) -> Option<String> {
    let path = Path::new(word);
    if !path.exists() && path.extension().is_none() {
        return None;
    }
    let info = format!("a command comes first, as\n    sagitta info {word}");
    let more = if is_cad(path) {
        String::new()
    } else {
        format!("\n    sagitta curve {word} --cad CAD.step --order 3 -o OUT.msh")
    };
    Some(info + &more)
}

/// Of a file too many.
fn argument(word: &str) -> Option<String> {
    if word.starts_with('-') {
        return None;
    }
    let path = Path::new(word);
    if is_cad(path) {
        return Some(format!("the CAD goes behind --cad: `--cad {word}`"));
    }
    let what =
        if formats::check_output(path, 0, None).is_ok() { "the mesh to write goes behind -o" } else { return None };
    Some(format!("{what}: `-o {word}`"))
}

fn is_cad(path: &Path) -> bool {
    path.extension().is_some_and(|own| CAD.iter().any(|ending| own.eq_ignore_ascii_case(ending)))
}

/// Whether mesh and CAD are what they are given as, as far as a look at them tells.
///
/// # Errors
/// They are exchanged, or the CAD is a mesh, too.
#[cfg(feature = "cad")]
pub(super) fn not_exchanged(mesh: &Path, cad: &Path) -> Result<(), Failure> {
    // What cannot be read is told by those who read it.
    if !formats::is_mesh(cad).unwrap_or(false) {
        return Ok(());
    }
    let (told, exchanged) = (cad.display(), !formats::is_mesh(mesh).unwrap_or(true));
    if exchanged {
        return Err(format!("{told}: a mesh, where the CAD is to be given; exchange it with {}", mesh.display()).into());
    }
    Err(format!("{told}: a mesh, not a CAD file; give a STEP, IGES or BREP file behind --cad").into())
}
