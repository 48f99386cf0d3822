//! The reading child: the only process in which the HDF5 library parses a file.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;

use hdf5_metno as hdf5;
use hdf5_metno::types::{FixedAscii, TypeDescriptor, VarLenAscii};

use super::labels::{self, kind};

/// First argument with which a program must call [`serve_reader`]; the second is the file.
pub const READER_SUBCOMMAND: &str = "__read-cgns";

/// Levels of a tree that are followed; CGNS has seven down to the arrays that are read.
const DEEPEST: usize = 12;

/// Body of the hidden subcommand: reads the tree and writes it to standard output.
#[must_use]
pub fn serve_reader(path: &Path) -> ExitCode {
    cad::child::limit_memory();
    let Some(out) = cad::child::take_stdout() else { return ExitCode::FAILURE };
    match answer(path, out) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

fn answer(path: &Path, out: File) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 20, out);
    match hdf5::File::open(path) {
        Ok(file) => {
            out.write_all(labels::TREE)?;
            children(&mut out, &file, 0)?;
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

/// Writes the children of a group that are of use, their number before them; in the order of their names, as HDF5 keeps none
/// that all writers agree on.
fn children(out: &mut impl Write, group: &hdf5::Group, depth: usize) -> io::Result<()> {
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
    out.write_all(&(useful.len() as u64).to_le_bytes())?;
    for (name, label, child) in useful {
        // A link's content is that of the node it leads to, which HDF5 finds, in another file too.
        let child =
            if text(&child, "type").as_deref() == Some("LK") { child.group(" link").map_err(failed)? } else { child };
        string(out, &name)?;
        string(out, &label)?;
        data(out, &child)?;
        children(out, &child, depth + 1)?;
    }
    Ok(())
}

/// A text attribute: of 33 bytes as the standard has it, or as others write it.
fn text(group: &hdf5::Group, name: &str) -> Option<String> {
    let attribute = group.attr(name).ok()?;
    let fixed = || Some(attribute.read_scalar::<FixedAscii<64>>().ok()?.as_str().to_owned());
    let variable = || Some(attribute.read_scalar::<VarLenAscii>().ok()?.as_str().to_owned());
    let text = fixed().or_else(variable)?;
    Some(text.trim_end_matches(['\0', ' ']).to_owned())
}

fn string(out: &mut impl Write, text: &str) -> io::Result<()> {
    bytes(out, text.as_bytes())
}

fn bytes(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    out.write_all(&(bytes.len() as u64).to_le_bytes())?;
    out.write_all(bytes)
}

/// Writes the node's array: kind, length in bytes, values. The shape is not needed: all that is read is a list.
fn data(out: &mut impl Write, group: &hdf5::Group) -> io::Result<()> {
    let Ok(set) = group.dataset(" data") else {
        out.write_all(&[kind::NONE])?;
        return bytes(out, &[]);
    };
    let descriptor = set.dtype().and_then(|dtype| dtype.to_descriptor()).map_err(failed)?;
    match descriptor {
        TypeDescriptor::Integer(hdf5::types::IntSize::U1) | TypeDescriptor::Unsigned(hdf5::types::IntSize::U1) => {
            out.write_all(&[kind::TEXT])?;
            bytes(out, &set.read_raw::<u8>().or_else(|_| Ok(unsigned(set.read_raw::<i8>()?))).map_err(failed)?)
        }
        TypeDescriptor::Integer(hdf5::types::IntSize::U4) => {
            out.write_all(&[kind::INT])?;
            bytes(out, bytemuck::cast_slice(&set.read_raw::<i32>().map_err(failed)?))
        }
        TypeDescriptor::Integer(_) | TypeDescriptor::Unsigned(_) => {
            out.write_all(&[kind::LONG])?;
            bytes(out, bytemuck::cast_slice(&set.read_raw::<i64>().map_err(failed)?))
        }
        TypeDescriptor::Float(_) => {
            out.write_all(&[kind::REAL])?;
            bytes(out, bytemuck::cast_slice(&set.read_raw::<f64>().map_err(failed)?))
        }
        _ => {
            out.write_all(&[kind::NONE])?;
            bytes(out, &[])
        }
    }
}

fn unsigned(text: Vec<i8>) -> Vec<u8> {
    text.into_iter().map(i8::cast_unsigned).collect()
}
