//! VTM (VTK XML MultiBlockDataSet): the volume and every patch as a block of its own, each a VTU file in a folder beside that has the file's
//! name without its ending.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use super::write::{escaped, grid_of};
use super::written::{Grid, Selection};
use crate::formats::error::Error;
use crate::formats::field::Field;
use crate::formats::output;
use crate::formats::part::Unwritten;
use crate::mesh::Mesh;

/// Characters of a patch's name that its file's name has.
const NAME: usize = 60;

/// The folder of the blocks.
pub(in crate::formats) fn folder_of(path: &Path) -> PathBuf {
    path.with_extension("")
}

/// Writes the blocks of a mesh beside a file; the text that names them. A block has the fields that have a value everywhere in it.
pub(super) fn write(path: &Path, mesh: &Mesh, fields: &[Field]) -> Result<String, Unwritten> {
    let folder = folder_of(path);
    let Some(name) = folder.file_name().map(PathBuf::from) else {
        return Err(Unwritten::Inexpressible("its name has nothing before the ending".to_owned()));
    };
    fs::create_dir_all(&folder)?;
    let block = |file: &str, selection: Selection| -> Result<String, Unwritten> {
        let grid = Grid::new(mesh, selection);
        grid.check(fields)?;
        let known = fields.iter().filter(|field| grid.is_known(field));
        output::write(&folder.join(file), |part| part.stream(|out| grid_of(out, &grid, known))).map_err(unwritten)?;
        Ok(escaped(&name.join(file).to_string_lossy()))
    };
    let mut xml = "<?xml version=\"1.0\"?>\n\
                   <VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\">\n  \
                   <vtkMultiBlockDataSet>\n"
        .to_owned();
    let cells = block("cells.vtu", Selection::Cells)?;
    let _ = writeln!(xml, "    <DataSet index=\"0\" name=\"cells\" file=\"{cells}\"/>");
    let labels: BTreeSet<String> = mesh.side_blocks().map(|block| mesh.label(block.entity)).collect();
    for (label, n) in labels.iter().zip(1..) {
        let file = block(&file_name(n, label), Selection::Patch(label))?;
        let _ = writeln!(xml, "    <DataSet index=\"{n}\" name=\"{}\" file=\"{file}\"/>", escaped(label));
    }
    Ok(xml + "  </vtkMultiBlockDataSet>\n</VTKFile>\n")
}

/// A name for the file of a patch: its number, and what of its name every system takes.
fn file_name(n: usize, label: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    format!("{n}_{}.vtu", label.chars().take(NAME).map(plain).collect::<String>())
}

fn unwritten(error: Error) -> Unwritten {
    match error {
        Error::Inexpressible { reason, .. } => Unwritten::Inexpressible(reason),
        error => Unwritten::Io(std::io::Error::other(error.to_string())),
    }
}
