//! State of the nodes on the boundary.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use crate::associate::Classification;

/// A node on the boundary.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WallNode {
    /// What it lies on.
    pub classification: Classification,
    /// From its straight position to where it is put: on the CAD, or on the way back from it.
    pub displacement: DVec3,
    /// Size of the edge or face inside which it lies; of a linear node the shortest edge.
    pub size: Option<f64>,
    /// A linear node beyond the layers that may be curved.
    pub beyond_layers: bool,
}

/// A wall node that was taken off the CAD so that the elements around it are valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffCad {
    /// How far it is on its way from the fallback mesh to the CAD, from 0 to less than 1.
    pub fraction: f64,
    /// Its position on the CAD when it was taken off.
    on_cad: DVec3,
    /// Its displacement then.
    displacement: DVec3,
}

/// The nodes on the boundary; the only place where their state changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wall {
    /// By node, up to the last on the boundary (all nodes where layers are limited); those after are inside the volume.
    nodes: Vec<WallNode>,
    /// Nodes off the CAD, on their way from the fallback mesh.
    off_cad: BTreeMap<usize, OffCad>,
    /// Nodes that are not held on the CAD, but drawn to their place there.
    released: BTreeSet<usize>,
    /// Those of them that stay where they are for now.
    held: BTreeSet<usize>,
    /// How many closest points were asked for to place nodes.
    pub queries: usize,
    /// How many of them are not proven to be the closest.
    pub unproven: usize,
}

impl Wall {
    /// Boundary nodes at their straight positions; the linear ones lie on what the association says.
    #[must_use]
    pub fn new(linear: &[Classification], boundary_nodes: usize) -> Wall {
        let mut nodes = vec![WallNode::default(); boundary_nodes];
        for (node, &classification) in nodes.iter_mut().zip(linear) {
            node.classification = classification;
        }
        Wall { nodes, ..Wall::default() }
    }

    /// Number of nodes whose state is kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no boundary.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// What any node lies on.
    #[must_use]
    pub fn classification(&self, node: usize) -> Classification {
        self.nodes.get(node).map_or(Classification::Free, |own| own.classification)
    }

    /// The displacement of any node by the wall itself; zero inside the volume.
    #[must_use]
    pub fn displacement(&self, node: usize) -> DVec3 {
        self.nodes.get(node).map_or(DVec3::ZERO, |own| own.displacement)
    }

    /// Displacements of all nodes whose state is kept.
    #[must_use]
    pub fn displacements(&self) -> Vec<DVec3> {
        self.nodes.iter().map(|own| own.displacement).collect()
    }

    /// Size of the edge or face inside which a node lies; of a linear node the shortest edge.
    #[must_use]
    pub fn size(&self, node: usize) -> Option<f64> {
        self.nodes.get(node)?.size
    }

    /// Whether a linear node is beyond the layers that may be curved.
    #[must_use]
    pub fn is_beyond_layers(&self, node: usize) -> bool {
        self.nodes.get(node).is_some_and(|own| own.beyond_layers)
    }

    /// Says what a new node lies on, and the size of its edge or face.
    pub fn classify(&mut self, node: usize, classification: Classification, size: f64) {
        if let Some(own) = self.nodes.get_mut(node) {
            own.classification = classification;
            own.size = Some(size);
        }
    }

    /// Tells a linear node of an edge of this length at it.
    pub fn meets_edge(&mut self, node: usize, length: f64) {
        if let Some(own) = self.nodes.get_mut(node) {
            own.size = Some(own.size.map_or(length, |size| size.min(length)));
        }
    }

    /// Displaces a boundary node.
    pub fn displace(&mut self, node: usize, displacement: DVec3) {
        if let Some(own) = self.nodes.get_mut(node) {
            own.displacement = displacement;
        }
    }

    /// Displaces all boundary nodes, as [`Wall::displacements`] lists them.
    pub fn displace_all(&mut self, displacements: &[DVec3]) {
        self.nodes.iter_mut().zip(displacements).for_each(|(own, &displacement)| own.displacement = displacement);
    }

