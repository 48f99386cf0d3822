//! The part of the mesh that is being smoothed: active elements, their nodes, and who owns what.

use glam::{DAffine3, DVec3};

use super::view::View;
use super::{Image, Problem};
use crate::element::Cell;
use crate::mesh::{ElementId, Incidence, NodeId};

/// Elements of one cell and survey density in a patch; their nodes' slots follow each other.
pub(super) struct Run {
    pub(super) cell: Cell,
    /// Which survey they are looked at with.
    pub(super) density: u8,
    /// Nodes an element.
    pub(super) stride: usize,
    /// First element of the run in [`Patch::elements`].
    pub(super) first: usize,
    pub(super) count: usize,
    /// First slot of the run in [`Patch::slots`].
    pub(super) slot: usize,
}

/// Active elements with compact node numbers.
pub(super) struct Patch {
    /// The elements, by run.
    pub(super) elements: Vec<ElementId>,
    pub(super) runs: Vec<Run>,
    /// Patch node of every element's every node.
    pub(super) slots: Vec<u32>,
    /// The mesh's nodes.
    pub(super) nodes: Vec<NodeId>,
    /// Whether all elements around the node, and around its images, are in the patch, so that it may move.
    pub(super) movable: Vec<bool>,
    /// Nodes that are images of others, those others, and the maps.
    pub(super) periodic: Vec<(usize, usize, DAffine3)>,
    /// Slots of each node's appearances in elements, rising.
    incident: Incidence<u32>,
    /// Straight positions of the nodes.
    pub(super) targets: Vec<DVec3>,
    /// Where the elements are looked at from.
    pub(super) view: View,
}

impl Patch {
    /// The patch of the elements that `active` names (rising), with every element's survey density. `local` has an entry for each node
    /// of the mesh, `u32::MAX`, before and after.
    pub(super) fn new(
        problem: &Problem,
        active: &[ElementId],
        density: &[u8],
        images: &[Image],
        local: &mut [u32],
    ) -> Patch {
        let mut runs: Vec<Run> = Vec::new();
        let mut elements: Vec<ElementId> = active.to_vec();
        elements.sort_by_key(|&e| (problem.cell(e), density[e.index()], e));
        let (mut nodes, mut slots) = (Vec::<NodeId>::new(), Vec::<u32>::new());
        for (place, &e) in elements.iter().enumerate() {
            let (cell, own, density) = (problem.cell(e), problem.nodes(e), density[e.index()]);
            match runs.last_mut() {
                Some(run) if run.cell == cell && run.density == density => run.count += 1,
                _ => runs.push(Run { cell, density, stride: own.len(), first: place, count: 1, slot: slots.len() }),
            }
            for &node in own {
                let index = &mut local[node.index()];
                if *index == u32::MAX {
                    *index = nodes.len() as u32;
                    nodes.push(node);
                }
                slots.push(*index);
            }
        }
        let incident = Incidence::new(nodes.len(), slots.iter().map(|&node| node as usize).zip(0..));
        let complete = |i: usize| incident.at(i).len() == problem.valence(nodes[i]);
        let mut movable: Vec<bool> = (0..nodes.len()).map(complete).collect();
        let periodic = periodic(images, local, &mut movable);
        nodes.iter().for_each(|node| local[node.index()] = u32::MAX);
        let targets = nodes.iter().map(|n| problem.straight[n.index()]).collect();
        Patch { elements, runs, slots, nodes, movable, periodic, incident, targets, view: problem.view }
    }

    /// Slots of a node's appearances in elements, rising.
    pub(super) fn incident(&self, node: usize) -> &[u32] {
        self.incident.at(node)
    }
}

/// The images among the patch's nodes, by `local` number; a node moves only where all that move with it can.
fn periodic(images: &[Image], local: &[u32], movable: &mut [bool]) -> Vec<(usize, usize, DAffine3)> {
    let own = |node: NodeId| Some(local[node.index()]).filter(|&n| n != u32::MAX).map(|n| n as usize);
    let found: Vec<_> = images.iter().map(|image| (own(image.node), own(image.of), image.map)).collect();
    for _ in 0..2 {
        for &(node, of, _) in &found {
            let both = [node, of].iter().all(|n| n.is_some_and(|n| movable[n]));
            [node, of].into_iter().flatten().for_each(|n| movable[n] = both);
        }
    }
    found.into_iter().filter_map(|(node, of, map)| Some((node?, of?, map))).collect()
}
