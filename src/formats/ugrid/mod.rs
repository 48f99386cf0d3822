//! UGRID (AFLR3), read: linear meshes in one stream of numbers, boundary faces by surface number.
//!
//! The file does not say how its numbers are written; its name does (`case.lb8.ugrid`), and where it does not, the sizes
//! tell. Names of surfaces stand in a `.mapbc` file beside it.

mod fault;
mod kind;
pub(super) mod mapbc;

use std::io::BufRead;

use glam::DVec3;

use super::assembly::{Assembly, node_of};
use super::detect::Verdict;
use super::error::{Error, Fault, Flaw};
use super::format::{Format, Holds, Input, Reader};
use super::node_order::NodeOrder;
use super::numbers::Numbers;
use super::options::ReadOptions;
use crate::element::{Cell, Order};
use crate::mesh::{EntityKey, Mesh, NodeId, Parts};
use fault::UgridFault;
use kind::{CELLS, FACES};

/// The format of AFLR3, FUN3D and others.
pub(super) static FORMAT: Format = Format {
    name: "UGRID",
    endings: &["ugrid", "ugrid64"],
    detect: |head| if FORMAT.is_name(head.path) { Verdict::ByName } else { Verdict::No },
    reader: Some(Reader {
        holds: Holds {
            highest: Order::LINEAR,
            cells: &[Cell::Triangle, Cell::Quad, Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex],
            dimensions: &[3],
            names: true,
            fields: false,
            notes: "text, `b8`, `lb8`, `b4`, `lb4`, `r8`, `lr8`, `r4`, `lr4`, 64-bit kinds (`lb8l`, `.ugrid64`); names and \
                    conditions from the `.mapbc` file beside it",
        },
        read: open,
    }),
    writer: None,
};

/// UGRID's node order, of linear elements only. A pyramid's nodes 1, 4, 5, 2 go round the base, and 3 is the apex.
static ORDER: NodeOrder = NodeOrder::new(|cell, order| match cell {
    _ if order > Order::LINEAR => None,
    Cell::Pyramid => Some(vec![0, 3, 4, 1, 2]),
    _ => Some((0..cell.corner_count() as u8).collect()),
});

fn open(input: Input, _: &ReadOptions) -> Result<Mesh, Error> {
    let Input { path, length, head, content } = input;
    let encoding = kind::encoding(path, &head, length);
    let encoding = encoding.map_err(|reason| Error::Format { file: path.to_path_buf(), reason })?;
    let mut numbers = Numbers::new(content, length, encoding);
    let mut parts = read(&mut numbers).map_err(|flaw| flaw.of(path))?;
    mapbc::apply(&mut parts, path)?;
    Mesh::new(parts).map_err(|cause| numbers.flaw(cause).of(path))
}

