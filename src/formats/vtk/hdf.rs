//! VTKHDF (VTK's unstructured grids on HDF5): what VTU holds, for large meshes; a viewer reads of it what it shows.

use std::io::{self, Write};
use std::marker::PhantomData;
use std::path::Path;

use hdf5_metno as hdf5;
use hdf5_metno::types::FixedAscii;
use hdf5_metno::{Group, H5Type, Hyperslab};
use ndarray::ArrayView2;

use super::written::{Array, Grid, Selection};
use crate::formats::cgns::create;
use crate::formats::field::Field;
use crate::formats::part::Unwritten;
use crate::mesh::Mesh;

/// Version of the layout: the first with unstructured grids, which all readers take.
const VERSION: [i64; 2] = [1, 0];

/// Values that are handed to the library at a time.
const PIECE: usize = 1 << 18;

/// Writes a mesh and fields on it, as `write::write` does.
pub(super) fn write(path: &Path, mesh: &Mesh, fields: &[Field], volume_only: bool) -> Result<(), Unwritten> {
    let grid = Grid::new(mesh, if volume_only { Selection::Cells } else { Selection::All });
    grid.check(fields)?;
    let file = create(path)?;
    fill(&file, &grid, fields)?;
    // Here the library tells of what it could not write; when a handle is dropped it does not.
    file.flush()?;
    Ok(file.close()?)
}

fn fill(file: &hdf5::File, grid: &Grid, fields: &[Field]) -> Result<(), Unwritten> {
    let root = file.create_group("VTKHDF")?;
    root.new_attr::<i64>().shape([2]).create("Version")?.write_raw(&VERSION)?;
    let kind = FixedAscii::<16>::from_ascii("UnstructuredGrid").map_err(|e| Unwritten::Io(io::Error::other(e)))?;
    root.new_attr::<FixedAscii<16>>().create("Type")?.write_scalar(&kind)?;
    let arrays = grid.arrays(fields);
    let count =
        |name: &str| arrays.iter().find(|own| own.section == "Cells" && own.name == name).map_or(0, |own| own.count);
    for (name, count) in [
        ("NumberOfPoints", grid.points),
        ("NumberOfCells", grid.cells),
        ("NumberOfConnectivityIds", count("connectivity")),
    ] {
        raw(&root, name, &[1], &[count as i64])?;
    }
    let [points, cells] = ["PointData", "CellData"].map(|name| root.create_group(name));
    let (points, cells) = (points?, cells?);
    for array in &arrays {
        match (array.section, array.name) {
            ("PointData", name) => dataset(&points, name, grid, array)?,
            ("CellData", name) => dataset(&cells, name, grid, array)?,
            ("Points", name) => dataset(&root, name, grid, array)?,
            (_, "connectivity") => dataset(&root, "Connectivity", grid, array)?,
            (_, "offsets") => dataset(&root, "Offsets", grid, array)?,
            (_, _) => dataset(&root, "Types", grid, array)?,
        }
    }
    let names = root.create_group("FieldData")?;
    for (name, tags) in grid.patches() {
        raw(&names, &name.replace('/', "_"), &[tags.len()], &tags.into_iter().collect::<Vec<i32>>())?;
    }
    Ok(())
}

/// Writes an array; the offsets with the 0 before the first cell.
fn dataset(group: &Group, name: &str, grid: &Grid, array: &Array) -> Result<(), Unwritten> {
    match array.kind {
        "Float64" => typed::<f64>(group, name, grid, array),
        "Int64" => typed::<i64>(group, name, grid, array),
        "Int32" => typed::<i32>(group, name, grid, array),
        _ => typed::<u8>(group, name, grid, array),
    }
}

fn typed<T: H5Type + bytemuck::Pod>(group: &Group, name: &str, grid: &Grid, array: &Array) -> Result<(), Unwritten> {
    let first = usize::from(name == "Offsets");
    let (rows, width) = (array.count / array.components + first, array.components);
    let shape = if width > 1 { vec![rows, width] } else { vec![rows] };
    let set = group.new_dataset::<T>().obj_track_times(false).shape(shape).create(name)?;
    let mut rows = Rows::<T> { set, width, done: 0, bytes: Vec::new(), kind: PhantomData };
    rows.write_all(&vec![0; first * size_of::<T>()])?;
    grid.values(&mut rows, array)?;
    Ok(rows.hand_over(0)?)
}

/// Takes the bytes of values, little-endian, and writes them to a dataset row by row.
struct Rows<T> {
    set: hdf5::Dataset,
    width: usize,
    done: usize,
    bytes: Vec<u8>,
    kind: PhantomData<T>,
}

impl<T: H5Type + bytemuck::Pod> Rows<T> {
    /// Writes whole rows where there are more than so many values.
    fn hand_over(&mut self, more_than: usize) -> io::Result<()> {
        let row = self.width * size_of::<T>();
        let rows = self.bytes.len() / row;
        if rows == 0 || rows * self.width <= more_than {
            return Ok(());
        }
        let whole = self.bytes.drain(..rows * row);
        let values: Vec<T> = whole.as_slice().chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect();
        drop(whole);
        let places = self.done..self.done + rows;
        let written = if self.width == 1 {
            self.set.write_slice(&values, places)
        } else {
            let values = ArrayView2::from_shape((rows, self.width), &values).map_err(io::Error::other)?;
            self.set.write_slice(values, Hyperslab::new(vec![places.into(), (0..self.width).into()]))
        };
        self.done += rows;
        written.map_err(|error| match Unwritten::from(error) {
            Unwritten::Io(error) => error,
            Unwritten::Inexpressible(reason) => io::Error::other(reason),
        })
    }
}

impl<T: H5Type + bytemuck::Pod> Write for Rows<T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.extend_from_slice(bytes);
        self.hand_over(PIECE)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes an array whole.
fn raw<T: H5Type>(group: &Group, name: &str, shape: &[usize], values: &[T]) -> Result<(), Unwritten> {
    let set = group.new_dataset::<T>().obj_track_times(false).shape(shape).create(name)?;
    Ok(set.write_raw(values)?)
}
