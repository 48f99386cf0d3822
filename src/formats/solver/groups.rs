//! The mesh that a solver is given: its cells, and the boundary in groups that each have a name and a number of their own.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashSet};

use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::intake::Groups;
use crate::element::{Cell, side_nodes};
use crate::formats::assembly::VOLUME_NAME;
use crate::mesh::{Block, EntityKey, FaceKey, Mesh, Parts, Periodic, PhysicalName};

/// The mesh without the elements below its cells that belong to no physical group, and how many they were.
pub(in crate::formats) fn physical_only(mesh: &Mesh) -> (Cow<'_, Mesh>, Option<String>) {
    let is_left_out = |block: &&Block| block.cell.dimension() < mesh.dimension() && tags(mesh, block).is_empty();
    let left_out: usize = mesh.blocks().iter().filter(is_left_out).map(|block| block.tags.len()).sum();
    if left_out == 0 {
        return (Cow::Borrowed(mesh), None);
    }
    let kept = mesh.blocks().iter().filter(|block| !is_left_out(block)).cloned().collect();
    let parts = Parts { blocks: kept, ..mesh.clone().into_parts() };
    let note = format!("{left_out} elements below the cells belong to no physical group and are left out");
    // Fewer blocks of a mesh that fits together fit together.
    (Mesh::new(parts).map_or(Cow::Borrowed(mesh), Cow::Owned), Some(note))
}

/// Numbers of the physical groups of a block's elements, each once, without the sign of their orientation.
fn tags(mesh: &Mesh, block: &Block) -> Vec<i32> {
    let own =
        if block.physical_tags.is_empty() { mesh.physical_tags_of(block.entity) } else { block.physical_tags.clone() };
    own.iter().map(|tag| tag.saturating_abs()).filter(|&tag| tag != 0).collect::<BTreeSet<i32>>().into_iter().collect()
}

/// A mesh ready for a solver, and what was changed.
///
/// Cells and points keep their order. Elements below the sides are left out; each side of the skin has an element, and each
/// element a group with a name. Entities are the groups.
///
/// # Errors
/// What the solver would take for something else, and the remedy.
pub(in crate::formats) fn prepare(mesh: &Mesh, wants: &Groups) -> Result<(Mesh, Vec<String>), String> {
    let mut draft = Draft { mesh, wants, notes: Vec::new(), blocks: Vec::new() };
    draft.cells();
    draft.sides();
    draft.skin();
    if wants.one_each {
        draft.refuse_several()?;
    }
    draft.finish()
}

/// A block and the names of its groups.
struct Named {
    block: Block,
    /// By number; 0 stands for a group that the mesh does not have.
    groups: BTreeSet<(i32, String)>,
}

struct Draft<'a> {
    mesh: &'a Mesh,
    wants: &'a Groups,
    notes: Vec<String>,
    blocks: Vec<Named>,
}

