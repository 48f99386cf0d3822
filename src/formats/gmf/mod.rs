//! GMF, the mesh format of INRIA's tools (libMeshb, Feflo.a, ViZiR) and of NASA's refine: `.meshb` as bytes, `.mesh` as text.
//!
//! A file is a row of keywords, each with a count and as many rows of numbers. Versions differ in binary files: 1 has single
//! precision, 3 positions of 8 bytes, 4 whole numbers of 8 bytes too. References of elements are the tags of their entities. Nodes
//! of elements of higher order have the order that a keyword such as `TetrahedraP3Ordering` gives; without it that of CGNS.

mod association;
mod fault;
mod header;
mod keyword;
mod node_order;
mod read;
mod sink;
mod source;
mod write;

#[cfg(test)]
mod tests;

use super::detect::{Head, Verdict};
use super::error::Error;
use super::format::{Format, Holds, Input, Reader, Writer};
use super::loss::Loss;
use super::options::ReadOptions;
use crate::element::{Cell, Order};
use crate::mesh::Mesh;
use source::Source;

/// INRIA's format.
pub(super) static FORMAT: Format = Format {
    name: "INRIA GMF",
    endings: &["meshb", "mesh"],
    detect,
    reader: Some(Reader {
        holds: Holds {
            notes: "versions 1 to 4, binary and text; references as entity tags; `VerticesOnGeometric*` as classification and \
                    parameters of nodes",
            ..HOLDS
        },
        read: open,
    }),
    writer: Some(Writer {
        holds: Holds {
            notes: "`.meshb` binary, of version 2, or 3 and 4 where the size needs it; `.mesh` text; with `...Ordering` keywords",
            ..HOLDS
        },
        loses: &[Loss::NodeNumbers, Loss::Names, Loss::Periodic, Loss::Conditions, Loss::Zones],
        held: None,
        write: |part, mesh, _| {
            let binary = !part.is_named("mesh");
            part.stream(|out| write::write(out, mesh, binary))
        },
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: false, fields: false, notes: "" };

fn detect(head: &Head) -> Verdict {
    let first = head.lines().into_iter().find(|line| !line.is_empty() && !line.starts_with('#')).unwrap_or_default();
    if first.starts_with("MeshVersionFormatted") || header::is_binary(head.bytes) {
        return Verdict::ByContent;
    }
    Verdict::No
}

fn open(input: Input, _: &ReadOptions) -> Result<Mesh, Error> {
    let Input { path, length, head, content } = input;
    let source = if header::is_binary(&head) { Source::binary(content, length) } else { Source::text(content, length) };
    source.and_then(read::mesh).map_err(|flaw| flaw.of(path))
}
