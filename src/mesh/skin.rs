//! The skin of a mesh: the sides that one cell alone has, held against the boundary elements that the file gives.

use std::borrow::Cow;
use std::collections::BTreeMap;

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use super::components::connected;
use super::{Block, ElementId, EntityKey, FaceKey, Mesh, NodeId};
use crate::element::{Cell, Order};

/// Items that a note lists by number or place.
const LISTED: usize = 5;

/// Where boundary elements and cells do not fit each other.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// Sides of one cell alone that no boundary element marks, by their corners.
    pub unmarked: Vec<FaceKey>,
    /// Boundary elements with the corners of a cell's side in another order round: their edges cross. Numbers of [`Mesh::sides`].
    pub crossed: Vec<ElementId>,
    /// Boundary elements that are no side of any cell.
    pub strays: Vec<ElementId>,
    /// Nodes of no element.
    pub isolated: Vec<NodeId>,
}

impl Skin {
    /// Looks at the sides of all cells.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Skin {
        let mut skin = Skin { isolated: isolated(mesh), ..Skin::default() };
        let mut of_cells: Vec<FaceKey> = mesh.cells().iter().flat_map(|cell| cell.sides()).collect();
        of_cells.par_sort_unstable();
        let mut marked: FxHashSet<FaceKey> = FxHashSet::default();
        let mut unmatched = Vec::new();
        for side in mesh.sides().iter() {
            let key = FaceKey::new(side.corners());
            if marked.insert(key) && of_cells.binary_search(&key).is_err() {
                unmatched.push((side.id, set(side.corners())));
            }
        }
        let alone = of_cells.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]);
        skin.unmarked = alone.filter(|key| !marked.contains(key)).collect();
        let wanted: FxHashSet<&Vec<NodeId>> = unmatched.iter().map(|(_, corners)| corners).collect();
        let crossed: FxHashSet<Vec<NodeId>> = if wanted.is_empty() {
            FxHashSet::default()
        } else {
            of_cells.iter().map(|key| set(key.corners())).filter(|corners| wanted.contains(corners)).collect()
        };
        for (id, corners) in unmatched {
            if crossed.contains(&corners) { skin.crossed.push(id) } else { skin.strays.push(id) }
        }
        skin
    }

    /// Nodes of no element.
    #[must_use]
    pub fn isolated(mesh: &Mesh) -> Vec<NodeId> {
        isolated(mesh)
    }

    /// What a user should know, one line a finding.
    #[must_use]
    pub fn notes(&self, mesh: &Mesh) -> Vec<String> {
        let sides = mesh.sides();
        let number = |id: &ElementId| sides.get(*id).tag;
        let noun = if mesh.is_volume() { "faces" } else { "edges" };
        let mut notes = self.unmarked_notes(mesh, noun);
        let mut tell = |what: &str, count: usize, listed: String| {
            if count > 0 {
                notes.push(format!("{count} {what}: {listed}"));
            }
        };
        let crossed = "boundary elements have their corners in an order in which their edges cross";
        tell(crossed, self.crossed.len(), list(&self.crossed, number));
        tell("boundary elements are no side of any cell", self.strays.len(), list(&self.strays, number));
        let node = |id: &NodeId| mesh.node_tags()[id.index()];
        tell("nodes belong to no element", self.isolated.len(), list(&self.isolated, node));
        notes
    }

    /// Unmarked sides, one line a connected region: how many, where, and beside which patch.
    fn unmarked_notes(&self, mesh: &Mesh, noun: &str) -> Vec<String> {
        if self.unmarked.is_empty() {
            return Vec::new();
        }
        let corners: Vec<&[NodeId]> = self.unmarked.iter().map(FaceKey::corners).collect();
        let mut regions = connected(corners.iter().copied(), std::iter::empty());
        regions.sort_by_key(|region| (std::cmp::Reverse(region.len()), region[0]));
        let mut patches: FxHashMap<NodeId, EntityKey> = FxHashMap::default();
        for side in mesh.sides().iter() {
            side.corners().iter().for_each(|&node| _ = patches.entry(node).or_insert(side.entity));
        }
        let note = |region: &Vec<usize>| {
            let mut beside: BTreeMap<EntityKey, usize> = BTreeMap::new();
            for node in region.iter().flat_map(|&place| corners[place]) {
                patches.get(node).into_iter().for_each(|&patch| *beside.entry(patch).or_default() += 1);
            }
            let nearest = beside.into_iter().max_by_key(|&(_, shared)| shared);
            let beside = nearest.map_or_else(String::new, |(patch, _)| format!(", beside {}", mesh.label(patch)));
            let own = corners[region[0]];
            let at = mesh.points_of(own).sum::<DVec3>() / own.len() as f64;
            let count = region.len();
            format!(
                "{count} {noun} of the skin have no boundary element: near ({:.6}, {:.6}, {:.6}){beside}",
                at.x, at.y, at.z
            )
        };
        let mut notes: Vec<String> = regions.iter().take(LISTED).map(note).collect();
        if regions.len() > LISTED {
            let count: usize = regions[LISTED..].iter().map(Vec::len).sum();
            notes.push(format!(
                "{count} more {noun} of the skin have no boundary element, in {} places",
                regions.len() - LISTED
            ));
        }
        notes
    }
}

impl Mesh {
    /// The linear mesh with a boundary element on every side of the skin that has none, on the entity [`EntityKey::unmarked`], and what of
    /// its skin is amiss in its notes.
    #[must_use]
    pub fn with_unmarked(mut self, skin: &Skin) -> Mesh {
        if self.order() != Order::LINEAR {
            return self;
        }
        let notes = skin.notes(&self);
        self.parts.notes.extend(notes);
        let dimension = self.side_dimension();
        let mut tag = self.blocks().iter().flat_map(|block| &block.tags).copied().max().unwrap_or(0);
        for cell in Cell::ALL.into_iter().filter(|cell| cell.dimension() == usize::from(dimension)) {
            let mut block = Block::new(cell, EntityKey::unmarked(dimension));
            for key in skin.unmarked.iter().filter(|key| key.corners().len() == cell.corner_count()) {
                tag += 1;
                block.tags.push(tag);
                block.nodes.extend_from_slice(key.corners());
            }
            if !block.tags.is_empty() {
                self.parts.blocks.push(block);
            }
        }
        self
    }

    /// The mesh as its file has it: without the boundary elements of [`Mesh::with_unmarked`].
    #[must_use]
    pub fn without_unmarked(&self) -> Cow<'_, Mesh> {
        let is_unmarked = |block: &Block| block.entity.is_unmarked();
        if !self.blocks().iter().any(is_unmarked) {
            return Cow::Borrowed(self);
        }
        let mut own = self.clone();
        own.parts.blocks.retain(|block| !is_unmarked(block));
        Cow::Owned(own)
    }
}

/// Nodes of no element.
fn isolated(mesh: &Mesh) -> Vec<NodeId> {
    let mut used = vec![false; mesh.points().len()];
    mesh.blocks().iter().flat_map(|block| &block.nodes).for_each(|node| used[node.index()] = true);
    (0..used.len()).filter(|&node| !used[node]).filter_map(|node| NodeId::new(node).ok()).collect()
}

/// Corners without their order.
fn set(corners: &[NodeId]) -> Vec<NodeId> {
    let mut corners = corners.to_vec();
    corners.sort_unstable();
    corners
}

fn list<T>(items: &[T], number: impl Fn(&T) -> u64) -> String {
    let some: Vec<String> = items.iter().take(LISTED).map(|item| number(item).to_string()).collect();
    some.join(", ") + if items.len() > LISTED { ", ..." } else { "" }
}
