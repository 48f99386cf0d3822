//! A CGNS file of one unstructured zone: a section for each type of element, a condition for each boundary entity, a family for
//! each physical group.
//!
//! Sections hold their elements in the mesh's order and follow one another by their first element's number, so that a mesh
//! that came from such a file keeps its numbers. Numbers of entities and groups, for which CGNS has no place of their own, stand
//! in `Ordinal_t` nodes. Elements below the boundary (lines and points in a volume mesh) are left out.

use std::collections::{BTreeMap, HashSet};
use std::path::Path;

use hdf5_metno as hdf5;

use super::dump;
use super::labels;
use super::node::{Data, LONGEST_NAME, Node};
use super::type_code;
use crate::element::Cell;
use crate::formats::part::Unwritten;
use crate::mesh::{Block, EntityKey, Mesh, PhysicalName};

/// Version of the standard that the files keep to.
const VERSION: f32 = 3.4;

/// Writes a mesh. Equal meshes make equal bytes.
pub(super) fn write(path: &Path, mesh: &Mesh) -> Result<(), Unwritten> {
    let file = dump::create(path)?;
    fill(&file, mesh)?;
    // Here the library tells of what it could not write; when a handle is dropped it does not.
    file.flush()?;
    file.close()?;
    // What the library has written, it must be able to open; only then is it worth a name.
    dump::open(path)?.group("Base")?;
    Ok(())
}

fn fill(file: &hdf5::File, mesh: &Mesh) -> Result<(), Unwritten> {
    let root = Node::root(file)?;
    root.array("CGNSLibraryVersion", labels::VERSION, &[1], &[VERSION])?;
    let layout = Layout::new(mesh);
    let base = root.array("Base", labels::BASE, &[2], &[layout.top as i32, 3])?;
    for family in layout.families.values() {
        family.write(&base, mesh)?;
    }
    // Indices are 4 bytes long where they suffice, which is what older libraries take.
    if layout.largest < i32::MAX as usize { layout.zone::<i32>(&base) } else { layout.zone::<i64>(&base) }
}

/// An index of a CGNS file.
trait Index: Data + Copy {
    fn of(value: usize) -> Self;
}

impl Index for i32 {
    fn of(value: usize) -> i32 {
        value as i32 // a larger one makes the file one of 8-byte indices
    }
}

impl Index for i64 {
    fn of(value: usize) -> i64 {
        value as i64
    }
}

/// A physical group and the name of its family.
struct Family<'a> {
    node: String,
    group: &'a PhysicalName,
}

/// Elements of one type, in the mesh's order.
struct Section<'a> {
    cell: Cell,
    blocks: Vec<&'a Block>,
    /// Number of its first element.
    first: usize,
    count: usize,
}

/// What stands where in the file.
struct Layout<'a> {
    mesh: &'a Mesh,
    top: usize,
    families: BTreeMap<(u8, i32), Family<'a>>,
    sections: Vec<Section<'a>>,
    /// The largest number or length that the file holds.
    largest: usize,
}