impl Draft<'_> {
    /// The groups of a block, with their names.
    fn groups(&self, block: &Block) -> BTreeSet<(i32, String)> {
        let dimension = block.entity.dimension;
        let name = |tag: i32| {
            let known = self.mesh.physical_names().iter().find(|own| own.dimension == dimension && own.tag == tag);
            known.map_or_else(|| format!("group_{tag}"), |own| own.name.clone())
        };
        tags(self.mesh, block).into_iter().map(|tag| (tag, name(tag))).collect()
    }

    fn cells(&mut self) {
        let mut given: BTreeSet<String> = BTreeSet::new();
        for block in self.mesh.cell_blocks() {
            let mut groups = self.groups(block);
            given.extend(groups.iter().map(|(_, name)| name.clone()));
            if let Some(name) = self.wants.cells {
                let tag = groups.first().map_or(0, |(tag, _)| *tag);
                groups = BTreeSet::from([(tag, name.to_owned())]);
            } else if groups.is_empty() {
                groups.insert((0, VOLUME_NAME.to_owned()));
            }
            self.blocks.push(Named { block: block.clone(), groups });
        }
        let Some(name) = self.wants.cells.filter(|name| given.iter().any(|own| own != name)) else { return };
        // One group has one number.
        let first = self.blocks.iter().filter_map(|own| own.groups.first()).map(|(tag, _)| *tag).find(|&tag| tag != 0);
        let all = BTreeSet::from([(first.unwrap_or(0), name.to_owned())]);
        self.blocks.iter_mut().for_each(|own| own.groups.clone_from(&all));
        let given: Vec<String> = given.into_iter().collect();
        self.notes.push(format!("the cells' group {} is called {name}", given.join(", ")));
    }

    /// The boundary elements: those that are sides of cells, and of no group only where they are on the outside.
    fn sides(&mut self) {
        let mesh = self.mesh;
        let mut of_cells: Vec<FaceKey> = mesh.cells().iter().flat_map(|cell| cell.sides()).collect();
        of_cells.par_sort_unstable();
        let cells_at = |key: &FaceKey| {
            let first = of_cells.partition_point(|own| own < key);
            of_cells[first..].iter().take_while(|own| *own == key).count()
        };
        let (mut strays, mut inner) = (0, 0);
        let mut unnamed: BTreeSet<EntityKey> = BTreeSet::new();
        for block in mesh.side_blocks() {
            let mut groups = self.groups(block);
            let is_named = !groups.is_empty();
            let mut own = Block { physical_tags: Vec::new(), ..Block::new(block.cell, block.entity) };
            let corners = block.cell.corner_count();
            for (&tag, nodes) in block.tags.iter().zip(block.elements(mesh.order())) {
                match cells_at(&FaceKey::new(&nodes[..corners])) {
                    0 => strays += 1,
                    2.. if !is_named => inner += 1,
                    _ => {
                        own.tags.push(tag);
                        own.nodes.extend_from_slice(nodes);
                    }
                }
            }
            if own.tags.is_empty() {
                continue;
            }
            if !is_named {
                unnamed.insert(block.entity);
                groups.insert((0, block.entity.to_string().replace(' ', "_")));
            }
            self.blocks.push(Named { block: own, groups });
        }
        let lower = mesh.blocks().iter().filter(|block| block.cell.dimension() + 2 <= mesh.dimension());
        self.tell(
            lower.map(|block| block.tags.len()).sum(),
            "elements below the boundary (points, lines) are left out",
        );
        self.tell(strays, "boundary elements are no side of any cell and are left out");
        self.tell(inner, "elements of no group between cells are left out");
        for key in unnamed {
            self.notes.push(format!("{key} belongs to no group; it is called {}", key.to_string().replace(' ', "_")));
        }
    }

    fn tell(&mut self, count: usize, what: &str) {
        if count > 0 {
            self.notes.push(format!("{count} {what}"));
        }
    }

    /// Elements on the sides of the skin that have none.
    fn skin(&mut self) {
        let mesh = self.mesh;
        let is_side = |own: &&Named| own.block.cell.dimension() < mesh.dimension();
        let mut seen: FxHashSet<FaceKey> = FxHashSet::default();
        for own in self.blocks.iter().filter(is_side) {
            let corners = own.block.cell.corner_count();
            seen.extend(own.block.elements(mesh.order()).map(|nodes| FaceKey::new(&nodes[..corners])));
        }
        let mut alone: FxHashMap<FaceKey, bool> = FxHashMap::default();
        for key in mesh.cells().iter().flat_map(|cell| cell.sides()).filter(|key| !seen.contains(key)) {
            alone.entry(key).and_modify(|alone| *alone = false).or_insert(true);
        }
        let key = EntityKey::unmarked(mesh.dimension().saturating_sub(1) as u8);
        let mut tag = mesh.blocks().iter().flat_map(|block| &block.tags).copied().max().unwrap_or(0);
        let mut blocks: BTreeMap<Cell, Block> = BTreeMap::new();
        for cell in mesh.cells().iter() {
            let slots = side_nodes(cell.cell, mesh.order());
            for (own, (corners, key_of)) in slots.iter().zip(cell.cell.sides().zip(cell.sides())) {
                if alone.get(&key_of) != Some(&true) {
                    continue;
                }
                let kind = [Cell::Line, Cell::Line, Cell::Triangle, Cell::Quad][corners.len() - 1];
                let block = blocks.entry(kind).or_insert_with(|| Block::new(kind, key));
                tag += 1;
                block.tags.push(tag);
                block.nodes.extend(own.iter().map(|&slot| cell.nodes[slot]));
            }
        }
        let count = blocks.values().map(|block| block.tags.len()).sum();
        self.tell(count, "sides of the skin have no boundary element; they are called unmarked");
        let groups = BTreeSet::from([(0, "unmarked".to_owned())]);
        self.blocks.extend(blocks.into_values().map(|block| Named { block, groups: groups.clone() }));
    }

    fn refuse_several(&self) -> Result<(), String> {
        let Some(several) = self.blocks.iter().find(|own| own.groups.len() > 1) else { return Ok(()) };
        let names: Vec<&str> = several.groups.iter().map(|(_, name)| &name[..]).collect();
        let at = several.block.entity;
        Err(format!(
            "{at} is in the groups {}, and the solver knows one for each element; leave it in one",
            names.join(", ")
        ))
    }

    /// The mesh of the blocks: numbers and names of the groups, each once in all dimensions.
    fn finish(mut self) -> Result<(Mesh, Vec<String>), String> {
        let mut wished: Vec<(u8, i32, String)> = Vec::new();
        for own in &self.blocks {
            wished.extend(own.groups.iter().map(|(tag, name)| (own.block.entity.dimension, *tag, name.clone())));
        }
        // Numbers of their own first; sides before cells.
        wished.sort_by_key(|(dimension, tag, name)| (*tag == 0, *dimension, *tag, name.clone()));
        wished.dedup();
        let mut free = 1 + wished.iter().map(|(_, tag, _)| *tag).max().unwrap_or(0);
        let (mut used, mut so_far) = (HashSet::new(), HashSet::new());
        let mut known: BTreeMap<(u8, i32, String), i32> = BTreeMap::new();
        let mut physical_names: Vec<PhysicalName> = Vec::new();
        for (dimension, tag, wish) in wished {
            if let Some(reason) = (self.wants.names.refused)(&wish) {
                return Err(format!("the name {wish:?} of a group: {reason}"));
            }
            let name = self.wants.names.name(&wish, &mut so_far);
            if name != wish {
                self.notes.push(format!("the group {wish:?} is called {name:?}"));
            }
            let number = if tag != 0 && used.insert(tag) { tag } else { free };
            if number == free {
                used.insert(free);
                free += 1;
                if tag != 0 {
                    self.notes
                        .push(format!("the group {name} has the number {number} in place of {tag}, which another has"));
                }
            }
            physical_names.push(PhysicalName { dimension, tag: number, name });
            known.insert((dimension, tag, wish), number);
        }
        self.put_together(&known, physical_names, free)
    }

    fn put_together(
        mut self,
        known: &BTreeMap<(u8, i32, String), i32>,
        physical_names: Vec<PhysicalName>,
        mut free: i32,
    ) -> Result<(Mesh, Vec<String>), String> {
        let mut sets: BTreeMap<Vec<i32>, i32> = BTreeMap::new();
        let mut entities: BTreeMap<EntityKey, EntityKey> = BTreeMap::new();
        let mut blocks = Vec::new();
        for Named { block, groups } in std::mem::take(&mut self.blocks) {
            let dimension = block.entity.dimension;
            let number = |(tag, name): &(i32, String)| known.get(&(dimension, *tag, name.clone())).copied();
            let physical_tags: Vec<i32> = groups.iter().filter_map(number).collect();
            let tag = match physical_tags[..] {
                [tag] => tag,
                _ => *sets.entry(physical_tags.clone()).or_insert_with(|| {
                    free += 1;
                    free - 1
                }),
            };
            let entity = EntityKey::new(dimension, tag);
            entities.insert(block.entity, entity);
            blocks.push(Block { entity, physical_tags, ..block });
        }
        let periodic = self.periodic(&entities);
        if !self.mesh.conditions().is_empty() {
            self.notes.push("the kinds of boundary conditions are left out".to_owned());
        }
        let parts = Parts {
            order: self.mesh.order(),
            points: self.mesh.points().to_vec(),
            node_tags: self.mesh.node_tags().to_vec(),
            blocks,
            physical_names,
            periodic,
            ..Parts::default()
        };
        let mesh = Mesh::new(parts).map_err(|error| error.to_string())?;
        Ok((mesh, self.notes))
    }

    /// Pairs of boundary entities as pairs of groups.
    fn periodic(&mut self, entities: &BTreeMap<EntityKey, EntityKey>) -> Vec<Periodic> {
        let mut joined: BTreeMap<(EntityKey, i32), Periodic> = BTreeMap::new();
        let mut within = 0;
        for link in self.mesh.periodic() {
            let master = EntityKey { tag: link.master, ..link.slave };
            let (Some(&slave), Some(master)) = (entities.get(&link.slave), entities.get(&master)) else { continue };
            if slave == *master {
                within += 1;
                continue;
            }
            let new = || Periodic { slave, master: master.tag, affine: link.affine.clone(), pairs: Vec::new() };
            let own = joined.entry((slave, master.tag)).or_insert_with(new);
            if own.affine != link.affine {
                own.affine = Vec::new();
            }
            own.pairs.extend(&link.pairs);
        }
        self.tell(within, "periodic pairs of entities are of one group, and are left out");
        let mut all: Vec<Periodic> = joined.into_values().collect();
        for own in &mut all {
            own.pairs.sort_unstable();
            own.pairs.dedup();
        }
        all
    }
}
