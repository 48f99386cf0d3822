//! HOPR's meshes on HDF5, written: those of FLEXI, GALAEXI and FLUXO.
//!
//! Every element has its nodes, row by row, and its sides with their neighbours; boundary conditions have names
//! (`hopr-framework/hopr`, `docs/Meshformat`). Nothing has to be joined by who reads it: thin layers stay what they are.

mod sides;
mod write;

use super::detect::Verdict;
use super::format::{Format, Holds, Writer};
use super::loss::Loss;
use crate::element::{Cell, Order};

/// The format of the preprocessors HOPR and PyHOPE.
pub(super) static FORMAT: Format = Format {
    name: "HOPR HDF5",
    endings: &["h5"],
    detect: |_| Verdict::No,
    reader: None,
    writer: Some(Writer {
        holds: Holds {
            highest: Order::MAX,
            cells: &Cell::ALL,
            dimensions: &[3],
            names: true,
            fields: false,
            notes: "sides with their neighbours, also periodic ones; boundary types 4, periodic 1, between cells 100",
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
