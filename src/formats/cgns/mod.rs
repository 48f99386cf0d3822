//! CGNS (HDF5), unstructured zones.
//!
//! A file is a tree of nodes with a name, a label and an array. The HDF5 library, which some malformed files make crash or hang,
//! turns it into plain bytes and does nothing else (`dump`): in this process, or, where [`ReadOptions::reader`] names a program,
//! in a child (`child`). `tree` takes the bytes apart, and the mesh is made from it in safe code.

mod child;
mod conditions;
mod connections;
mod dump;
mod fault;
mod labels;
mod node;
mod read;
mod sections;
mod skin;
mod tree;
mod type_code;
mod write;
mod zone;

use super::detect::{Head, Refusal, Verdict};
use super::error::Error;
use super::format::{Format, Holds, Input, Reader, Writer};
use super::options::ReadOptions;
use crate::element::{Cell, Order};
use crate::mesh::Mesh;

pub use child::{READER_SUBCOMMAND, serve_reader};

/// CGNS on HDF5.
pub(super) static FORMAT: Format = Format {
    name: "CGNS",
    endings: &["cgns"],
    detect,
    reader: Reader {
        holds: Holds {
            notes: "unstructured zones; one type a section or MIXED, with or without offsets; conditions by list, range, \
                    vertices, family; zones joined",
            ..HOLDS
        },
        read,
    },
    writer: Some(Writer {
        holds: Holds {
            notes: "one zone, one section a type; conditions, families, numbers of groups and entities (`Ordinal_t`)",
            ..HOLDS
        },
        write: |part, mesh, _| write::write(part.path(), mesh),
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: true, fields: false, notes: "" };

fn detect(head: &Head) -> Verdict {
    if head.bytes.starts_with(b"\x89HDF\r\n\x1a\n") {
        return Verdict::ByContent;
    }
    if head.bytes.get(4..).is_some_and(|rest| rest.starts_with(b"ADF Database Version")) {
        return Verdict::Refused(Refusal::unread(
            "a CGNS file in the old ADF form; rewrite it as HDF5: adf2hdf IN.cgns OUT.cgns (Debian package cgns-convert)",
        ));
    }
    Verdict::No
}

/// Reads a mesh.
///
/// # Errors
/// [`Error`]. With a reader also where the HDF5 library crashes or hangs, which happens to the child only.
fn read(input: Input, options: &ReadOptions) -> Result<Mesh, Error> {
    let Input { path, length, content, .. } = input;
    drop(content); // the library opens files itself
    let refused = |reason: String| Error::Format { file: path.to_path_buf(), reason };
    let bytes = match &options.reader {
        Some(program) => child::ask(program, path, length)?,
        None => {
            let mut bytes = Vec::new();
            let dumped = dump::write(path, dump::room(length), &mut bytes);
            dumped.map_err(|cause| {
                refused(format!("the HDF5 library cannot read it ({cause}): the file is malformed"))
            })?;
            bytes
        }
    };
    let tree = tree::Tree::parse(&bytes).map_err(|failure| match failure {
        tree::Failure::Told(cause) => refused(format!("the HDF5 library cannot read it: {cause}")),
        tree::Failure::Cut => {
            refused("the reading process gave no whole answer; does it call cgns::serve_reader?".into())
        }
    })?;
    read::mesh(&tree).map_err(|flaw| flaw.of(path))
}
