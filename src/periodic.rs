//! Periodic patches: nodes of one side are images of nodes of the other, and stay so.
//!
//! Only the master's nodes are projected, carried and smoothed on their own; the slave's are set to their images, wherever nodes move.

use std::collections::BTreeMap;

use cad::Aabb;
use glam::{DAffine3, DMat4, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::associate::Boundary;
use crate::element::{Cell, canonical, interior_slots};
use crate::elevate::Elevated;
use crate::mesh::{Mesh, NodeId, Periodic};
use crate::smooth::Image;

/// The linear nodes of a pair correspond if none is farther from its partner's image; share of the mesh's box.
pub const CONGRUENT: f64 = 1e-6;

/// Nodes that are images of others.
#[derive(Clone, Debug, Default)]
pub struct Ties {
    images: Vec<Image>,
}

impl Ties {
    /// The ties of an elevated mesh, whose periodic pairs are extended to the new nodes. With `freeze_linear` linear nodes are not tied.
    ///
    /// Returns what a user should know of pairs that are none.
    #[must_use]
    pub fn new(elevated: &mut Elevated, boundary: &Boundary, freeze_linear: bool) -> (Ties, Vec<String>) {
        let mut notes = Vec::new();
        let mut leads: BTreeMap<NodeId, (NodeId, DAffine3)> = BTreeMap::new();
        let mut records = std::mem::take(&mut elevated.mesh.periodic);
        for record in &mut records {
            let Some(map) = map_of(&elevated.mesh, record) else {
                let Periodic { slave, master, .. } = record;
                notes.push(format!(
                    "{slave} does not correspond to {master} under its transform; they are not kept periodic"
                ));
                continue;
            };
            record.pairs.extend(new_pairs(elevated, boundary, record));
            for &(slave, master) in &record.pairs {
                let linear = slave.index() < elevated.linear_nodes;
                if slave != master && !(linear && freeze_linear) && root(&leads, master).0 != slave {
                    leads.entry(slave).or_insert((master, map));
                }
            }
        }
        // One entity on both sides is a pair of patches that the file cannot tell apart.
        records.retain(|record| record.slave.tag != record.master);
        elevated.mesh.periodic = records;
        let images: Vec<_> = leads.keys().map(|&slave| (slave, root(&leads, slave))).collect();
        let images = images.into_iter().map(|(node, (of, map))| Image { node, of, map }).collect();
        (Ties { images }, notes)
    }

    /// All nodes that are images of others.
    #[must_use]
    pub fn images(&self) -> &[Image] {
        &self.images
    }

    /// Puts every node that follows at its image.
    pub fn apply(&self, places: &mut [DVec3]) {
        for &Image { node: slave, of: lead, map } in &self.images {
            places[slave.index()] = map.transform_point3(places[lead.index()]);
        }
    }

    /// Gives every node that follows the displacement that takes it to its image.
    pub fn carry(&self, straight: &[DVec3], displacement: &mut [DVec3]) {
        for &Image { node: slave, of: lead, map } in &self.images {
            let image = map.transform_point3(straight[lead.index()] + displacement[lead.index()]);
            displacement[slave.index()] = image - straight[slave.index()];
        }
    }

    /// Marks both sides of every pair of which one is marked.
    pub fn spread(&self, marked: &mut [bool]) {
        Image::spread(&self.images, marked);
    }

    /// Gives both sides of every pair the lesser value.
    pub fn least(&self, values: &mut [f64]) {
        for _ in 0..2 {
            for &Image { node: slave, of: lead, .. } in &self.images {
                let least = values[slave.index()].min(values[lead.index()]);
                (values[slave.index()], values[lead.index()]) = (least, least);
            }
        }
    }

    /// The largest distance of a node from its image.
    #[must_use]
    pub fn farthest(&self, places: &[DVec3]) -> f64 {
        let apart = |&Image { node: slave, of: lead, map }: &Image| {
            map.transform_point3(places[lead.index()]).distance(places[slave.index()])
        };
        self.images.iter().map(apart).fold(0.0, f64::max)
    }
}

/// The node that leads, over any number of pairs, and the map from it.
fn root(leads: &BTreeMap<NodeId, (NodeId, DAffine3)>, node: NodeId) -> (NodeId, DAffine3) {
    let (mut here, mut map) = (node, DAffine3::IDENTITY);
    while let Some(&(next, step)) = leads.get(&here) {
        map *= step;
        here = next;
    }
    (here, map)
}

/// The map from master to slave that the record gives, in whichever direction it takes the nodes onto one another; where it gives none, a
/// shift that does.
#[must_use]
pub fn map_of(mesh: &Mesh, record: &Periodic) -> Option<DAffine3> {
    let slack = CONGRUENT * Aabb::of_points(mesh.points.iter().copied()).diagonal();
    let at = |node: NodeId| mesh.points[node.index()];
    let fits = |map: &DAffine3| {
        record.pairs.iter().all(|&(slave, master)| map.transform_point3(at(master)).distance(at(slave)) <= slack)
    };
    let given: Option<[f64; 16]> = record.affine.clone().try_into().ok();
    match given {
        Some(rows) => maps(&rows).into_iter().find(fits),
        None => {
            let &(slave, master) = record.pairs.first()?;
            Some(DAffine3::from_translation(at(slave) - at(master))).filter(fits)
        }
    }
}

/// The maps that 16 numbers may mean: rows or columns, there or back. Writers differ.
#[must_use]
pub fn maps(numbers: &[f64; 16]) -> Vec<DAffine3> {
    let columns = DMat4::from_cols_array(numbers);
    let maps = [columns.transpose(), columns].map(|matrix| (matrix, DAffine3::from_mat4(matrix)));
    let is_affine = |matrix: &DMat4| matrix.row(3).abs_diff_eq(glam::DVec4::W, 1e-12);
    let usable = maps.into_iter().filter(|(matrix, map)| is_affine(matrix) && map.matrix3.determinant().abs() > 1e-12);
    usable.flat_map(|(_, map)| [map, map.inverse()]).collect()
}

/// The pairs of new nodes, on edges and faces of the slave entity.
fn new_pairs(elevated: &Elevated, boundary: &Boundary, record: &Periodic) -> Vec<(NodeId, NodeId)> {
    let masters: FxHashMap<NodeId, NodeId> = record.pairs.iter().copied().collect();
    let own = carried(elevated, boundary, record.slave.dimension, |entity| entity == record.slave);
    let mut pairs = Vec::new();
    for cell in [Cell::Line, Cell::Triangle, Cell::Quad] {
        let carriers = &elevated.carriers[cell as usize];
        let on_boundary = || carriers.iter().take_while(|(_, first)| first.index() < elevated.boundary_nodes);
        let known: FxHashMap<&[NodeId], NodeId> = on_boundary().collect();
        for (corners, first) in on_boundary().filter(|(corners, _)| own.contains(*corners)) {
            let Some(images) = corners.iter().map(|n| masters.get(n).copied()).collect::<Option<Vec<_>>>() else {
                continue;
            };
            let seen = canonical(&images);
            let key: Vec<NodeId> = seen[..images.len()].iter().map(|&q| images[usize::from(q)]).collect();
            let Some(&lead) = known.get(&key[..]) else { continue };
            for (own, other) in interior_slots(cell, elevated.mesh.order, seen).into_iter().enumerate() {
                let node = |first: NodeId, slot: usize| NodeId::new(first.index() + slot).ok();
                pairs.extend(node(first, own).zip(node(lead, other)));
            }
        }
    }
    pairs
}

/// Corners, in canonical order, of the edges and faces of the elements of these entities.
fn carried(
    elevated: &Elevated,
    boundary: &Boundary,
    dimension: u8,
    is_own: impl Fn(crate::mesh::EntityKey) -> bool,
) -> FxHashSet<Vec<NodeId>> {
    let sorted = |corners: &[NodeId]| -> Vec<NodeId> {
        canonical(corners)[..corners.len()].iter().map(|&q| corners[usize::from(q)]).collect()
    };
    let mut found = FxHashSet::default();
    if dimension == 2 {
        let faces = (0..boundary.faces.len()).filter(|&f| is_own(boundary.faces[f].entity));
        for face in faces {
            let corners = &boundary.corners[face];
            found.insert(sorted(corners));
            let edges = boundary.faces[face].cell.edges().iter();
            found.extend(edges.map(|&[a, b]| sorted(&[corners[usize::from(a)], corners[usize::from(b)]])));
        }
    }
    for (_, block) in elevated.mesh.blocks_of(1).filter(|(_, block)| is_own(block.entity)) {
        for nodes in block.elements(elevated.mesh.order) {
            found.insert(sorted(&nodes[..Cell::Line.corner_count()]));
        }
    }
    found
}

/// The linear pairs of two sets of nodes under the first of these maps that takes one onto the other, `(slave, master)`, with that map.
#[must_use]
pub fn matched(
    mesh: &Mesh,
    masters: &[NodeId],
    slaves: &[NodeId],
    maps: &[DAffine3],
) -> Option<(DAffine3, Vec<(NodeId, NodeId)>)> {
    if masters.len() != slaves.len() || masters.is_empty() {
        return None;
    }
    let slack = CONGRUENT * Aabb::of_points(mesh.points.iter().copied()).diagonal();
    let boxes: Vec<Aabb> = slaves.iter().map(|n| Aabb::of_points([mesh.points[n.index()]])).collect();
    let tree = cad::BoxTree::new(&boxes);
    maps.iter().find_map(|map| {
        let mut taken = FxHashSet::default();
        let pair = |&master: &NodeId| {
            let image = map.transform_point3(mesh.points[master.index()]);
            let distance = |leaf: usize| Some(mesh.points[slaves[leaf].index()].distance_squared(image));
            let found = tree.nearest(image, slack * slack, distance)?;
            taken.insert(found.leaf).then(|| (slaves[found.leaf], master))
        };
        let pairs: Option<Vec<_>> = masters.iter().map(pair).collect();
        pairs.map(|pairs| (*map, pairs))
    })
}
