//! The best state of all rounds.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::patch::Patch;
use super::{ElementCost, Summary};
use crate::mesh::ElementId;

/// The best state so far, as its difference from the present one: most nodes never move.
pub(super) struct Best {
    pub(super) summary: Summary,
    pub(super) places: FxHashMap<u32, DVec3>,
    pub(super) costs: FxHashMap<ElementId, ElementCost>,
}

impl Best {
    /// The present state is the best.
    pub(super) fn is_now(summary: Summary) -> Best {
        Best { summary, places: FxHashMap::default(), costs: FxHashMap::default() }
    }

    /// Notes what the nodes and elements of a patch are before they change.
    pub(super) fn note(&mut self, patch: &Patch, x: &[DVec3], costs: &[ElementCost]) {
        for (&node, _) in patch.nodes.iter().zip(&patch.movable).filter(|(_, movable)| **movable) {
            self.places.entry(node.index() as u32).or_insert(x[node.index()]);
        }
        for &e in &patch.elements {
            self.costs.entry(e).or_insert(costs[e.index()]);
        }
    }

    /// Puts the best state in the place of the present one.
    pub(super) fn restore(&mut self, x: &mut [DVec3], costs: &mut [ElementCost]) {
        self.places.drain().for_each(|(node, place)| x[node as usize] = place);
        self.costs.drain().for_each(|(e, cost)| costs[e.index()] = cost);
    }
}
