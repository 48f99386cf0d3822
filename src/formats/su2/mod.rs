//! SU2's native meshes, read and written: text, boundary elements by marker, elements of higher order as its finite-element solver has them.
//!
//! A file is a row of lines `KEY= value`; some keys count lines of numbers that follow them. Sections that say nothing of the mesh
//! (boxes for deformation, periodic maps, old markers for communication) are passed over with a note, as the solver does.

mod fault;
mod file;
#[cfg(test)]
mod tests;
mod type_code;
mod write;
mod zone;

use super::detect::{Head, Verdict};
use super::format::{Format, Holds, Reader, Writer};
use super::loss::Loss;
use crate::element::{Cell, Order};

/// What is the same read and written.
const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: true, fields: false, notes: "" };

/// The native format of the solver SU2.
pub(super) static FORMAT: Format = Format {
    name: "SU2",
    endings: &["su2"],
    detect,
    reader: Some(Reader {
        holds: Holds {
            notes: "text; several zones, each with its own points; elements of higher order as SU2's finite-element solver \
                    writes them; FFD, periodic and send/receive sections passed over",
            ..HOLDS
        },
        read: |input, _| file::read(input.content, input.length).map_err(|flaw| flaw.of(input.path)),
    }),
    writer: Some(Writer {
        holds: Holds {
            notes: "orders from 2 on as SU2's finite-element solver reads them; volumes that share no points as zones",
            ..HOLDS
        },
        loses: &[
            Loss::Lower,
            Loss::NodeNumbers,
            Loss::CellGroups,
            Loss::GroupNumbers,
            Loss::Periodic,
            Loss::Conditions,
            Loss::Parameters,
        ],
        held: None,
        write: |part, mesh, _| part.stream(|out| write::write(out, mesh)),
    }),
};

/// Whether the first line that is no comment is SU2's.
fn detect(head: &Head) -> Verdict {
    let lines = head.lines();
    let line = lines.iter().find(|line| !line.is_empty() && !line.starts_with('%'));
    match line.and_then(|line| line.split_once('=')).map(|(key, _)| key.trim()) {
        Some("NDIME" | "NZONE" | "IZONE" | "NELEM" | "NPOIN" | "NMARK" | "NPERIODIC" | "NCHUNK" | "AOA_OFFSET")
        | Some("AOS_OFFSET" | "FFD_NBOX") => Verdict::ByContent,
        _ => Verdict::No,
    }
}
