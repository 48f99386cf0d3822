//! VTU (VTK XML UnstructuredGrid): Lagrange cells, raw appended data, for pictures and for solvers that read them.
//!
//! XML version 2.2, because older ones mean another edge order in hexes.

use std::fmt::Write as _;
use std::io::Write;

use super::written::{Array, Grid, Selection};
use crate::formats::field::Field;
use crate::formats::part::Unwritten;
use crate::mesh::Mesh;

/// Writes a mesh and fields on it; with `volume_only` without the cells below the mesh's top dimension, which
/// some readers refuse in the same file.
///
/// Besides the fields the cells carry `dimension`, `CellEntityIds` (the file's entity tag), and `patch` (the first
/// physical tag of the entity, 0 where there is none). Each patch is an array of the whole
/// file that has its name and the entity tags of its boundary elements.
pub(super) fn write(out: &mut impl Write, mesh: &Mesh, fields: &[Field], volume_only: bool) -> Result<(), Unwritten> {
    let grid = Grid::new(mesh, if volume_only { Selection::Cells } else { Selection::All });
    grid.check(fields)?;
    grid_of(out, &grid, fields)
}

/// Writes what is chosen of a mesh.
pub(super) fn grid_of<'a>(
    out: &mut impl Write,
    grid: &Grid,
    fields: impl IntoIterator<Item = &'a Field>,
) -> Result<(), Unwritten> {
    let arrays = grid.arrays(fields);
    out.write_all(head(grid, &arrays).as_bytes())?;
    for array in arrays {
        out.write_all(&array.bytes().to_le_bytes())?;
        grid.values(out, &array)?;
    }
    out.write_all(b"\n  </AppendedData>\n</VTKFile>\n")?;
    Ok(())
}

/// The XML before the appended data.
fn head(grid: &Grid, arrays: &[Array]) -> String {
    let mut xml = format!(
        "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  \
             <UnstructuredGrid>\n{}    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
        patch_names(grid),
        grid.points,
        grid.cells
    );
    let mut offset = 0;
    for section in ["PointData", "CellData", "Points", "Cells"] {
        let _ = writeln!(xml, "      <{section}>");
        for array in arrays.iter().filter(|array| array.section == section) {
            let Array { name, kind, components, .. } = array;
            let name = escaped(name);
            let _ = writeln!(
                xml,
                "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
                     format=\"appended\" offset=\"{offset}\"/>"
            );
            offset += 8 + array.bytes();
        }
        let _ = writeln!(xml, "      </{section}>");
    }
    xml.push_str("    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_");
    xml
}

/// Patches by name: an array each of the entity tags of its boundary elements. There are readers that refuse arrays of text.
fn patch_names(grid: &Grid) -> String {
    let patches = grid.patches();
    if patches.is_empty() {
        return String::new();
    }
    let mut xml = "    <FieldData>\n".to_owned();
    for (name, tags) in patches {
        let (name, count) = (escaped(&name), tags.len());
        let tags = tags.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
        let _ = writeln!(
            xml,
            "      <DataArray type=\"Int32\" Name=\"{name}\" NumberOfTuples=\"{count}\" format=\"ascii\">{tags}</DataArray>"
        );
    }
    xml + "    </FieldData>\n"
}

/// Text as XML has it.
pub(super) fn escaped(name: &str) -> String {
    name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
