//! CGNS (HDF5): unstructured zones, and structured ones as hexes or quadrilaterals.
//!
//! A file is a tree of nodes with a name, a label and an array. The HDF5 library, which some malformed files make crash or hang,
//! turns it into plain bytes and does nothing else (`dump`): in this process, or, where [`ReadOptions::reader`] names a program,
//! in a child (`child`). `tree` takes the bytes apart, and the mesh is made from it in safe code.

mod adf;
mod child;
mod conditions;
mod connections;
mod dump;
mod fault;
mod kin;
mod labels;
mod node;
mod read;
mod sections;
mod skin;
mod structured;
mod tree;
mod type_code;
mod write;
mod zone;

use super::detect::{Head, Verdict};
use super::error::{Error, Flaw, Place};
use super::format::{Format, Holds, Input, Reader, Writer};
use super::loss::Loss;
use super::options::ReadOptions;
use std::path::Path;

use crate::element::{Cell, Order};
use crate::mesh::Mesh;
use fault::CgnsFault;

pub use child::{READER_SUBCOMMAND, serve_reader};
pub(super) use dump::create;
pub(super) use labels::HOPR;
pub(super) use tree::Tree;

/// CGNS on HDF5.
pub(super) static FORMAT: Format = Format {
    name: "CGNS",
    endings: &["cgns"],
    detect,
    reader: Some(Reader {
        holds: Holds {
            notes: "unstructured zones, structured ones as hexes and quads; one type a section or MIXED, with or without offsets; conditions by list, range, \
                    vertices, family; zones joined; ADF where adf2hdf is installed",
            ..HOLDS
        },
        read,
    }),
    writer: Some(Writer {
        holds: Holds {
            notes: "one zone, one section a type; conditions, families, numbers of groups and entities (`Ordinal_t`)",
            ..HOLDS
        },
        loses: &[Loss::Lower, Loss::NodeNumbers, Loss::Periodic, Loss::Parameters, Loss::Zones],
        held: None,
        write: |part, mesh, _| write::write(part.path(), mesh),
    }),
};

const HOLDS: Holds =
    Holds { highest: Order::MAX, cells: &Cell::ALL, dimensions: &[2, 3], names: true, fields: false, notes: "" };

fn detect(head: &Head) -> Verdict {
    if !head.bytes.starts_with(b"\x89HDF\r\n\x1a\n") && !adf::is(head.bytes) {
        return Verdict::No;
    }
    kin::refusal(head).map_or(Verdict::ByContent, Verdict::Refused)
}

/// Reads a mesh.
///
/// # Errors
/// [`Error`]. With a reader also where the HDF5 library crashes or hangs, which happens to the child only.
fn read(input: Input, options: &ReadOptions) -> Result<Mesh, Error> {
    if adf::is(&input.head) {
        let Input { path, length, .. } = input;
        let rewritten = adf::rewritten(path, length, options.memory())?;
        let mut mesh = hdf5(path, rewritten.path(), length, options, read::mesh)?;
        mesh.note("the file was rewritten from the old ADF form by adf2hdf".into());
        return Ok(mesh);
    }
    with_tree(input, options, read::mesh)
}

/// Makes a mesh of the tree of a file on HDF5.
///
/// # Errors
/// Those of reading, and of `make`.
pub(super) fn with_tree(
    input: Input,
    options: &ReadOptions,
    make: fn(&Tree) -> Result<Mesh, Flaw>,
) -> Result<Mesh, Error> {
    let Input { path, length, content, .. } = input;
    drop(content); // the library opens files itself
    hdf5(path, path, length, options, make)
}

/// Reads the mesh of the user's file `path` of `length` bytes, which stands in `file`.
fn hdf5(
    path: &Path,
    file: &Path,
    length: u64,
    options: &ReadOptions,
    make: fn(&Tree) -> Result<Mesh, Flaw>,
) -> Result<Mesh, Error> {
    let refused = |reason: String| Error::Format { file: path.to_path_buf(), reason };
    let bytes = match &options.reader {
        Some(program) => child::ask(program, path, file, length, options.memory())?,
        None => {
            let mut bytes = Vec::new();
            let dumped = dump::write(file, dump::room(length, options.memory()), &mut bytes, |_| ());
            dumped.map_err(|source| Error::Io { file: path.to_path_buf(), action: "read", source })?;
            bytes
        }
    };
    let tree = tree::Tree::parse(&bytes).map_err(|failure| match failure {
        tree::Failure::Told { node, cause } if node.is_empty() => fault::unopened(&cause).of(path),
        tree::Failure::Told { node, cause } => Flaw::new(Place::Node(node), CgnsFault::Told(cause)).of(path),
        tree::Failure::Cut => {
            refused("the reading process gave no whole answer; does it call cgns::serve_reader?".into())
        }
    })?;
    make(&tree).map_err(|flaw| flaw.of(path))
}
