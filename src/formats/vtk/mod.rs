//! VTK: XML unstructured grids (VTU) read and written, legacy files read.

mod array;
mod collection;
mod compressed;
mod encoded;
mod fault;
mod grid;
#[cfg(feature = "cgns")]
mod hdf;
mod header;
mod legacy;
pub(super) mod node_order;
pub(super) mod type_code;
mod write;
mod written;
mod xml;

use std::io::Write as _;

use super::detect::{Head, Refusal, Verdict};
use super::format::{Format, Holds, Reader, Writer};
use super::loss::Loss;
use crate::element::{Cell, Order};
pub(super) use collection::folder_of;

/// VTK's XML form of unstructured grids.
pub(super) static VTU: Format = Format {
    name: "VTU",
    endings: &["vtu"],
    detect,
    reader: Some(Reader {
        holds: Holds {
            notes: "text, base64, appended raw and base64; zlib, LZ4, LZMA; Lagrange cells, pyramids of P1 only",
            ..HOLDS
        },
        read: |input, options| {
            let path = input.path;
            xml::read(&input.whole()?, options.memory()).map_err(|flaw| flaw.of(path))
        },
    }),
    writer: Some(Writer {
        holds: Holds {
            fields: true,
            notes: "Lagrange cells, appended raw; `--volume-only` for readers that refuse mixed dimensions; pyramids from \
                    P2 on as degenerate hexes",
            ..HOLDS
        },
        loses: LOSES,
        held: None,
        write: |part, mesh, options| part.stream(|out| write::write(out, mesh, options.fields, options.volume_only)),
    }),
};

/// VTK's XML form of several grids in one: the cells and each patch by themselves.
pub(super) static VTM: Format = Format {
    name: "VTM",
    endings: &["vtm"],
    detect: |_| Verdict::No,
    reader: None,
    writer: Some(Writer {
        holds: Holds {
            fields: true,
            notes: "a VTU file for the cells and one a patch, in a folder beside that has its name; each with the fields that \
                    have values there",
            ..HOLDS
        },
        loses: &[Loss::NodeNumbers, Loss::Periodic, Loss::Conditions, Loss::Parameters, Loss::Zones],
        held: None,
        write: |part, mesh, options| {
            let text = collection::write(part.name(), mesh, options.fields)?;
            part.stream(|out| Ok(out.write_all(text.as_bytes())?))
        },
    }),
};

/// VTK's form on HDF5.
#[cfg(feature = "cgns")]
pub(super) static HDF: Format = Format {
    name: "VTKHDF",
    endings: &["vtkhdf"],
    detect: |_| Verdict::No,
    reader: None,
    writer: Some(Writer {
        holds: Holds { fields: true, notes: "as VTU, for large meshes; layout 1.0, VTK 9.1 and later", ..HOLDS },
        loses: LOSES,
        held: None,
        write: |part, mesh, options| hdf::write(part.path(), mesh, options.fields, options.volume_only),
    }),
};

/// VTK's older form.
pub(super) static LEGACY: Format = Format {
    name: "legacy VTK",
    endings: &["vtk"],
    detect: |head| if head.text.starts_with(b"# vtk DataFile") { Verdict::ByContent } else { Verdict::No },
    reader: Some(Reader {
        holds: Holds { notes: "text and binary, 2.0 to 5.1; pyramids of P1 only", ..HOLDS },
        read: |input, _| legacy::read(input.content, input.length).map_err(|flaw| flaw.of(input.path)),
    }),
    writer: None,
};

const LOSES: &[Loss] =
    &[Loss::NodeNumbers, Loss::Names, Loss::Periodic, Loss::Conditions, Loss::Parameters, Loss::Zones];

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: false, fields: false, notes: "" };

fn detect(head: &Head) -> Verdict {
    let text = String::from_utf8_lossy(head.text);
    let Some((_, rest)) = text.split_once("<VTKFile").filter(|_| text.starts_with('<')) else { return Verdict::No };
    match rest.split('>').next().is_some_and(|tag| tag.contains("\"UnstructuredGrid\"")) {
        true => Verdict::ByContent,
        false => Verdict::Refused(Refusal::unread("a VTK XML file, but not an UnstructuredGrid; save the mesh as VTU")),
    }
}
