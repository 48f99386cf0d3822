//! Pages for browsers as files.

use std::path::{Path, PathBuf};

use crate::cli::output::Failure;
use crate::formats;

/// The name of a page.
pub(super) fn html_name(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_page =
        path.extension().is_some_and(|ending| ["html", "htm"].iter().any(|own| ending.eq_ignore_ascii_case(own)));
    if is_page { Ok(path) } else { Err(format!("{text:?} does not end in .html, as pages for browsers do")) }
}

/// Writes a page.
pub(super) fn write_page(path: &Path, text: &str) -> Result<(), Failure> {
    formats::write_bytes(path, text.as_bytes())?;
    Ok(())
}
