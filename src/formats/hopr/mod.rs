//! HOPR's meshes on HDF5, read and written: those of FLEXI, GALAEXI and FLUXO.
//!
//! Every element has its nodes, row by row, and its sides with their neighbours; boundary conditions have names
//! (`hopr-framework/hopr`, `docs/Meshformat`). Nothing has to be joined by who reads it: thin layers stay what they are.

mod fault;
mod read;
mod rows;
mod sides;
mod write;

use super::cgns;
use super::detect::{Head, Verdict};
use super::format::{Format, Holds, Reader, Writer};
use super::loss::Loss;
use crate::element::{Cell, Order};

/// The format of the preprocessors HOPR and PyHOPE.
pub(super) static FORMAT: Format = Format {
    name: "HOPR HDF5",
    endings: &["h5"],
    detect,
    reader: Some(Reader {
        holds: Holds { notes: "conditions by name; zones as volumes; periodic sides by name", ..HOLDS },
        read: |input, options| cgns::with_tree(input, options, read::mesh),
    }),
    writer: Some(Writer {
        holds: Holds {
            notes: "sides with their neighbours, also periodic ones; boundary types 4, periodic 1, between cells 100",
            ..HOLDS
        },
        loses: &[
            Loss::Lower,
            Loss::Strays,
            Loss::Isolated,
            Loss::CellGroups,
            Loss::GroupNumbers,
            Loss::Conditions,
            Loss::Parameters,
            Loss::Zones,
        ],
        held: None,
        write: |part, mesh, _| write::write(part.path(), mesh),
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[3], names: true, fields: false, notes: "" };

/// HDF5 files with the ending that is HOPR's, or that name its tables early; CGNS names itself there.
fn detect(head: &Head) -> Verdict {
    let holds = |word: &[u8]| head.bytes.windows(word.len()).any(|window| window == word);
    let is_hdf5 = head.bytes.starts_with(b"\x89HDF\r\n\x1a\n") && !holds(b"HDF5 MotherNode");
    let name = head.path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let is_other = [".msh.h5", ".cas.h5", ".dat.h5"].iter().any(|ending| name.ends_with(ending)) || holds(b"VTKHDF");
    let is_named = FORMAT.is_name(head.path) && !is_other;
    if is_hdf5 && (is_named || holds(b"ElemInfo")) { Verdict::ByContent } else { Verdict::No }
}