    /// Counts closest points that were asked for, and those of them that are not proven.
    pub fn count_queries(&mut self, queries: usize, unproven: usize) {
        self.queries += queries;
        self.unproven += unproven;
    }

    /// Keeps nodes straight that are beyond the layers which may be curved, volume nodes among them; `beyond` tells it of all nodes of
    /// the mesh, the first `linear_nodes` of which are the linear ones.
    pub fn keep_straight(&mut self, beyond: &[bool], linear_nodes: usize) {
        self.nodes.resize(beyond.len(), WallNode::default());
        for (n, (own, _)) in self.nodes.iter_mut().zip(beyond).enumerate().filter(|(_, (_, beyond))| **beyond) {
            own.classification = Classification::Straight;
            own.displacement = DVec3::ZERO;
            own.beyond_layers = n < linear_nodes;
        }
    }

    /// Whether every node is on the CAD.
    #[must_use]
    pub fn is_on_cad(&self) -> bool {
        self.off_cad.is_empty() && self.released.is_empty()
    }

    /// Whether every node that is off the CAD is a released one.
    #[must_use]
    pub fn is_all_the_way(&self) -> bool {
        self.off_cad.is_empty()
    }

    /// Lets a node leave the CAD.
    pub fn release(&mut self, node: usize) {
        self.released.insert(node);
    }

    /// Holds a released node on the CAD again.
    pub fn reattach(&mut self, node: usize) {
        self.released.remove(&node);
    }

    /// Holds released nodes where they are, and no others.
    pub fn hold(&mut self, nodes: &[usize]) {
        self.held = nodes.iter().copied().collect();
    }

    /// Whether a released node stays where it is.
    #[must_use]
    pub fn is_held(&self, node: usize) -> bool {
        self.held.contains(&node)
    }

    /// Nodes that may leave the CAD, rising.
    pub fn released(&self) -> impl Iterator<Item = usize> + '_ {
        self.released.iter().copied()
    }

    /// Whether a node may leave the CAD.
    #[must_use]
    pub fn is_released(&self, node: usize) -> bool {
        self.released.contains(&node)
    }

    /// How far any node is on its way from the fallback mesh to the CAD; 1 on the CAD.
    #[must_use]
    pub fn fraction(&self, node: usize) -> f64 {
        self.off_cad.get(&node).map_or(1.0, |off| off.fraction)
    }

    /// Nodes that were taken back, rising, and how far each is on its way to the CAD.
    pub fn off_cad(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.off_cad.iter().map(|(&node, off)| (node, off.fraction))
    }

    /// Takes a node that stands at `position` back, to this fraction of where it is on its way. It stays where it is until
    /// [`Wall::place`] is asked.
    pub fn take_back(&mut self, node: usize, fraction: f64, position: DVec3) {
        let Some(own) = self.nodes.get(node) else { return };
        let on_cad = OffCad { fraction: 1.0, on_cad: position, displacement: own.displacement };
        self.off_cad.entry(node).or_insert(on_cad).fraction *= fraction;
    }

    /// Takes a node this fraction of what is left of its way towards the CAD.
    pub fn advance(&mut self, node: usize, fraction: f64) {
        if let Some(off) = self.off_cad.get_mut(&node) {
            off.fraction += fraction * (1.0 - off.fraction);
        }
    }

    /// Displaces a node that is off the CAD to where it is on its way from `fallback`, its position in the fallback mesh; returns its
    /// position, `None` for a node that is on the CAD.
    pub fn place(&mut self, node: usize, fallback: DVec3, straight: DVec3) -> Option<DVec3> {
        let off = *self.off_cad.get(&node)?;
        let between = |back: DVec3, goal: DVec3| if off.fraction < 1.0 { back.lerp(goal, off.fraction) } else { goal };
        self.displace(node, between(fallback - straight, off.displacement));
        if off.fraction >= 1.0 {
            self.off_cad.remove(&node);
        }
        Some(between(fallback, off.on_cad))
    }
}
