//! A mesh from the tree of a CGNS file.

use glam::DVec3;

use super::conditions::{Conditions, Families};
use super::connections::{self, Joined};
use super::fault::CgnsFault;
use super::labels;
use super::sections::sections;
use super::structured::Grid;
use super::tree::Tree;
use super::zone::Zone;
use crate::formats::assembly::{Assembly, node_of};
use crate::formats::error::Flaw;
use crate::mesh::{Mesh, NodeId};

/// The mesh of the first base whose cells have the highest dimension; others are of surfaces, or empty.
pub(super) fn mesh(tree: &Tree) -> Result<Mesh, Flaw> {
    let cells = |base: &Tree| base.ints().ok().and_then(|ints| ints.get(0)).unwrap_or(0);
    let rank = |base: &&Tree| (base.child(labels::ZONE).is_some(), cells(base));
    let bases = tree.all(labels::BASE).rev();
    let base = bases.max_by_key(rank).ok_or_else(|| tree.flaw(CgnsFault::NoBase))?;
    let dimensions = base.ints()?;
    let dimension = match dimensions.get(0) {
        Some(2) => 2,
        Some(3) => 3,
        other => return Err(base.flaw(CgnsFault::Dimension(other.unwrap_or(0)))),
    };
    let plane = dimensions.get(1) == Some(2);
    let mut zones = Vec::new();
    let mut start = 0;
    for node in base.all(labels::ZONE) {
        let zone = zone(node, start, plane, dimension.into())?;
        start += zone.points.len();
        zones.push(zone);
    }
    if zones.is_empty() {
        return Err(base.flaw(CgnsFault::NoZone));
    }
    let mut joined = connections::join(&zones)?;
    let (points, nodes) = merged(&zones, &mut joined);
    let mut assembly = Assembly::new(points).map_err(|fault| base.flaw(fault))?;
    assembly.parts.notes.append(&mut joined.notes);
    let bases = tree.all(labels::BASE).count();
    if bases > 1 {
        assembly.parts.notes.push(format!("the file has {bases} bases; {} is read", base.path));
    }
    let mut conditions = Conditions::new(Families::new(base), dimension);
    let mut tags = 0;
    for zone in &zones {
        let nodes = &nodes[zone.start..zone.start + zone.points.len()];
        if let Some(grid) = &zone.grid {
            tags += structured(&mut assembly, zone, grid, nodes, &mut conditions)?;
            continue;
        }
        let labels = conditions.of_zone(zone, nodes)?;
        elements(&mut assembly, zone, nodes, &labels, &mut conditions, tags)?;
        tags += zone.sections.last().map_or(0, |section| section.first + section.count as u64 - 1);
    }
    conditions.finish(&mut assembly);
    if zones.len() > 1 {
        for zone in &zones {
            let nodes = nodes[zone.start..zone.start + zone.points.len()].to_vec();
            assembly.parts.zones.push(crate::mesh::Zone { name: zone.tree.path.clone(), nodes });
        }
    }
    assembly.finish().map_err(|fault| base.flaw(fault))
}

