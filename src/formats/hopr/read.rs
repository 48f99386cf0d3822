//! A mesh from a HOPR file.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::fault::HoprFault;
use super::rows;
use crate::element::{Cell, Order, side_nodes};
use crate::formats::assembly::Assembly;
use crate::formats::cgns::{HOPR, Tree};
use crate::formats::error::Flaw;
use crate::mesh::{EntityKey, Mesh, NodeId};

/// Numbers of a row of `ElemInfo`, and of `SideInfo`.
const ELEMENT: usize = 6;
const SIDE: usize = 5;
/// Characters of a name.
const NAME: usize = 255;
/// Type of a periodic condition.
const PERIODIC: i64 = 1;

/// The mesh of a file's arrays.
///
/// # Errors
/// Arrays that are missing or do not fit one another.
pub(super) fn mesh(tree: &Tree) -> Result<Mesh, Flaw> {
    let order = tree.required(HOPR, "Ngeo")?.ints()?.get(0).unwrap_or(0);
    let order = usize::try_from(order)
        .ok()
        .and_then(|p| Order::new(p).ok())
        .ok_or_else(|| tree.flaw(HoprFault::Order(order)))?;
    let file = File { tree, order, nodes: nodes(tree)? };
    let mut assembly = Assembly::new(file.nodes.points.clone()).map_err(|fault| tree.flaw(fault))?;
    assembly.parts.order = order;
    let cells = file.cells()?;
    for (cell, zone, nodes) in &cells {
        assembly.push(*cell, EntityKey::new(3, *zone), nodes);
    }
    let periodic = file.sides(&cells, &mut assembly)?;
    if periodic > 0 {
        let note = format!(
            "{periodic} periodic sides are named after their conditions; which belong together is not taken over"
        );
        assembly.parts.notes.push(note);
    }
    assembly.finish().map_err(|fault| tree.flaw(fault))
}

/// The nodes of elements, and the points that they are.
struct Nodes {
    points: Vec<DVec3>,
    /// The point of each node of each element.
    of: Vec<NodeId>,
}

/// Joins the nodes of one number.
fn nodes(tree: &Tree) -> Result<Nodes, Flaw> {
    let (coordinates, numbers) = (tree.required(HOPR, "NodeCoords")?, tree.required(HOPR, "GlobalNodeIDs")?);
    let (x, ids) = (coordinates.reals()?, numbers.ints()?);
    let (triples, rest) = x.as_chunks::<3>();
    if !rest.is_empty() || triples.len() != ids.len() {
        return Err(coordinates.flaw(HoprFault::Nodes { found: x.len(), numbers: ids.len() }));
    }
    let mut known: FxHashMap<i64, NodeId> = FxHashMap::default();
    let mut nodes = Nodes { points: Vec::new(), of: Vec::with_capacity(triples.len()) };
    for (id, &x) in ids.iter().zip(triples) {
        let x = DVec3::from(x);
        let next = NodeId::new(nodes.points.len()).map_err(|fault| tree.flaw(fault))?;
        let node = *known.entry(id).or_insert(next);
        if node == next {
            nodes.points.push(x);
        } else if nodes.points[node.index()] != x {
            return Err(coordinates.flaw(HoprFault::Apart(id)));
        }
        nodes.of.push(node);
    }
    Ok(nodes)
}

/// A cell, its zone, its nodes in internal order.
type Placed = (Cell, i32, Vec<NodeId>);

struct File<'a> {
    tree: &'a Tree<'a>,
    order: Order,
    nodes: Nodes,
}

