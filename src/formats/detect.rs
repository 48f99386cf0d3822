//! What a file shows of its format before it is read, and what a format says to it.

use std::path::Path;

/// What a file shows before it is read.
pub(super) struct Head<'a> {
    /// Its name.
    pub(super) path: &'a Path,
    /// Its first bytes.
    pub(super) bytes: &'a [u8],
    /// The same as text: without a byte-order mark and white space before it.
    pub(super) text: &'a [u8],
}

/// What a format says of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It is of this format, by a mark in its content.
    ByContent,
    /// It may be of this format, by its name; content without a mark.
    ByName,
    /// It is of this format's kin, but not read.
    Refused(Refusal),
    /// It is not of this format.
    No,
}

/// Why a file is of no format that is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    /// Whether it seems to be a mesh all the same.
    pub(super) is_mesh: bool,
    /// What it seems to be, and what to do.
    pub(super) reason: String,
}

impl Refusal {
    /// A file that holds no mesh.
    pub(super) fn other(reason: impl Into<String>) -> Refusal {
        Refusal { is_mesh: false, reason: reason.into() }
    }

    /// A mesh that is not read.
    pub(super) fn unread(reason: impl Into<String>) -> Refusal {
        Refusal { is_mesh: true, reason: reason.into() }
    }
}

impl<'a> Head<'a> {
    pub(super) fn new(path: &'a Path, bytes: &'a [u8]) -> Head<'a> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        Head { path, bytes, text }
    }

    /// The lines of the text, trimmed.
    pub(super) fn lines(&self) -> Vec<String> {
        String::from_utf8_lossy(self.text).lines().map(|line| line.trim().to_owned()).collect()
    }
}
