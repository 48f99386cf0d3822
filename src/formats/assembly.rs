//! A mesh being put together from a format that has points, cells and named boundary patches.

use std::collections::HashSet;

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::error::Fault;
use super::turned;
use crate::element::{Cell, Order};
use crate::mesh::{Block, Entity, EntityKey, Mesh, NodeId, Parts, PhysicalName};

/// The group of the volume's elements where a file does not name them; the name that PyFR asks for.
pub(super) const VOLUME_NAME: &str = "fluid";

/// What has been read so far.
pub(super) struct Assembly {
    pub(super) parts: Parts,
    order: Option<Order>,
    blocks: FxHashMap<(Cell, EntityKey), usize>,
    /// The block that was asked for last.
    last: Option<((Cell, EntityKey), usize)>,
    /// The tag of the next element that has no number of its own.
    next_tag: u64,
}

impl Assembly {
    /// A mesh of these points, numbered from 1, and no elements.
    ///
    /// # Errors
    /// [`Fault::NotFinite`]; [`Fault::TooMany`].
    pub(super) fn new(points: Vec<DVec3>) -> Result<Assembly, Fault> {
        NodeId::new(points.len())?;
        if let Some(n) = points.iter().position(|x| !x.is_finite()) {
            return Err(Fault::NotFinite(n as u64 + 1));
        }
        let parts = Parts { points, ..Parts::default() };
        Ok(Assembly { parts, order: None, blocks: FxHashMap::default(), last: None, next_tag: 1 })
    }

    /// Fixes the order of the mesh, or compares with it.
    ///
    /// # Errors
    /// [`Fault::MixedOrders`].
    pub(super) fn set_order(&mut self, cell: Cell, order: Order) -> Result<(), Fault> {
        if cell == Cell::Point {
            return Ok(());
        }
        let mesh = *self.order.get_or_insert(order);
        self.parts.order = mesh;
        if mesh == order { Ok(()) } else { Err(Fault::MixedOrders { order: mesh, here: order }) }
    }

    /// The block of a kind of cell on an entity.
    pub(super) fn block(&mut self, cell: Cell, entity: EntityKey) -> &mut Block {
        let key = (cell, entity);
        let blocks = &mut self.parts.blocks;
        let place = match self.last {
            Some((known, place)) if known == key => place,
            _ => *self.blocks.entry(key).or_insert_with(|| {
                blocks.push(Block::new(cell, entity));
                blocks.len() - 1
            }),
        };
        self.last = Some((key, place));
        &mut blocks[place]
    }

    /// Adds an element under the next free number.
    pub(super) fn push(&mut self, cell: Cell, entity: EntityKey, nodes: &[NodeId]) {
        let tag = self.next_tag;
        self.push_tagged(cell, entity, tag, nodes);
    }

    /// Adds an element under its own number.
    pub(super) fn push_tagged(&mut self, cell: Cell, entity: EntityKey, tag: u64, nodes: &[NodeId]) {
        self.next_tag = self.next_tag.max(tag.saturating_add(1));
        let block = self.block(cell, entity);
        block.tags.push(tag);
        block.nodes.extend_from_slice(nodes);
    }

    /// The physical tag of a name: that of the group of the name, else `wish` or the next free one.
    pub(super) fn group(&mut self, dimension: u8, name: &str, wish: Option<i32>) -> i32 {
        let names = &mut self.parts.physical_names;
        if let Some(known) = names.iter().find(|n| n.dimension == dimension && n.name == name) {
            return known.tag;
        }
        let free = |tag: i32| names.iter().all(|n| n.tag != tag);
        let tag = wish
            .filter(|&tag| tag > 0 && free(tag))
            .unwrap_or_else(|| names.iter().map(|n| n.tag).max().unwrap_or(0).max(0).saturating_add(1));
        names.push(PhysicalName { dimension, tag, name: name.to_owned() });
        tag
    }

    /// Says which groups an entity belongs to.
    pub(super) fn entity(&mut self, key: EntityKey, physical_tags: Vec<i32>) {
        self.parts.entities.push(Entity { key, bounds: [[0.0; 3]; 2], physical_tags, boundary: Vec::new() });
    }