impl<'a> Layout<'a> {
    fn new(mesh: &'a Mesh) -> Layout<'a> {
        let top = mesh.blocks().iter().map(|block| block.cell.dimension()).max().unwrap_or(3).max(2);
        let mut sections: Vec<Section> = Vec::new();
        for block in mesh.blocks().iter().filter(|block| block.cell.dimension() + 1 >= top && !block.tags.is_empty()) {
            let known = sections.iter_mut().find(|section| section.cell == block.cell);
            match known {
                Some(section) => section.blocks.push(block),
                None => sections.push(Section { cell: block.cell, blocks: vec![block], first: 0, count: 0 }),
            }
        }
        sections.sort_by_key(|section| section.blocks.iter().flat_map(|block| &block.tags).min().copied());
        let mut next = 1;
        for section in &mut sections {
            section.first = next;
            section.count = section.blocks.iter().map(|block| block.tags.len()).sum();
            next += section.count;
        }
        let longest = sections.iter().map(|section| section.count * section.cell.node_count(mesh.order())).max();
        let largest = longest.unwrap_or(0).max(mesh.points().len()).max(next);
        Layout { mesh, top, families: families(mesh, top), sections, largest }
    }

    fn zone<I: Index>(&self, base: &Node) -> Result<(), Unwritten> {
        let (mesh, top) = (self.mesh, self.top);
        let cells = self.sections.iter().filter(|section| section.cell.dimension() == top).map(|s| s.count).sum();
        let sizes = [mesh.points().len(), cells, 0].map(I::of);
        let zone = base.array("Zone", labels::ZONE, &[3, 1], &sizes)?;
        zone.text("ZoneType", labels::ZONE_TYPE, "Unstructured")?;
        let coordinates = zone.child("GridCoordinates", labels::COORDINATES)?;
        for (axis, name) in ["CoordinateX", "CoordinateY", "CoordinateZ"].into_iter().enumerate() {
            let fill = |places: std::ops::Range<usize>| mesh.points()[places].iter().map(|x| x[axis]).collect();
            coordinates.list::<f64>(name, labels::ARRAY, mesh.points().len(), fill)?;
        }
        for section in &self.sections {
            self.section::<I>(&zone, section)?;
        }
        self.conditions::<I>(&zone)?;
        let volumes = self.entities(top);
        if let [volume] = volumes[..] {
            self.membership(&zone, volume)?;
        }
        Ok(())
    }

    fn section<I: Index>(&self, zone: &Node, section: &Section) -> Result<(), Unwritten> {
        let order = self.mesh.order();
        let code = type_code::of(section.cell, order);
        let name = type_code::name(section.cell, order);
        let node = zone.array(&name, labels::ELEMENTS, &[2], &[code, 0])?;
        let range = [section.first, section.first + section.count - 1].map(I::of);
        node.array("ElementRange", labels::RANGE, &[2], &range)?;
        // CGNS' node order is the mesh's own.
        let mut nodes = section.blocks.iter().flat_map(|block| &block.nodes);
        let fill = |places: std::ops::Range<usize>| {
            nodes.by_ref().take(places.len()).map(|node| I::of(node.index() + 1)).collect()
        };
        let count = section.count * section.cell.node_count(order);
        node.list::<I>("ElementConnectivity", labels::ARRAY, count, fill)?;
        Ok(())
    }

    /// Entities of a dimension that have elements, each once, by tag.
    fn entities(&self, dimension: usize) -> Vec<EntityKey> {
        let mut keys: Vec<EntityKey> =
            self.sections.iter().flat_map(|section| &section.blocks).map(|block| block.entity).collect();
        keys.retain(|key| usize::from(key.dimension) == dimension);
        keys.sort_unstable();
        keys.dedup();
        keys
    }

    /// A condition for each boundary entity; and, as Gmsh has it, for each volume where there are several.
    fn conditions<I: Index>(&self, zone: &Node) -> Result<(), Unwritten> {
        let volumes = self.entities(self.top);
        let volumes = if volumes.len() > 1 { volumes } else { Vec::new() };
        let boundary = self.entities(self.top - 1);
        if boundary.is_empty() && volumes.is_empty() {
            return Ok(());
        }
        let parent = zone.child("ZoneBC", labels::ZONE_BC)?;
        let mut names = HashSet::new();
        for key in boundary.into_iter().chain(volumes) {
            let given = self.mesh.conditions().iter().find(|condition| condition.entity == key);
            let groups = self.groups(key);
            let bare =
                format!("{}_{}", ["point", "curve", "surface", "volume"][usize::from(key.dimension.min(3))], key.tag);
            let own = match (given, &groups[..]) {
                (Some(condition), _) => condition.name.clone(),
                // A group of one entity lends it its name.
                (None, [family, ..]) if self.alone(family) => family.node.clone(),
                (None, _) => bare,
            };
            let name = unique(&mut names, &own);
            let kind = given.map_or("FamilySpecified", |condition| condition.kind.as_str());
            let kind = if groups.is_empty() && kind == "FamilySpecified" { "BCTypeNull" } else { kind };
            let kind = if groups.is_empty() { kind } else { "FamilySpecified" };
            let node = parent.text(&name, labels::BC, kind)?;
            self.members::<I>(&node, key)?;
            let location = match (usize::from(key.dimension) == self.top, self.top) {
                (true, _) => "CellCenter",
                (false, 3) => "FaceCenter",
                (false, _) => "EdgeCenter",
            };
            node.text("GridLocation", labels::LOCATION, location)?;
            self.membership(&node, key)?;
        }
        Ok(())
    }

    /// The element numbers of an entity: as a range where they follow one another.
    fn members<I: Index>(&self, node: &Node, key: EntityKey) -> Result<(), Unwritten> {
        let mut runs: Vec<[usize; 2]> = Vec::new();
        for section in &self.sections {
            let mut next = section.first;
            for block in &section.blocks {
                let run = [next, next + block.tags.len() - 1];
                next += block.tags.len();
                match runs.last_mut() {
                    _ if block.entity != key => {}
                    Some(last) if last[1] + 1 == run[0] => last[1] = run[1],
                    _ => runs.push(run),
                }
            }
        }
        if let [run] = runs[..] {
            node.array("PointRange", labels::RANGE, &[2, 1], &run.map(I::of))?;
        } else {
            let list: Vec<I> = runs.into_iter().flat_map(|[a, b]| a..=b).map(I::of).collect();
            node.array("PointList", labels::LIST, &[list.len(), 1], &list)?;
        }
        Ok(())
    }

    /// Writes which families an entity belongs to, and its number.
    fn membership(&self, node: &Node, key: EntityKey) -> Result<(), Unwritten> {
        for (n, family) in self.groups(key).into_iter().enumerate() {
            if n == 0 {
                node.text("FamilyName", labels::FAMILY_NAME, &family.node)?;
            } else {
                node.text(&format!("FamilyName{}", n + 1), labels::MORE_FAMILIES, &family.node)?;
            }
        }
        if key.tag > 0 {
            node.array("Ordinal", labels::ORDINAL, &[1], &[key.tag])?;
        }
        Ok(())
    }

    /// The families of an entity's groups.
    fn groups(&self, key: EntityKey) -> Vec<&Family<'a>> {
        let tags = self.mesh.physical_tags_of(key);
        tags.iter().filter_map(|tag| self.families.get(&(key.dimension, tag.abs()))).collect()
    }

