//! Parts of the active elements that share no node. Each descends on its own: one step length for all would let a spot that cannot be
//! mended stop those that can.

use rustc_hash::FxHashMap;

use super::{Image, Problem};
use crate::mesh::{ElementId, NodeId};

/// The connected components of `active` (rising): elements that share a node, or nodes that are images of one another, are in one. Each is
/// rising, and they are in the order of their first elements.
pub(super) fn components(problem: &Problem, active: &[ElementId], images: &[Image]) -> Vec<Vec<ElementId>> {
    let mut joined = Joined { parents: FxHashMap::default() };
    for &e in active {
        let nodes = problem.nodes(e);
        nodes[1..].iter().for_each(|&node| joined.join(nodes[0], node));
    }
    for Image { node, of, .. } in images {
        if joined.parents.contains_key(node) && joined.parents.contains_key(of) {
            joined.join(*node, *of);
        }
    }
    let mut numbers: FxHashMap<NodeId, usize> = FxHashMap::default();
    let mut components: Vec<Vec<ElementId>> = Vec::new();
    for &e in active {
        let next = numbers.len();
        let number = *numbers.entry(joined.root(problem.nodes(e)[0])).or_insert(next);
        if number == components.len() {
            components.push(Vec::new());
        }
        components[number].push(e);
    }
    components
}

/// Which nodes are joined (union-find with path halving).
struct Joined {
    parents: FxHashMap<NodeId, NodeId>,
}

impl Joined {
    fn root(&mut self, node: NodeId) -> NodeId {
        let mut node = node;
        loop {
            let parent = *self.parents.entry(node).or_insert(node);
            if parent == node {
                return node;
            }
            let above = *self.parents.entry(parent).or_insert(parent);
            self.parents.insert(node, above);
            node = above;
        }
    }

    fn join(&mut self, a: NodeId, b: NodeId) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.parents.insert(a.max(b), a.min(b));
        }
    }
}
