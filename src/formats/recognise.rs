//! Which format a mesh file is in: by its content, and by its name where the content has no mark of its own.

use super::detect::{Head, Refusal, Verdict};
use super::format::Format;
use super::registry::{REGISTRY, readable};

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
