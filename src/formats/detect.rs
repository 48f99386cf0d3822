//! Which format a mesh file is in: by its content, and by its name where the content has no mark of its own.

use std::path::Path;

use super::{plot3d, ugrid};

/// The formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Msh,
    Cgns,
    Ugrid,
    Su2,
    Vtu,
    LegacyVtk,
    Plot3d,
}

/// Bytes of the head that are looked at.
pub(super) const HEAD: usize = 4096;

const KNOWN: &str = "Gmsh MSH 4.1 and 2.2, CGNS, UGRID, SU2, VTU, legacy VTK and PLOT3D are read";

/// Why a file is of no format that is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Refusal {
    /// Whether it seems to be a mesh all the same.
    pub(super) is_mesh: bool,
    /// What it seems to be, and what to do.
    pub(super) reason: String,
}

fn other(reason: impl Into<String>) -> Refusal {
    Refusal { is_mesh: false, reason: reason.into() }
}

fn unread(reason: impl Into<String>) -> Refusal {
    Refusal { is_mesh: true, reason: reason.into() }
}

/// What a file seems to be; else what to tell the user.
pub(super) fn detect(path: &Path, head: &[u8]) -> Result<Format, Refusal> {
    let text = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head).trim_ascii_start();
    if head.is_empty() {
        return Err(other("the file is empty"));
    }
    if text.starts_with(b"$") {
        return Ok(Format::Msh);
    }
    if head.starts_with(b"\x89HDF\r\n\x1a\n") {
        return Ok(Format::Cgns);
    }
    if head.get(4..).is_some_and(|rest| rest.starts_with(b"ADF Database Version")) {
        let reason = "a CGNS file in the old ADF form; rewrite it as HDF5: adf2hdf IN.cgns OUT.cgns \
                      (Debian package cgns-convert)";
        return Err(unread(reason));
    }
    if text.starts_with(b"# vtk DataFile") {
        return Ok(Format::LegacyVtk);
    }
    if text.starts_with(b"<") {
        return xml(text);
    }
    if is_su2(text) {
        return Ok(Format::Su2);
    }
    if ugrid::is_name(path) {
        return Ok(Format::Ugrid);
    }
    if plot3d::is_name(path) {
        return Ok(Format::Plot3d);
    }
    Err(if text.starts_with(b"ISO-10303-21") {
        other("a STEP file, which is CAD, not a mesh")
    } else if is_unv(text) {
        unread(
            "an I-deas universal file (UNV), which is not read; convert it: gmsh IN.unv -save -format msh41 -o OUT.msh",
        )
    } else {
        other(format!("not a mesh file of a known format; {KNOWN}"))
    })
}

fn xml(text: &[u8]) -> Result<Format, Refusal> {
    let text = String::from_utf8_lossy(text);
    match text.split_once("<VTKFile") {
        Some((_, rest)) if rest.split('>').next().is_some_and(|tag| tag.contains("\"UnstructuredGrid\"")) => {
            Ok(Format::Vtu)
        }
        Some(_) => Err(unread("a VTK XML file, but of no UnstructuredGrid; save the mesh as VTU")),
        None => Err(other(format!("an XML file, but no VTU mesh; {KNOWN}"))),
    }
}

/// Whether the first lines that are no comments are SU2's.
fn is_su2(text: &[u8]) -> bool {
    let text = String::from_utf8_lossy(text);
    let line = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('%'));
    let key = line.and_then(|line| line.split_once('=')).map(|(key, _)| key.trim());
    key.is_some_and(|key| matches!(key, "NDIME" | "NZONE" | "IZONE" | "NELEM" | "NPOIN" | "NMARK" | "NPERIODIC"))
}

/// Whether the file begins as a dataset of a universal file: a line of -1, a line of a number.
fn is_unv(text: &[u8]) -> bool {
    let text = String::from_utf8_lossy(text);
    let mut lines = text.lines().map(str::trim);
    lines.next() == Some("-1") && lines.next().is_some_and(|number| number.parse::<u32>().is_ok())
}
