//! How a mesh is laid out in an MSH 4.1 file: which entities, which node blocks, in which order.

use std::borrow::Cow;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

use crate::element::Order;
use crate::mesh::{Block, Entity, EntityKey, Mesh, NodeId};

/// The layout of a mesh whose entities are complete: every node and block has one that the file will tell of.
pub(super) struct Outline<'a> {
    /// All entities, by dimension: those of the mesh in its order, then those that blocks or nodes need besides.
    pub(super) entities: Vec<Cow<'a, Entity>>,
    /// The entity of each block.
    pub(super) blocks: Vec<EntityKey>,
    /// Node blocks: runs of nodes on one entity.
    pub(super) runs: Vec<Run>,
    /// The nodes from [`Outline::tail_start`] on, ordered by entity.
    tail: Vec<NodeId>,
    tail_start: usize,
    /// Parameters of nodes, by rising node.
    parameters: Vec<(NodeId, [f64; 2])>,
}

/// A run of nodes on one entity, which all have parameters or of which none counts.
pub(super) struct Run {
    pub(super) entity: EntityKey,
    pub(super) parametric: bool,
    /// Places in the order of writing; see [`Outline::node`].
    pub(super) places: Range<usize>,
}

impl<'a> Outline<'a> {
    /// Lays out a mesh.
    pub(super) fn new(mesh: &'a Mesh) -> Outline<'a> {
        let (blocks, groups) = block_entities(mesh);
        let nodes = node_entities(mesh, &blocks);
        let (tail_start, tail) = tail(mesh, &nodes);
        let mut parameters = mesh.node_parameters().to_vec();
        parameters.sort_by_key(|&(node, _)| node);
        let mut outline = Outline { entities: Vec::new(), blocks, runs: Vec::new(), tail, tail_start, parameters };
        for place in 0..mesh.points().len() {
            let node = outline.node(place);
            let entity = nodes[node];
            let parametric = matches!(entity.dimension, 1 | 2) && outline.parameters(node).is_some();
            match outline.runs.last_mut() {
                Some(run) if run.entity == entity && run.parametric == parametric => run.places.end = place + 1,
                _ => outline.runs.push(Run { entity, parametric, places: place..place + 1 }),
            }
        }
        outline.entities = outline.all_entities(mesh, &groups);
        outline
    }

    /// The node at a place in the order of writing.
    pub(super) fn node(&self, place: usize) -> usize {
        match place.checked_sub(self.tail_start) {
            Some(n) => self.tail[n].index(),
            None => place,
        }
    }

    /// The parameters of a node on its curve or surface.
    pub(super) fn parameters(&self, node: usize) -> Option<[f64; 2]> {
        let place = self.parameters.binary_search_by_key(&node, |&(n, _)| n.index()).ok()?;
        Some(self.parameters[place].1)
    }

    fn all_entities(&self, mesh: &'a Mesh, groups: &BTreeMap<EntityKey, Vec<i32>>) -> Vec<Cow<'a, Entity>> {
        let mut entities: Vec<Cow<'a, Entity>> = mesh.entities().iter().map(Cow::Borrowed).collect();
        let known: HashSet<EntityKey> = mesh.entities().iter().map(|e| e.key).collect();
        let used = self.blocks.iter().copied().chain(self.runs.iter().map(|run| run.entity));
        let mut boxes: BTreeMap<EntityKey, [[f64; 3]; 2]> = used
            .filter(|key| !known.contains(key))
            .map(|key| (key, [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]))
            .collect();
        let mut grow = |key: EntityKey, node: usize| {
            if let Some([lower, upper]) = boxes.get_mut(&key) {
                let at = mesh.points()[node].to_array();
                *lower = std::array::from_fn(|x| lower[x].min(at[x]));
                *upper = std::array::from_fn(|x| upper[x].max(at[x]));
            }
        };
        for (block, &key) in mesh.blocks().iter().zip(&self.blocks).filter(|(_, key)| !known.contains(key)) {
            block.nodes.iter().for_each(|node| grow(key, node.index()));
        }
        for run in self.runs.iter().filter(|run| !known.contains(&run.entity)) {
            run.places.clone().for_each(|place| grow(run.entity, self.node(place)));
        }
        entities.extend(boxes.into_iter().map(|(key, bounds)| {
            let physical_tags = groups.get(&key).cloned().unwrap_or_default();
            // An entity of an empty block has no box.
            let bounds = if bounds[0][0] <= bounds[1][0] { bounds } else { [[0.0; 3]; 2] };
            Cow::Owned(Entity { key, bounds, physical_tags, boundary: Vec::new() })
        }));
        entities.sort_by_key(|entity| entity.key.dimension);
        entities
    }
}

/// The entity of each block, and the physical groups of entities that the mesh does not list.
///
/// MSH 2.2 puts elements, not entities, into groups: where blocks of one entity differ in groups, or the tag is
/// none that 4.1 allows, the later block moves to an entity of its own with a fresh tag.
fn block_entities(mesh: &Mesh) -> (Vec<EntityKey>, BTreeMap<EntityKey, Vec<i32>>) {
    let known: HashSet<EntityKey> = mesh.entities().iter().map(|e| e.key).collect();
    let mut last = [0; 4];
    for key in known.iter().copied().chain(mesh.blocks().iter().map(|b| b.entity)) {
        let largest = &mut last[usize::from(key.dimension)];
        *largest = key.tag.max(*largest);
    }
    let mut groups: BTreeMap<EntityKey, Vec<i32>> = BTreeMap::new();
    let mut moved: BTreeMap<(EntityKey, &[i32]), EntityKey> = BTreeMap::new();
    let mut keys = Vec::with_capacity(mesh.blocks().len());
    for block in mesh.blocks() {
        let key = block.entity;
        let fits = groups.get(&key).is_none_or(|tags| *tags == block.physical_tags);
        if known.contains(&key) || (key.tag > 0 && fits) {
            groups.entry(key).or_insert_with(|| block.physical_tags.clone());
            keys.push(key);
            continue;
        }
        let fresh = *moved.entry((key, &block.physical_tags)).or_insert_with(|| {
            let largest = &mut last[usize::from(key.dimension)];
            *largest = largest.saturating_add(1);
            EntityKey::new(key.dimension, *largest)
        });
        groups.insert(fresh, block.physical_tags.clone());
        keys.push(fresh);
    }
    (keys, groups)
}

/// The entity of each node: what the mesh says, else that of the lowest-dimensional element at the node.
fn node_entities(mesh: &Mesh, blocks: &[EntityKey]) -> Vec<EntityKey> {
    let fallback = blocks.iter().copied().max_by_key(|key| key.dimension).unwrap_or(EntityKey::new(3, 1));
    let mut entities: Vec<EntityKey> = vec![fallback; mesh.points().len()];
    if mesh.node_entities().len() < entities.len() || mesh.node_entities().contains(&None) {
        for dimension in (0..=3).rev() {
            let own = |(_, block): &(usize, &Block)| block.cell.dimension() == dimension;
            for (n, block) in mesh.blocks().iter().enumerate().filter(own) {
                block.nodes.iter().for_each(|node| entities[node.index()] = blocks[n]);
            }
        }
    }
    for (entity, given) in entities.iter_mut().zip(mesh.node_entities()) {
        *entity = given.unwrap_or(*entity);
    }
    entities
}

/// Where the nodes begin that no element has as a corner, and those nodes ordered by entity.
///
/// The linear nodes keep the file's order; the high-order nodes behind them come in any order, and would make a
/// block each.
fn tail(mesh: &Mesh, entities: &[EntityKey]) -> (usize, Vec<NodeId>) {
    if mesh.order() == Order::LINEAR {
        return (mesh.points().len(), Vec::new());
    }
    let mut start = 0;
    for block in mesh.blocks() {
        for nodes in block.elements(mesh.order()) {
            let last = nodes[..block.cell.corner_count()].iter().map(|node| node.index() + 1).max();
            start = start.max(last.unwrap_or(0));
        }
    }
    let mut tail: Vec<NodeId> = (start..mesh.points().len()).filter_map(|n| NodeId::new(n).ok()).collect();
    tail.sort_by_key(|node| entities[node.index()]);
    (start, tail)
}
