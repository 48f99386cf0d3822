//! Names of attributes: named sets of them (version 1.3).

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use crate::formats::assembly::Assembly;
use crate::mesh::{Block, EntityKey, Mesh, PhysicalName};

/// A named set of attributes.
pub(super) struct Set {
    pub(super) name: String,
    pub(super) attributes: BTreeSet<i32>,
}

/// The attributes of a mesh's blocks, and the sets that name them, for elements of one dimension.
pub(super) struct Attributes {
    by_block: HashMap<(EntityKey, Vec<i32>), i32>,
    pub(super) sets: Vec<Set>,
}

impl Attributes {
    /// Attributes of blocks of one dimension: the number of their entity where that can be one and no other has it.
    pub(super) fn of<'a>(mesh: &Mesh, blocks: impl Iterator<Item = &'a Block> + Clone) -> Attributes {
        let mut free = 1 + blocks.clone().map(|block| block.entity.tag).max().unwrap_or(0).max(0);
        let mut used = HashSet::new();
        let mut by_block = HashMap::new();
        let mut members: BTreeMap<(u8, i32), BTreeSet<i32>> = BTreeMap::new();
        for block in blocks {
            let attribute = *by_block.entry((block.entity, block.physical_tags.clone())).or_insert_with(|| {
                if block.entity.tag > 0 && used.insert(block.entity.tag) {
                    return block.entity.tag;
                }
                free += 1;
                free - 1
            });
            let of_entity = || mesh.physical_tags_of(block.entity);
            let groups = if block.physical_tags.is_empty() { of_entity() } else { block.physical_tags.clone() };
            for tag in groups {
                members.entry((block.entity.dimension, tag.saturating_abs())).or_default().insert(attribute);
            }
        }
        let named = mesh.physical_names().iter();
        let sets = named.filter_map(|own| Some((own.name.clone(), members.get(&(own.dimension, own.tag))?.clone())));
        Attributes { by_block, sets: sets.map(|(name, attributes)| Set { name, attributes }).collect() }
    }

    /// The attribute of a block's elements.
    pub(super) fn attribute(&self, block: &Block) -> i32 {
        self.by_block.get(&(block.entity, block.physical_tags.clone())).copied().unwrap_or(1)
    }
}

/// Makes groups of attributes: of each set, and of each attribute that is in none. Those of sets of several attributes have numbers
/// beyond the attributes'.
pub(super) fn group(assembly: &mut Assembly, dimension: u8, attributes: &BTreeSet<i32>, sets: &[Set]) {
    let mut groups: BTreeMap<i32, Vec<i32>> = BTreeMap::new();
    let named = sets.iter().flat_map(|set| &set.attributes);
    let mut free = attributes.iter().chain(named).max().copied().unwrap_or(0).saturating_add(1);
    let mut used = HashSet::new();
    for set in sets {
        let own = set.attributes.first().copied().filter(|own| set.attributes.len() == 1 && used.insert(*own));
        let tag = own.unwrap_or(free);
        free = free.saturating_add(i32::from(own.is_none()));
        assembly.parts.physical_names.push(PhysicalName { dimension, tag, name: set.name.clone() });
        set.attributes.iter().for_each(|&attribute| groups.entry(attribute).or_default().push(tag));
    }
    for &attribute in attributes {
        let tags = groups.remove(&attribute).unwrap_or_else(|| vec![attribute]);
        assembly.entity(EntityKey::new(dimension, attribute), tags);
    }
}
