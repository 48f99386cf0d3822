//! GMF, the mesh format of INRIA's tools (libMeshb, Feflo.a, ViZiR) and of NASA's refine: `.meshb` as bytes, `.mesh` as text.
//!
//! A file is a row of keywords, each with a count and as many rows of numbers. Versions differ in binary files: 1 has single
//! precision, 3 positions of 8 bytes, 4 whole numbers of 8 bytes too. References of elements are the tags of their entities. Nodes
//! of elements of higher order have the order that a keyword such as `TetrahedraP3Ordering` gives; without it that of CGNS.

mod association;
mod fault;
mod keyword;
mod node_order;
mod read;
mod sink;
mod source;
mod write;

#[cfg(test)]
mod tests;

use super::ReadOptions;
use super::detect::{Head, Refusal, Verdict};
use super::error::Error;
use super::format::{Format, Holds, Input, Reader, Writer};
use crate::element::{Cell, Order};
use crate::mesh::Mesh;
use source::Source;

/// INRIA's format.
pub(super) static FORMAT: Format = Format {
    name: "INRIA GMF",
    endings: &["meshb", "mesh"],
    detect,
    reader: Reader {
        holds: Holds {
            notes: "versions 1 to 4, binary and text; references as entity tags; `VerticesOnGeometric*` as classification and \
                    parameters of nodes",
            ..HOLDS
        },
        read: open,
    },
    writer: Some(Writer {
        holds: Holds {
            notes: "`.meshb` binary, of version 2, or 3 and 4 where the size needs it; `.mesh` text; with `...Ordering` keywords",
            ..HOLDS
        },
        write: |part, mesh, _| {
            let binary = !part.is_named("mesh");
            part.stream(|out| write::write(out, mesh, binary))
        },
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: false, fields: false, notes: "" };

/// Numbers at the beginning of binary files: a mark of the byte order, the version, the keyword `Dimension`.
const MARK: u32 = 1;
const VERSIONS: std::ops::RangeInclusive<u32> = 1..=4;

fn detect(head: &Head) -> Verdict {
    let first = head.lines().into_iter().find(|line| !line.is_empty() && !line.starts_with('#')).unwrap_or_default();
    if first.starts_with("MeshVersionFormatted") || is_binary(head.bytes) {
        return Verdict::ByContent;
    }
    if first.starts_with("MFEM ") {
        let reason = "an MFEM mesh, which is not read; let MFEM write it as VTU (Mesh::PrintVTU)";
        return Verdict::Refused(Refusal::unread(reason));
    }
    Verdict::No
}

/// Whether a file begins as a binary one, in either byte order.
fn is_binary(head: &[u8]) -> bool {
    let word = |n: usize| -> Option<[u8; 4]> { head.get(4 * n..4 * n + 4)?.try_into().ok() };
    let begins = |number: fn([u8; 4]) -> u32| {
        let version = word(1).map_or(0, number);
        // The position of the next keyword is known; behind it stands the dimension.
        let (next, dimension) = if version < 3 { (20, 4) } else { (24, 5) };
        let next_at = if version >= 3 && word(0).map(u32::from_be_bytes) == Some(MARK) { 4 } else { 3 };
        word(0).map(number) == Some(MARK)
            && VERSIONS.contains(&version)
            && word(2).map(number) == Some(keyword::DIMENSION)
            && word(next_at).map(number) == Some(next)
            && matches!(word(dimension).map(number), Some(2 | 3))
    };
    begins(u32::from_le_bytes) || begins(u32::from_be_bytes)
}

fn open(input: Input, _: &ReadOptions) -> Result<Mesh, Error> {
    let Input { path, length, head, content } = input;
    let source = if is_binary(&head) { Source::binary(content, length) } else { Source::text(content, length) };
    source.and_then(read::mesh).map_err(|flaw| flaw.of(path))
}
