//! Fluent's meshes as text, read: sections in brackets, faces with the cells on their two sides.
//!
//! Cells are what faces enclose; those that are tets, pyramids, prisms and hexes are read, in a plane triangles and quadrilaterals. After
//! the mesh format appendix of ANSYS Fluent's and TGrid's user guides.

mod fault;
mod lexer;
mod read;

use super::detect::{Head, Verdict};
use super::format::{Format, Holds, Reader};
use crate::element::{Cell, Order};

/// The format of Fluent, TGrid, ICEM and others.
pub(super) static FORMAT: Format = Format {
    name: "Fluent mesh",
    endings: &["cas"],
    detect: |head: &Head| match head.text {
        [b'(', b'0'..=b'9', b' ' | b'0'..=b'9' | b'(', ..] => Verdict::ByContent,
        _ => Verdict::No,
    },
    reader: Some(Reader {
        holds: Holds {
            highest: Order::LINEAR,
            cells: &[Cell::Triangle, Cell::Quad, Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex],
            dimensions: &[2, 3],
            names: true,
            fields: false,
            notes: "also as `.msh`; text; zones as groups; no general polyhedra, no hanging nodes",
        },
        read: |input, _| {
            let path = input.path;
            read::read(&input.whole()?).map_err(|flaw| flaw.of(path))
        },
    }),
    writer: None,
};
