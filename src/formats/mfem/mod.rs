//! MFEM's own meshes, read and written: text, versions 1.0 to 1.3.
//!
//! A file lists the elements and the boundary elements by their corners, each with an attribute; from version 1.3 on attributes have
//! names, as named sets. The nodes of curved elements are a grid function: values of a finite element space whose numbering follows
//! from the elements' corners (`numbering.rs`).

mod collection;
mod elements;
mod fault;
mod geometry;
mod nodes;
mod numbering;
mod read;
mod sets;
mod write;

pub(super) use geometry::of as geometry_of;

use super::detect::{Head, Refusal, Verdict};
use super::format::{Format, Holds, Reader, Writer};
use super::loss::Loss;
use crate::element::{Cell, Order};

/// The format of the finite element library MFEM.
///
/// Its usual ending, `.mesh`, is also that of GMF: a file written for MFEM may have it, others are called `.mfem`.
pub(super) static FORMAT: Format = Format {
    name: "MFEM",
    endings: &["mfem"],
    detect,
    reader: Some(Reader {
        holds: Holds {
            notes: "also as `.mesh`; versions 1.0 to 1.3; nodes of H1 and L2 spaces on Gauss-Lobatto, Gauss-Legendre or even points; \
                    attributes as groups, named by attribute sets",
            ..HOLDS
        },
        read: |input, _| read::read(input.content, input.length).map_err(|flaw| flaw.of(input.path)),
    }),
    writer: Some(Writer {
        holds: Holds {
            notes: "`.mesh` by `--for mfem`; 1.3 with names, else 1.0; nodes on even points in an H1 space, in an L2 space where \
                    pyramids are of P2 or more",
            ..HOLDS
        },
        loses: &[
            Loss::Lower,
            Loss::Strays,
            Loss::NodeNumbers,
            Loss::NodeOrder,
            Loss::Isolated,
            Loss::GroupNumbers,
            Loss::Periodic,
            Loss::Conditions,
            Loss::Parameters,
            Loss::Zones,
        ],
        held: None,
        write: |part, mesh, _| part.stream(|out| write::write(out, mesh)),
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: true, fields: false, notes: "" };

/// Forms of MFEM meshes that are not read, and what brings them into one that is.
const UNREAD: [(&str, &str); 3] = [
    ("MFEM NC mesh", "of elements cut in part (non-conforming), which cannot be curved as they are"),
    ("MFEM NURBS", "of NURBS patches; read it in MFEM, call SetCurvature and save it"),
    ("MFEM INLINE mesh", "of a box, described in words; read it in MFEM and save it"),
];

fn detect(head: &Head) -> Verdict {
    let lines = head.lines();
    let first = lines.first().map_or("", |line| line.as_str());
    match UNREAD.iter().find(|(name, _)| first.starts_with(name)) {
        Some((name, what)) => Verdict::Refused(Refusal::unread(format!("an {name} {what}"))),
        None if first.starts_with("MFEM mesh v1.1") => {
            Verdict::Refused(Refusal::unread("an MFEM mesh v1.1, non-conforming, which cannot be curved as it is"))
        }
        None if first.starts_with("MFEM mesh v1.") => Verdict::ByContent,
        None if first.starts_with("MFEM ") => Verdict::Refused(Refusal::unread(
            "an MFEM file of a kind that is not read; save the mesh in MFEM (Mesh::Save)",
        )),
        None => Verdict::No,
    }
}
