//! The tree of a CGNS file as plain bytes: the only place where the HDF5 library parses a file.

use std::io::{self, Write};
use std::path::Path;

use hdf5_metno as hdf5;
use hdf5_metno::plist::file_access::FileCloseDegree;
use hdf5_metno::types::{FixedAscii, IntSize, TypeDescriptor, VarLenAscii};

use super::labels::{self, kind};

/// Levels of a tree that are followed; CGNS has seven down to the arrays that are read.
const DEEPEST: usize = 12;

/// Memory that reading may take for what a file holds, beside four times its length, in bytes.
const MEMORY: u64 = 1 << 30;

/// Bytes that reading a file of `length` bytes may take.
pub(super) fn room(length: u64) -> u64 {
    MEMORY.saturating_add(length.saturating_mul(4))
}

/// Opens a file for reading; without a lock, as nobody writes to it and some file systems have none.
pub(super) fn open(path: &Path) -> hdf5::Result<hdf5::File> {
    hdf5::FileBuilder::new().with_fapl(|access| access.file_locking(false)).open(path)
}

/// Creates a file, or empties the one that has the name. All of it is closed with it, and arrays are handed to the system when they are
/// written, not when a handle is dropped, where nobody would hear that it refused.
pub(super) fn create(path: &Path) -> hdf5::Result<hdf5::File> {
    hdf5::FileBuilder::new()
        .with_fapl(|access| access.file_locking(false).fclose_degree(FileCloseDegree::Strong).sieve_buf_size(0))
        .create(path)
}

/// Writes the tree of a file, or why there is none; arrays take `room` bytes at most.
///
/// # Errors
/// Those of the file within, of the room, and of the output; what was written is no answer then.
pub(super) fn write(path: &Path, room: u64, out: &mut impl Write) -> io::Result<()> {
    match open(path) {
        Ok(file) => {
            out.write_all(labels::TREE)?;
            Dump { out: &mut *out, room }.children(&file, 0)?;
            out.write_all(labels::TREE)?; // an answer without its end was cut off
        }
        Err(error) => {
            out.write_all(labels::FAILURE)?;
            out.write_all(error.to_string().as_bytes())?;
        }
    }
    out.flush()
}

fn failed(error: hdf5::Error) -> io::Error {
    io::Error::other(error.to_string())
}

/// A tree being written.
struct Dump<'a, W> {
    out: &'a mut W,
    /// Bytes that arrays may still take.
    room: u64,
}

impl<W: Write> Dump<'_, W> {
    /// Writes the children of a group that are of use, their number before them; in the order of their names, as HDF5 keeps none
    /// that all writers agree on.
    fn children(&mut self, group: &hdf5::Group, depth: usize) -> io::Result<()> {
        let mut names = group.member_names().map_err(failed)?;
        names.retain(|name| !name.starts_with(' ') && !labels::PASSED_OVER.contains(&name.as_str()));
        names.sort_unstable();
        let mut useful = Vec::new();
        for name in names.into_iter().filter(|_| depth < DEEPEST) {
            let Ok(child) = group.group(&name) else { continue };
            let Some(label) = text(&child, "label").filter(|label| labels::READ.contains(&label.as_str())) else {
                continue;
            };
            useful.push((name, label, child));
        }
        self.out.write_all(&(useful.len() as u64).to_le_bytes())?;
        for (name, label, child) in useful {
            // A link's content is that of the node it leads to, which HDF5 finds, in another file too.
            let child = if text(&child, "type").as_deref() == Some("LK") {
                child.group(" link").map_err(failed)?
            } else {
                child
            };
            self.bytes(name.as_bytes())?;
            self.bytes(label.as_bytes())?;
            self.data(&child)?;
            self.children(&child, depth + 1)?;
        }
        Ok(())
    }

    fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(&(bytes.len() as u64).to_le_bytes())?;
        self.out.write_all(bytes)
    }

    /// Writes the node's array: kind, length in bytes, values. The shape is not needed: all that is read is a list.
    fn data(&mut self, group: &hdf5::Group) -> io::Result<()> {
        let Ok(set) = group.dataset(" data") else { return self.array(kind::NONE, &[]) };
        let descriptor = set.dtype().and_then(|dtype| dtype.to_descriptor()).map_err(failed)?;
        // Numbers are handed on in 8 bytes at most.
        let needed = (set.size() as u64).saturating_mul(8);
        self.room = self.room.checked_sub(needed).ok_or_else(|| io::Error::other("its arrays are too large for it"))?;
        match descriptor {
            TypeDescriptor::Integer(IntSize::U1) | TypeDescriptor::Unsigned(IntSize::U1) => {
                let text = set.read_raw::<u8>().or_else(|_| Ok(unsigned(set.read_raw::<i8>()?))).map_err(failed)?;
                self.array(kind::TEXT, &text)
            }
            TypeDescriptor::Integer(IntSize::U4) => {
                self.array(kind::INT, bytemuck::cast_slice(&set.read_raw::<i32>().map_err(failed)?))
            }
            TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
                self.array(kind::LONG, bytemuck::cast_slice(&set.read_raw::<i64>().map_err(failed)?))
            }
            TypeDescriptor::Float(_) => {
                self.array(kind::REAL, bytemuck::cast_slice(&set.read_raw::<f64>().map_err(failed)?))
            }
            _ => self.array(kind::NONE, &[]),
        }
    }

    fn array(&mut self, kind: u8, values: &[u8]) -> io::Result<()> {
        self.out.write_all(&[kind])?;
        self.bytes(values)
    }
}

/// A text attribute: of 33 bytes as the standard has it, or as others write it.
fn text(group: &hdf5::Group, name: &str) -> Option<String> {
    let attribute = group.attr(name).ok()?;
    let fixed = || Some(attribute.read_scalar::<FixedAscii<64>>().ok()?.as_str().to_owned());
    let variable = || Some(attribute.read_scalar::<VarLenAscii>().ok()?.as_str().to_owned());
    let text = fixed().or_else(variable)?;
    Some(text.trim_end_matches(['\0', ' ']).to_owned())
}

fn unsigned(text: Vec<i8>) -> Vec<u8> {
    text.into_iter().map(i8::cast_unsigned).collect()
}
