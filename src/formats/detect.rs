//! Which format a mesh file is in: by its content, and by its name where the content has no mark of its own.

use std::path::Path;

use super::format::Format;
use super::registry::{REGISTRY, readable};

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

/// The format of a file; else what to tell the user. Marks in the content come before names.
pub(super) fn detect(head: &Head) -> Result<&'static Format, Refusal> {
    if head.bytes.is_empty() {
        return Err(Refusal::other("the file is empty"));
    }
    let mut by_name = None;
    for &format in REGISTRY {
        match (format.detect)(head) {
            Verdict::ByContent => return Ok(format),
            Verdict::Refused(refusal) => return Err(refusal),
            Verdict::ByName => by_name = by_name.or(Some(format)),
            Verdict::No => {}
        }
    }
    if let Some(refusal) = FOREIGN.iter().find_map(|recognise| recognise(head)) {
        return Err(refusal);
    }
    by_name.ok_or_else(|| Refusal::other(format!("not a mesh file of a known format; {} are read", readable("and"))))
}

/// Files of formats that are not read: what they are, and what to do.
const FOREIGN: &[fn(&Head) -> Option<Refusal>] = &[
    #[cfg(not(feature = "cgns"))]
    cgns,
    step,
    universal,
    xml,
];

#[cfg(not(feature = "cgns"))]
fn cgns(head: &Head) -> Option<Refusal> {
    let reason = "a CGNS file (HDF5), which this program was built without; build it with the Cargo feature cgns";
    head.bytes.starts_with(b"\x89HDF\r\n\x1a\n").then(|| Refusal::unread(reason))
}

fn step(head: &Head) -> Option<Refusal> {
    head.text.starts_with(b"ISO-10303-21").then(|| Refusal::other("a STEP file, which is CAD, not a mesh"))
}

/// A dataset of an I-deas universal file: a line of -1, a line of a number.
fn universal(head: &Head) -> Option<Refusal> {
    let lines = head.lines();
    let known = lines.len() > 1 && lines[0] == "-1" && lines[1].parse::<u32>().is_ok();
    let reason =
        "an I-deas universal file (UNV), which is not read; convert it: gmsh IN.unv -save -format msh41 -o OUT.msh";
    known.then(|| Refusal::unread(reason))
}

fn xml(head: &Head) -> Option<Refusal> {
    let reason = || format!("an XML file, but not a VTU mesh; {} are read", readable("and"));
    head.text.starts_with(b"<").then(|| Refusal::other(reason()))
}