/// A zone, whose nodes begin at `start`; in a plane they have no third coordinate.
fn zone<'a>(tree: &'a Tree<'a>, start: usize, plane: bool, dimension: usize) -> Result<Zone<'a>, Flaw> {
    let kind = tree.child(labels::ZONE_TYPE).map(Tree::text).unwrap_or_default();
    let grid = match kind.as_str() {
        "Unstructured" => None,
        "Structured" => Some(Grid::new(tree, dimension)?),
        _ => return Err(tree.flaw(CgnsFault::ZoneType(kind))),
    };
    let count = match &grid {
        Some(grid) => grid.points(),
        None => tree.ints()?.get(0).and_then(|n| usize::try_from(n).ok()).unwrap_or(0),
    };
    let coordinates = tree.required(labels::COORDINATES, "GridCoordinates")?;
    let mut points = Vec::new();
    for (axis, name) in ["CoordinateX", "CoordinateY", "CoordinateZ"].into_iter().enumerate() {
        let array = match coordinates.named(labels::ARRAY, name) {
            None if axis == 2 && plane => break,
            None => {
                let found: Vec<&str> = coordinates.all(labels::ARRAY).map(|array| array.name).collect();
                return Err(coordinates.flaw(CgnsFault::Coordinates { name, found: found.join(", ") }));
            }
            Some(array) => array,
        };
        let values = array.reals()?;
        if values.len() != count {
            let fault = CgnsFault::Length { what: "the coordinate", found: values.len(), needed: count as u64 };
            return Err(array.flaw(fault));
        }
        points.resize(count, DVec3::ZERO);
        points.iter_mut().zip(values.iter()).for_each(|(point, &x)| point[axis] = x);
    }
    let (cells, sections) = match &grid {
        Some(_) => (None, Vec::new()),
        None => (tree.ints()?.get(1).and_then(|n| u64::try_from(n).ok()), sections(tree)?),
    };
    Ok(Zone { tree, start, points, cells, sections, grid })
}

/// The points of all zones, each once; and the node of every point of every zone.
fn merged(zones: &[Zone], joined: &mut Joined) -> (Vec<DVec3>, Vec<NodeId>) {
    let mut points: Vec<DVec3> = Vec::new();
    let mut nodes: Vec<NodeId> = Vec::new();
    for zone in zones {
        for (n, &point) in zone.points.iter().enumerate() {
            let (place, root) = (zone.start + n, joined.root(zone.start + n));
            if root == place {
                // Beyond 32 bits the assembly of so many points fails.
                nodes.push(NodeId::new(points.len()).unwrap_or_default());
                points.push(point);
            } else {
                nodes.push(nodes[root]);
            }
        }
    }
    (points, nodes)
}

/// Adds the cells of a structured zone, and the faces that its conditions cover; how many they are.
fn structured(
    assembly: &mut Assembly,
    zone: &Zone,
    grid: &Grid,
    nodes: &[NodeId],
    conditions: &mut Conditions,
) -> Result<u64, Flaw> {
    let entity = conditions.entity_of_cells(zone);
    let placed = |corners: &[usize]| corners.iter().map(|&corner| nodes[corner]).collect::<Vec<NodeId>>();
    let mut count = 0;
    for corners in grid.cells() {
        assembly.push(grid.cell(), entity, &placed(&corners));
        count += 1;
    }
    for (entity, faces) in conditions.of_grid(zone, grid)? {
        faces.iter().for_each(|corners| assembly.push(grid.side(), entity, &placed(corners)));
        count += faces.len() as u64;
    }
    Ok(count)
}

/// Adds a zone's elements, numbered as in the file, behind those of the zones before.
fn elements(
    assembly: &mut Assembly,
    zone: &Zone,
    nodes: &[NodeId],
    labels: &[u32],
    conditions: &mut Conditions,
    tags: u64,
) -> Result<(), Flaw> {
    let mut own = Vec::new();
    let mut cells = 0;
    for section in &zone.sections {
        // Neighbours in a section mostly share their patch.
        let mut last = None;
        section.each(|n, element| {
            let tag = section.first + n as u64;
            cells += usize::from(element.cell.dimension() == conditions.dimension());
            assembly.set_order(element.cell, element.order).map_err(|fault| section.flaw(fault))?;
            own.clear();
            for number in element.nodes() {
                let node = node_of(nodes.len(), number, 1, tag).map_err(|fault| section.flaw(fault))?;
                own.push(nodes[node.index()]);
            }
            let place = (labels[section.before + n], element.cell);
            let entity = match last {
                Some((known, entity)) if known == place => entity,
                _ => conditions.entity(zone, section, place.0, place.1),
            };
            last = Some((place, entity));
            assembly.push_tagged(element.cell, entity, tags + tag, &own);
            Ok(())
        })?;
    }
    match zone.cells {
        Some(needed) if needed != cells as u64 => Err(zone.tree.flaw(CgnsFault::Cells { found: cells, needed })),
        _ => Ok(()),
    }
}