impl File<'_> {
    /// A table of rows.
    fn table(&self, name: &'static str, width: usize) -> Result<Vec<i64>, Flaw> {
        let node = self.tree.required(HOPR, name)?;
        let values: Vec<i64> = node.ints()?.iter().collect();
        match values.len().is_multiple_of(width) {
            true => Ok(values),
            false => Err(node.flaw(HoprFault::Rows { found: values.len(), width })),
        }
    }

    fn cells(&self) -> Result<Vec<Placed>, Flaw> {
        let place = |row: &[i64], number: usize| {
            let cell = match row[0] % 10 {
                4 => Cell::Tet,
                5 => Cell::Pyramid,
                6 => Cell::Prism,
                8 => Cell::Hex,
                _ => return Err(self.tree.flaw(HoprFault::Kind { element: number, kind: row[0] })),
            };
            let range = usize::try_from(row[4]).ok().zip(usize::try_from(row[5]).ok());
            let own = range.and_then(|(first, last)| self.nodes.of.get(first..last));
            let wanted = cell.node_count(self.order);
            let own = own.filter(|own| own.len() == wanted).ok_or_else(|| {
                self.tree.flaw(HoprFault::Range { element: number, first: row[4], last: row[5], wanted })
            })?;
            let mut nodes = vec![NodeId::default(); wanted];
            rows::of(cell, self.order).iter().zip(own).for_each(|(&slot, &node)| nodes[slot] = node);
            Ok((cell, i32::try_from(row[1]).unwrap_or(1).max(1), nodes))
        };
        let table = self.table("ElemInfo", ELEMENT)?;
        table.chunks_exact(ELEMENT).enumerate().map(|(n, row)| place(row, n + 1)).collect()
    }

    /// Names and types of the conditions.
    fn conditions(&self) -> Result<Vec<(String, i64)>, Flaw> {
        let names = self.tree.required(HOPR, "BCNames")?;
        let (text, kinds) = (names.bytes(), self.table("BCType", 4)?);
        if text.len() != NAME * (kinds.len() / 4) {
            return Err(names.flaw(HoprFault::Conditions { names: text.len() / NAME, kinds: kinds.len() / 4 }));
        }
        let name = |bytes: &[u8]| crate::formats::names::text(bytes).trim_end_matches(['\0', ' ']).to_owned();
        Ok(text.chunks_exact(NAME).map(name).zip(kinds.chunks_exact(4).map(|row| row[0])).collect())
    }

    /// Adds the sides that have a condition, of two of one number the first; how many are periodic.
    fn sides(&self, cells: &[Placed], assembly: &mut Assembly) -> Result<usize, Flaw> {
        let (sides, elements) = (self.table("SideInfo", SIDE)?, self.table("ElemInfo", ELEMENT)?);
        let conditions = self.conditions()?;
        let mut periodic = 0;
        for (n, ((cell, _, nodes), element)) in cells.iter().zip(elements.chunks_exact(ELEMENT)).enumerate() {
            let loops = super::sides::loops(*cell);
            let range = usize::try_from(element[2]).ok().zip(usize::try_from(element[3]).ok());
            let own = range.and_then(|(first, last)| sides.get(first.checked_mul(SIDE)?..last.checked_mul(SIDE)?));
            let own = own.filter(|own| own.len() == SIDE * loops.len()).ok_or_else(|| {
                self.tree.flaw(HoprFault::Sides {
                    element: n + 1,
                    first: element[2],
                    last: element[3],
                    wanted: loops.len(),
                })
            })?;
            for (corners, row) in loops.iter().zip(own.chunks_exact(SIDE)) {
                let Some(place) = row[4].checked_sub(1).filter(|&place| place >= 0) else { continue };
                let condition = usize::try_from(place).ok().and_then(|place| conditions.get(place));
                let Some((name, kind)) = condition else {
                    return Err(self.tree.flaw(HoprFault::Condition {
                        element: n + 1,
                        condition: row[4],
                        count: conditions.len(),
                    }));
                };
                if row[1] < 0 && row[2] > 0 && *kind != PERIODIC {
                    continue; // the same side as its neighbour's
                }
                periodic += usize::from(*kind == PERIODIC);
                let faces = cell.faces().iter().zip(side_nodes(*cell, self.order));
                let is_own = |face: &[u8]| face.len() == corners.len() && face.iter().all(|own| corners.contains(own));
                for (face, slots) in faces.filter(|(face, _)| is_own(face.corners)) {
                    let key = EntityKey::new(2, place as i32 + 1);
                    let side: Vec<NodeId> = slots.iter().map(|&slot| nodes[slot]).collect();
                    if assembly.parts.entities.iter().all(|entity| entity.key != key) {
                        let group = assembly.group(2, name, Some(key.tag));
                        assembly.entity(key, vec![group]);
                    }
                    assembly.push(face.cell, key, &side);
                }
            }
        }
        Ok(periodic)
    }
}
