//! Periodic patches: nodes of one side are images of nodes of the other, and stay so.
//!
//! Only the master's nodes are projected, carried and smoothed on their own; the slave's are set to their images, wherever nodes move.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::element::{Cell, interior_slots};
use crate::mesh::elevate::Elevated;
use crate::mesh::periodic::map_of;
use crate::mesh::{EntityKey, FaceKey, Mesh, NodeId, Periodic};
use crate::smooth::Image;

/// Nodes that are images of others.
#[derive(Clone, Debug, Default)]
pub struct PeriodicConstraint {
    images: Vec<Image>,
}

impl PeriodicConstraint {
    /// The constraint of an elevated mesh, whose periodic pairs are extended to the new nodes. With `freeze_linear` linear nodes are not
    /// constrained.
    ///
    /// Returns what a user should know of pairs that are none.
    #[must_use]
    pub fn new(elevated: &mut Elevated, freeze_linear: bool) -> (PeriodicConstraint, Vec<String>) {
        let mut notes = Vec::new();
        let mut leads: BTreeMap<NodeId, (NodeId, DAffine3)> = BTreeMap::new();
        let mut records = std::mem::take(elevated.mesh.periodic_mut());
        for record in &mut records {
            let Some(map) = map_of(&elevated.mesh, record) else {
                let Periodic { slave, master, .. } = record;
                notes.push(format!(
                    "{slave} does not correspond to {master} under its transform; they are not kept periodic"
                ));
                continue;
            };
            record.pairs.extend(new_pairs(elevated, record));
            for &(slave, master) in &record.pairs {
                let linear = slave.index() < elevated.linear_nodes;
                if slave != master && !(linear && freeze_linear) && root(&leads, master).0 != slave {
                    leads.entry(slave).or_insert((master, map));
                }
            }
        }
        // One entity on both sides is a pair of patches that the file cannot tell apart.
        records.retain(|record| record.slave.tag != record.master);
        *elevated.mesh.periodic_mut() = records;
        let images: Vec<_> = leads.keys().map(|&slave| (slave, root(&leads, slave))).collect();
        let images = images.into_iter().map(|(node, (of, map))| Image { node, of, map }).collect();
        (PeriodicConstraint { images }, notes)
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

/// The pairs of new nodes, on edges and faces of the slave entity.
fn new_pairs(elevated: &Elevated, record: &Periodic) -> Vec<(NodeId, NodeId)> {
    let masters: FxHashMap<NodeId, NodeId> = record.pairs.iter().copied().collect();
    let own = carried(&elevated.mesh, record.slave);
    let mut pairs = Vec::new();
    for cell in [Cell::Line, Cell::Triangle, Cell::Quad] {
        let carriers = &elevated.carriers[cell as usize];
        let on_boundary = || carriers.iter().take_while(|(_, first)| first.index() < elevated.boundary_nodes);
        let known: FxHashMap<FaceKey, NodeId> =
            on_boundary().map(|(corners, first)| (FaceKey::new(corners), first)).collect();
        for (corners, first) in on_boundary().filter(|(corners, _)| own.contains(&FaceKey::new(corners))) {
            let Some(images) = corners.iter().map(|n| masters.get(n).copied()).collect::<Option<Vec<_>>>() else {
                continue;
            };
            let (key, seen) = FaceKey::seen(&images);
            let Some(&lead) = known.get(&key) else { continue };
            for (own, other) in interior_slots(cell, elevated.mesh.order(), seen).into_iter().enumerate() {
                let node = |first: NodeId, slot: usize| NodeId::new(first.index() + slot).ok();
                pairs.extend(node(first, own).zip(node(lead, other)));
            }
        }
    }
    pairs
}

/// The edges and faces of the elements on an entity.
fn carried(mesh: &Mesh, entity: EntityKey) -> FxHashSet<FaceKey> {
    let mut found = FxHashSet::default();
    for cell in [Cell::Line, Cell::Triangle, Cell::Quad] {
        for element in mesh.elements_of(cell).iter().filter(|own| own.entity == entity) {
            found.insert(FaceKey::new(element.corners()));
            found.extend(element.sides());
        }
    }
    found
}