    /// Whether one entity alone belongs to the family's group.
    fn alone(&self, family: &Family) -> bool {
        let key = (family.group.dimension, family.group.tag);
        let mut entities: HashSet<EntityKey> = HashSet::new();
        let members = self.sections.iter().flat_map(|section| &section.blocks).map(|block| block.entity);
        entities.extend(members.filter(|entity| {
            entity.dimension == key.0 && self.mesh.physical_tags_of(*entity).iter().any(|tag| tag.abs() == key.1)
        }));
        entities.len() == 1
    }
}

impl Family<'_> {
    fn write(&self, base: &Node, mesh: &Mesh) -> Result<(), Unwritten> {
        let node = base.child(&self.node, labels::FAMILY)?;
        // The name in full; it is here that Gmsh looks for it.
        node.text(&self.node, labels::FAMILY_NAME, &self.group.name)?;
        node.array("Ordinal", labels::ORDINAL, &[1], &[self.group.tag])?;
        // A family has a kind of condition where its entities agree on one.
        let belongs = |key: EntityKey| {
            key.dimension == self.group.dimension
                && mesh.physical_tags_of(key).iter().any(|tag| tag.abs() == self.group.tag)
        };
        let mut kinds = mesh.conditions().iter().filter(|condition| belongs(condition.entity)).map(|c| c.kind.as_str());
        if let Some(kind) = kinds.next().filter(|&kind| kind != "FamilySpecified" && kinds.all(|other| other == kind)) {
            node.text("FamilyBC", labels::FAMILY_BC, kind)?;
        }
        Ok(())
    }
}

/// A family for each group of the boundary and of the cells.
fn families(mesh: &Mesh, top: usize) -> BTreeMap<(u8, i32), Family<'_>> {
    let mut names = HashSet::new();
    let groups = mesh.physical_names().iter().filter(|group| usize::from(group.dimension) + 1 >= top);
    groups
        .map(|group| ((group.dimension, group.tag), Family { node: unique(&mut names, &group.name), group }))
        .collect()
}

/// A name that a CGNS node may have and no other has: 32 characters of ASCII without a slash.
fn unique(names: &mut HashSet<String>, wish: &str) -> String {
    let plain = |c: char| if (c.is_ascii_graphic() || c == ' ') && c != '/' { c } else { '_' };
    let text: String = wish.chars().map(plain).take(LONGEST_NAME).collect();
    let text = if text.trim().is_empty() || text == "." || text == ".." { "unnamed".to_owned() } else { text };
    let mut name = text.clone();
    let mut number = 2;
    while !names.insert(name.clone()) {
        let suffix = format!("_{number}");
        name = text.chars().take(LONGEST_NAME - suffix.len()).collect::<String>() + &suffix;
        number += 1;
    }
    name
}
