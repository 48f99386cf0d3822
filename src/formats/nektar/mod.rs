//! Nektar++'s meshes in XML, read and written.
//!
//! A file lists vertices, edges by vertices, faces by edges and elements by faces; curved edges and faces have points, elements have none
//! inside: Nektar++ continues the faces (`modified.rs`). Composites are the groups. What must be numbered how so that neighbours agree
//! stands in `corners.rs`. After the user guide, section "Geometry", and the program's own reader (`SpatialDomains/MeshGraphIOXml.cpp`).

mod assemble;
mod composite;
mod corners;
mod curve;
mod fault;
mod held;
mod modified;
mod packed;
mod read;
mod shape;
mod straight;
mod tables;
mod write;

use glam::DVec3;

use super::detect::{Head, Verdict};
use super::format::{Format, Holds, Reader, Writer};
use super::loss::Loss;
use crate::element::{Cell, Order};
use crate::mesh::Mesh;

/// The format of the spectral element framework Nektar++.
pub(super) static FORMAT: Format = Format {
    name: "Nektar++ XML",
    endings: &["xml"],
    detect,
    reader: Some(Reader {
        holds: Holds {
            notes: "as text or packed (B64Z); curves on even or Gauss-Lobatto points, pyramids to P2; composites as groups",
            ..HOLDS
        },
        read: |input, options| {
            let (path, memory) = (input.path, options.memory());
            read::read(&input.whole()?, memory).map_err(|flaw| flaw.of(path))
        },
    }),
    writer: Some(Writer {
        holds: Holds {
            notes: "as text; curves of edges and faces that are not straight, pyramids to P2; nodes inside cells are where Nektar++ \
                    makes them from the faces",
            ..HOLDS
        },
        loses: &[
            Loss::Lower,
            Loss::Strays,
            Loss::NodeNumbers,
            Loss::NodeOrder,
            Loss::Isolated,
            Loss::Periodic,
            Loss::Conditions,
            Loss::Parameters,
            Loss::Zones,
        ],
        held: Some(held),
        write: |part, mesh, _| part.stream(|out| write::write(out, mesh)),
    }),
};

const HOLDS: Holds = Holds {
    highest: Order::MAX,
    cells: &[Cell::Triangle, Cell::Quad, Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex, Cell::Line, Cell::Point],
    dimensions: &[2, 3],
    names: true,
    fields: false,
    notes: "",
};

fn detect(head: &Head) -> Verdict {
    let is = head.text.starts_with(b"<") && head.bytes.windows(7).any(|window| window.eq_ignore_ascii_case(b"<NEKTAR"));
    if is { Verdict::ByContent } else { Verdict::No }
}

/// The points of a mesh as Nektar++ has it.
///
/// # Errors
/// Elements that it cannot have.
fn held(mesh: &Mesh) -> Result<Vec<DVec3>, String> {
    Ok(held::Held::of(mesh)?.points)
}
