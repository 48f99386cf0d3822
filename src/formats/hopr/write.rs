//! A HOPR file from a mesh.

use std::path::Path;

use hdf5_metno as hdf5;
use hdf5_metno::H5Type;
use hdf5_metno::types::FixedAscii;

use super::rows;
use super::sides::{self, Sides};
use crate::element::{Cell, Order};
use crate::formats::cgns::create;
use crate::formats::part::Unwritten;
use crate::mesh::Mesh;

/// The version of HOPR whose files these are like: readers ask for one.
const VERSION: (&str, i32) = ("1.5.0", 10500);

/// Characters of a name of a boundary condition.
const NAME: usize = 255;

/// Kinds of elements in the order in which they are counted.
const KINDS: [i32; 11] = [104, 204, 105, 115, 205, 106, 116, 206, 108, 118, 208];

/// Writes a mesh. Equal meshes make equal bytes.
pub(super) fn write(path: &Path, mesh: &Mesh) -> Result<(), Unwritten> {
    let sides = sides::of(mesh).map_err(Unwritten::Inexpressible)?;
    let nodes: usize = mesh.cell_blocks().map(|block| block.nodes.len()).sum();
    if i32::try_from(nodes).is_err() {
        let reason = format!("{nodes} nodes of elements are more than the {} that the format counts", i32::MAX);
        return Err(Unwritten::Inexpressible(reason));
    }
    let file = create(path)?;
    elements(&file, mesh)?;
    side_info(&file, mesh.order(), &sides)?;
    let unique = nodes_of(&file, mesh, nodes)?;
    let last = sides.all.iter().map(|side| side.number).max().unwrap_or(0);
    let root = file.group("/")?;
    for (name, value) in [
        ("Ngeo", mesh.order().get()),
        ("nElems", mesh.cells().len()),
        ("nSides", sides.all.len()),
        ("nNodes", nodes),
        ("nUniqueNodes", unique),
        ("nUniqueSides", usize::try_from(last).unwrap_or(0)),
        ("nBCs", sides.conditions.len()),
        ("HoprVersionInt", VERSION.1 as usize),
    ] {
        root.new_attr::<i32>().shape([1]).create(name)?.write_raw(&[value as i32])?;
    }
    root.new_attr::<f64>().shape([1]).create("Version")?.write_raw(&[1.0])?;
    let version =
        FixedAscii::<5>::from_ascii(VERSION.0).map_err(|error| Unwritten::Inexpressible(error.to_string()))?;
    root.new_attr::<FixedAscii<5>>().create("HoprVersion")?.write_scalar(&version)?;
    // Here the library tells of what it could not write; when a handle is dropped it does not.
    file.flush()?;
    file.close()?;
    Ok(())
}

fn raw<T: H5Type>(file: &hdf5::File, name: &str, shape: &[usize], values: &[T]) -> Result<(), Unwritten> {
    let set = file.new_dataset::<T>().obj_track_times(false).shape(shape).create(name)?;
    Ok(set.write_raw(values)?)
}

/// A text of the length that names have, with blanks behind.
fn padded(text: &str) -> Result<FixedAscii<NAME>, Unwritten> {
    let plain: String =
        text.chars().map(|c| if c.is_ascii_graphic() || c == ' ' { c } else { '_' }).take(NAME).collect();
    let told = |_| Unwritten::Inexpressible(format!("the name {text:?} cannot be written as ASCII"));
    FixedAscii::from_ascii(&format!("{plain:NAME$}")).map_err(told)
}

/// HOPR's number of an element: its corners, and whether its map is linear, of straight edges, or curved.
fn kind(cell: Cell, order: Order) -> i32 {
    let corners = cell.corner_count() as i32;
    match order {
        Order::LINEAR if cell == Cell::Tet => 100 + corners,
        Order::LINEAR => 110 + corners,
        _ => 200 + corners,
    }
}

/// `ElemInfo`: kind, zone, ranges of sides and nodes; `ElemCounter`.
fn elements(file: &hdf5::File, mesh: &Mesh) -> Result<(), Unwritten> {
    let mut rows: Vec<i32> = Vec::new();
    let mut counts = KINDS.map(|kind| [kind, 0]);
    let (mut sides, mut nodes) = (0, 0);
    for cell in mesh.cells().iter() {
        let kind = kind(cell.cell, mesh.order());
        counts.iter_mut().filter(|own| own[0] == kind).for_each(|own| own[1] += 1);
        let (first_side, first_node) = (sides, nodes);
        sides += cell.cell.faces().len() as i32;
        nodes += cell.nodes.len() as i32;
        rows.extend([kind, cell.entity.tag.max(1), first_side, sides, first_node, nodes]);
    }
    raw(file, "ElemInfo", &[rows.len() / 6, 6], &rows)?;
    raw(file, "ElemCounter", &[KINDS.len(), 2], counts.as_flattened())
}

/// `SideInfo`: kind, number, neighbour and its side, condition; `BCNames`, `BCType`.
fn side_info(file: &hdf5::File, order: Order, sides: &Sides) -> Result<(), Unwritten> {
    let mut rows: Vec<i32> = Vec::with_capacity(sides.all.len() * 5);
    for side in &sides.all {
        let kind = match (side.corners as i32, order) {
            (3, Order::LINEAR) => 3,
            (corners, Order::LINEAR) => 10 + corners,
            (corners, _) => 20 + corners,
        };
        let [element, place, flip] = side.neighbour.unwrap_or([0; 3]);
        rows.extend([
            kind,
            side.number,
            element,
            10 * place + flip,
            side.condition.map_or(0, |place| place as i32 + 1),
        ]);
    }
    raw(file, "SideInfo", &[sides.all.len(), 5], &rows)?;
    let names = sides.conditions.iter().map(|own| padded(&own.name)).collect::<Result<Vec<_>, _>>()?;
    raw(file, "BCNames", &[names.len()], &names)?;
    let kinds: Vec<i32> = sides.conditions.iter().flat_map(|own| own.kind).collect();
    raw(file, "BCType", &[names.len(), 4], &kinds)
}

/// `NodeCoords` and `GlobalNodeIDs`; how many different nodes there are. They are numbered in their order, from 1, without gaps.
fn nodes_of(file: &hdf5::File, mesh: &Mesh, count: usize) -> Result<usize, Unwritten> {
    let mut used = vec![0i32; mesh.points().len()];
    mesh.cell_blocks().flat_map(|block| &block.nodes).for_each(|node| used[node.index()] = 1);
    let mut last = 0;
    for number in &mut used {
        last += *number;
        *number *= last;
    }
    let (mut points, mut numbers) = (Vec::with_capacity(3 * count), Vec::with_capacity(count));
    for cell in mesh.cells().iter() {
        for &slot in rows::of(cell.cell, mesh.order()) {
            let node = cell.nodes[slot].index();
            points.extend(mesh.points()[node].to_array());
            numbers.push(used[node]);
        }
    }
    raw(file, "NodeCoords", &[count, 3], &points)?;
    raw(file, "GlobalNodeIDs", &[count], &numbers)?;
    Ok(last as usize)
}
