//! An SU2 file from a mesh.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::type_code::{self, ORDER};
use crate::element::Cell;
use crate::formats::part::Unwritten;
use crate::mesh::{Block, EntityKey, Mesh, NodeId};

/// Writes a mesh. Equal meshes make equal bytes.
///
/// Boundary elements stand in the markers of their groups. Volumes that share no points become zones, as each zone has its own.
pub(super) fn write(out: &mut impl Write, mesh: &Mesh) -> Result<(), Unwritten> {
    let axes = mesh.dimension();
    if axes == 2 && mesh.points().iter().any(|x| x.z != 0.0) {
        let reason = "a plane mesh has two coordinates in SU2, and this one is not in the plane z = 0; turn it there";
        return Err(Unwritten::Inexpressible(reason.to_owned()));
    }
    let zones = Zones::of(mesh)?;
    if zones.cells.len() > 1 {
        writeln!(out, "NZONE= {}", zones.cells.len())?;
    }
    for (n, cells) in zones.cells.iter().enumerate() {
        if zones.cells.len() > 1 {
            writeln!(out, "IZONE= {}", n + 1)?;
        }
        zone(out, mesh, &zones, n, cells)?;
    }
    Ok(())
}

/// Which points belong to which zone.
struct Zones<'a> {
    cells: Vec<Vec<&'a Block>>,
    /// Zone and number there of each node.
    nodes: Vec<(usize, usize)>,
    /// Nodes of each zone.
    of_zone: Vec<Vec<NodeId>>,
}

impl<'a> Zones<'a> {
    fn of(mesh: &'a Mesh) -> Result<Zones<'a>, Unwritten> {
        let mut by_volume: BTreeMap<EntityKey, Vec<&Block>> = BTreeMap::new();
        mesh.cell_blocks().for_each(|block| by_volume.entry(block.entity).or_default().push(block));
        let mut zone_of: Vec<Option<usize>> = vec![None; mesh.points().len()];
        let mut joined = false;
        for (zone, blocks) in by_volume.values().enumerate() {
            for node in blocks.iter().flat_map(|block| &block.nodes) {
                joined |= zone_of[node.index()].replace(zone).is_some_and(|other| other != zone);
            }
        }
        let cells =
            if joined { vec![mesh.cell_blocks().collect()] } else { by_volume.into_values().collect::<Vec<_>>() };
        let mut zones = Zones { of_zone: vec![Vec::new(); cells.len().max(1)], cells, nodes: Vec::new() };
        for (n, zone) in zone_of.into_iter().enumerate() {
            // Nodes of no cell stand in the first zone.
            let zone = zone.filter(|_| !joined).unwrap_or(0);
            let node = NodeId::new(n).map_err(|error| Unwritten::Inexpressible(error.to_string()))?;
            zones.nodes.push((zone, zones.of_zone[zone].len()));
            zones.of_zone[zone].push(node);
        }
        Ok(zones)
    }
}

/// Boundary elements of one name.
struct Marker<'a> {
    name: String,
    elements: Vec<(Cell, &'a [NodeId])>,
}

fn zone(out: &mut impl Write, mesh: &Mesh, zones: &Zones, n: usize, cells: &[&Block]) -> Result<(), Unwritten> {
    let axes = mesh.dimension();
    writeln!(out, "NDIME= {axes}\nNELEM= {}", cells.iter().map(|block| block.tags.len()).sum::<usize>())?;
    let mut number = 0;
    for block in cells {
        for nodes in block.elements(mesh.order()) {
            element(out, mesh, zones, block.cell, nodes)?;
            writeln!(out, " {number}")?;
            number += 1;
        }
    }
    writeln!(out, "NPOIN= {}", zones.of_zone[n].len())?;
    for (place, node) in zones.of_zone[n].iter().enumerate() {
        let point = mesh.points()[node.index()].to_array();
        point[..axes].iter().try_for_each(|x| write!(out, "{x:?} "))?;
        writeln!(out, "{place}")?;
    }
    let mut markers: Vec<Marker> = Vec::new();
    for block in mesh.side_blocks() {
        let name = name(mesh, block);
        for nodes in block.elements(mesh.order()) {
            if nodes.first().is_some_and(|node| zones.nodes[node.index()].0 != n) {
                continue;
            }
            let place = markers.iter().position(|own| own.name == name).unwrap_or_else(|| {
                markers.push(Marker { name: name.clone(), elements: Vec::new() });
                markers.len() - 1
            });
            markers[place].elements.push((block.cell, nodes));
        }
    }
    writeln!(out, "NMARK= {}", markers.len())?;
    for Marker { name, elements } in markers {
        writeln!(out, "MARKER_TAG= {name}\nMARKER_ELEMS= {}", elements.len())?;
        for (cell, nodes) in elements {
            element(out, mesh, zones, cell, nodes)?;
            writeln!(out)?;
        }
    }
    Ok(())
}

/// The name of the first group of a block's elements, else of its entity, as SU2 reads it: without spaces and comments.
fn name(mesh: &Mesh, block: &Block) -> String {
    let tag = block.physical_tags.first().copied().or_else(|| mesh.physical_tags_of(block.entity).first().copied());
    let is = |own: &&crate::mesh::PhysicalName| {
        own.dimension == block.entity.dimension && Some(own.tag) == tag.map(i32::saturating_abs)
    };
    let known = mesh.physical_names().iter().find(is).map(|own| own.name.clone());
    let name = known.unwrap_or_else(|| block.entity.to_string());
    name.chars().map(|c| if c.is_whitespace() || c == '%' { '_' } else { c }).collect()
}

fn element(out: &mut impl Write, mesh: &Mesh, zones: &Zones, cell: Cell, nodes: &[NodeId]) -> Result<(), Unwritten> {
    let order = mesh.order();
    let missing = || Unwritten::Inexpressible(format!("SU2 has no {cell} of {order}"));
    let slots = ORDER.slots(cell, order).ok_or_else(missing)?;
    write!(out, "{}", type_code::of(cell, order).ok_or_else(missing)?)?;
    let numbers = slots.iter().map(|&slot| zones.nodes[nodes[usize::from(slot)].index()].1);
    Ok(numbers.into_iter().try_for_each(|number| -> io::Result<()> { write!(out, " {number}") })?)
}
