//! GMF, the mesh format of INRIA's tools (libMeshb): `.meshb` in binary, `.mesh` as text.
//!
//! A file is a row of keywords, each with a count and as many lines. Elements have a *reference*, which is read as the tag of their
//! entity; nodes may lie on entities of a geometry (`VerticesOnGeometric...`). Elements of P2 to P4 have keywords of their own, and
//! another keyword with the lattice coordinates of their nodes says in which order these follow.

mod fault;
mod keyword;
mod node_order;
mod read;
mod source;
mod write;

use super::detect::{Head, Verdict};
use super::format::{Format, Holds, Reader, Writer};
use crate::element::{Cell, Order};

/// The binary form.
pub(super) static BINARY: Format = Format {
    name: "GMF binary",
    endings: &["meshb"],
    detect: |head| if is_binary(head) { Verdict::ByContent } else { Verdict::No },
    reader: Reader {
        holds: Holds { notes: "versions 1 to 4 of either byte order; node classes and parameters", ..HOLDS },
        read: read::open,
    },
    writer: Some(Writer {
        holds: Holds { notes: "the lowest version from 2 on that has room; node orders written out", ..HOLDS },
        write: |part, mesh, _| part.stream(|out| write::binary(out, mesh)),
    }),
};

/// The form as text.
pub(super) static TEXT: Format = Format {
    name: "GMF text",
    endings: &["mesh"],
    detect: |head| if is_text(head) { Verdict::ByContent } else { Verdict::No },
    reader: Reader {
        holds: Holds { notes: "versions 1 to 4; node classes and parameters", ..HOLDS },
        read: read::open,
    },
    writer: Some(Writer {
        holds: Holds { notes: "version 2; node orders written out", ..HOLDS },
        write: |part, mesh, _| part.stream(|out| write::text(out, mesh)),
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: false, fields: false, notes: "" };

/// Whether a file begins with the number 1, in one of the byte orders, and a version.
fn is_binary(head: &Head) -> bool {
    let Some(&[a, b, c, d, e, f, g, h]) = head.bytes.first_chunk() else { return false };
    let known = |one: u32, version: u32| one == 1 && (1..=4).contains(&version);
    known(u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h]))
        || known(u32::from_be_bytes([a, b, c, d]), u32::from_be_bytes([e, f, g, h]))
}

/// Whether the first word that is no comment is the format's.
fn is_text(head: &Head) -> bool {
    let lines = head.lines();
    let line = lines.iter().find(|line| !line.is_empty() && !line.starts_with('#'));
    line.is_some_and(|line| line.starts_with("MeshVersionFormatted"))
}