    /// The finished mesh.
    ///
    /// # Errors
    /// [`Fault::Inconsistent`].
    pub(super) fn finish(self) -> Result<Mesh, Fault> {
        Ok(Mesh::new(self.complete())?)
    }

    /// The parts with entities complete with boxes, the volume named, every cell turned so that its volume is positive.
    pub(super) fn complete(mut self) -> Parts {
        self.parts.blocks.retain(|block| !block.tags.is_empty());
        let used: HashSet<EntityKey> = self.parts.blocks.iter().map(|block| block.entity).collect();
        self.parts.entities.retain(|entity| used.contains(&entity.key));
        self.name_volume();
        let known: HashSet<EntityKey> = self.parts.entities.iter().map(|entity| entity.key).collect();
        let mut missing: Vec<EntityKey> = used.difference(&known).copied().collect();
        missing.sort_unstable();
        missing.into_iter().for_each(|key| self.entity(key, Vec::new()));
        self.parts.entities.sort_by_key(|entity| entity.key);
        let mut parts = self.parts;
        bounds(&mut parts);
        turned::turn(&mut parts);
        parts
    }

    /// Puts the entities of the top dimension that belong to no group into one.
    fn name_volume(&mut self) {
        let top = self.parts.blocks.iter().map(|block| block.entity.dimension).max().unwrap_or(3);
        let grouped: HashSet<EntityKey> =
            self.parts.entities.iter().filter(|e| !e.physical_tags.is_empty()).map(|e| e.key).collect();
        let mut plain: Vec<EntityKey> = self.parts.blocks.iter().map(|block| block.entity).collect();
        plain.retain(|key| key.dimension == top && !grouped.contains(key));
        plain.sort_unstable();
        plain.dedup();
        if plain.is_empty() {
            return;
        }
        // Surfaces may carry tags without a name, which the volume's must not repeat.
        let last = self.parts.entities.iter().flat_map(|e| &e.physical_tags).copied().max().unwrap_or(0);
        let tag = self.group(top, VOLUME_NAME, Some(last.saturating_add(1)));
        for key in plain {
            self.parts.entities.retain(|entity| entity.key != key);
            self.entity(key, vec![tag]);
        }
    }
}

/// The node that a file's number means, counted from `base`, in a mesh of `count` points.
///
/// # Errors
/// [`Fault::UnknownNode`].
pub(super) fn node_of(count: usize, number: i64, base: i64, by: u64) -> Result<NodeId, Fault> {
    let index = number.checked_sub(base).and_then(|n| usize::try_from(n).ok()).filter(|&n| n < count);
    match index {
        Some(index) => Ok(NodeId::new(index)?),
        None => Err(Fault::NodeRange { by, node: number, first: base, last: base + count as i64 - 1 }),
    }
}

/// Nodes that one task looks at.
const CHUNK: usize = 1 << 16;
/// The box of nothing.
const EMPTY: [DVec3; 2] = [DVec3::INFINITY, DVec3::NEG_INFINITY];

/// Gives the entities their boxes.
fn bounds(mesh: &mut Parts) {
    let places: FxHashMap<EntityKey, usize> = mesh.entities.iter().enumerate().map(|(n, e)| (e.key, n)).collect();
    let mut boxes = vec![EMPTY; mesh.entities.len()];
    for block in &mesh.blocks {
        let Some(&place) = places.get(&block.entity) else { continue };
        let points = &mesh.points;
        let of = |nodes: &[NodeId]| {
            nodes.iter().map(|n| points[n.index()]).fold(EMPTY, |[lower, upper], at| [lower.min(at), upper.max(at)])
        };
        let join = |[a, b]: [DVec3; 2], [c, d]: [DVec3; 2]| [a.min(c), b.max(d)];
        let own = block.nodes.par_chunks(CHUNK).map(of).reduce(|| EMPTY, join);
        boxes[place] = join(boxes[place], own);
    }
    for (entity, [lower, upper]) in mesh.entities.iter_mut().zip(boxes) {
        entity.bounds = [lower.to_array(), upper.to_array()];
    }
}