/// Reads a mesh from a file's content.
///
/// # Errors
/// The first [`Fault`] and its place. Memory stays within a small multiple of the file's length.
fn read(numbers: &mut Numbers<impl BufRead>) -> Result<Parts, Flaw> {
    numbers.begin_record("the counts")?;
    let mut counts = [0; 7];
    for count in &mut counts {
        *count = numbers.int("the counts of nodes, faces and cells")?;
    }
    numbers.end_record("the counts", true)?;
    numbers.begin_record("the mesh")?;
    let [points, counts @ ..] = counts;
    let points = numbers.checked(points, "nodes", 0, 3)?;
    if points == 0 {
        return Err(numbers.flaw(UgridFault::NoNodes));
    }
    let mut nodes = Vec::with_capacity(points);
    for _ in 0..points {
        let what = "a node's coordinates";
        nodes.push(DVec3::new(numbers.real(what)?, numbers.real(what)?, numbers.real(what)?));
    }
    let mut assembly = Assembly::new(nodes).map_err(|fault| numbers.flaw(fault))?;
    let [faces @ .., _, _, _, _] = counts;
    let [_, _, cells @ ..] = counts;
    let faces =
        [connectivity(numbers, points, FACES[0], faces[0])?, connectivity(numbers, points, FACES[1], faces[1])?];
    for (cell, nodes) in FACES.into_iter().zip(&faces) {
        for face in nodes.chunks_exact(cell.corner_count()) {
            let surface = surface(numbers)?;
            assembly.push(cell, EntityKey::new(2, surface), face);
        }
    }
    for (cell, count) in CELLS.into_iter().zip(cells) {
        let nodes = connectivity(numbers, points, cell, count)?;
        nodes.chunks_exact(cell.corner_count()).for_each(|nodes| assembly.push(cell, EntityKey::new(3, 1), nodes));
    }
    rest(numbers, &mut assembly, points)?;
    numbers.end_record("the mesh", false)?;
    if numbers.is_bytes() && numbers.rest() > 0 && assembly.parts.notes.is_empty() {
        assembly.parts.notes.push(BEHIND.into()); // fewer bytes than a number has, or behind the last record
    }
    let mut surfaces: Vec<EntityKey> = assembly.parts.blocks.iter().map(|block| block.entity).collect();
    surfaces.retain(|key| key.dimension == 2);
    surfaces.sort_unstable();
    surfaces.dedup();
    surfaces.into_iter().for_each(|key| assembly.entity(key, vec![key.tag]));
    Ok(assembly.complete())
}

/// Looks at what follows the cells. Some writers add what is not needed here: volume numbers, layers, spacings; that is noted.
/// Numbers of nodes are cells that no count announces.
fn rest(numbers: &mut Numbers<impl BufRead>, assembly: &mut Assembly, points: usize) -> Result<(), Flaw> {
    let mut values = Vec::new();
    let whole = numbers.whole_rest(LOOKED_AT, &mut values)?;
    if values.is_empty() {
        return Ok(());
    }
    let node = |&value: &i64| (1..=points as i64).contains(&value);
    let are_cells = |cell: Cell| {
        let rows = values.chunks_exact(cell.corner_count());
        let is_row = |row: &[i64]| (1..row.len()).all(|n| !row[..n].contains(&row[n]));
        let ends = !whole || values.len().is_multiple_of(cell.corner_count());
        ends && rows.len() > 0 && rows.into_iter().all(is_row)
    };
    if values.iter().all(node) && CELLS.into_iter().any(are_cells) {
        return Err(numbers.flaw(UgridFault::MoreCells));
    }
    assembly.parts.notes.push(BEHIND.into());
    Ok(())
}

const BEHIND: &str = "what follows the cells (volume numbers, layers, ...) is not used";

/// Numbers behind the cells that are looked at.
const LOOKED_AT: usize = 1 << 16;

/// The number of the surface that a face belongs to.
fn surface(numbers: &mut Numbers<impl BufRead>) -> Result<i32, Flaw> {
    let what = "a face's surface number";
    let value = numbers.int(what)?;
    match i32::try_from(value) {
        Ok(surface) if surface > 0 => Ok(surface),
        _ => Err(numbers.flaw(Fault::Number { what, found: value.to_string() })),
    }
}

/// The nodes of `count` elements of a kind, in internal order.
fn connectivity(
    numbers: &mut Numbers<impl BufRead>,
    points: usize,
    cell: Cell,
    count: i64,
) -> Result<Vec<NodeId>, Flaw> {
    let slots = ORDER.slots(cell, Order::LINEAR).unwrap_or_default();
    let count = numbers.checked(count, "elements", slots.len() as u64, 0)?;
    let mut nodes = vec![NodeId::default(); count * slots.len()];
    for (element, nodes) in (1..).zip(nodes.chunks_exact_mut(slots.len())) {
        for &slot in slots {
            let number = numbers.int("an element's nodes")?;
            nodes[usize::from(slot)] = node_of(points, number, 1, element).map_err(|fault| numbers.flaw(fault))?;
        }
    }
    Ok(nodes)
}
