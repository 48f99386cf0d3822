//! Connected components of some elements of a mesh.

use rustc_hash::FxHashMap;

use super::{ElementId, Elements, NodeId};

/// The connected components of `some` elements (rising): those that share a node, or have nodes that are `tied` to one another, are in
/// one. Each is rising, and they are in the order of their first elements.
pub(crate) fn components(
    elements: &Elements,
    some: &[ElementId],
    tied: impl Iterator<Item = [NodeId; 2]>,
) -> Vec<Vec<ElementId>> {
    let lists = some.iter().map(|&e| elements.nodes(e));
    connected(lists, tied).into_iter().map(|own| own.into_iter().map(|place| some[place]).collect()).collect()
}

/// The connected components of lists of nodes, by the places of the lists: those that share a node, or have nodes that are `tied` to one
/// another, are in one.
pub(super) fn connected<'n>(
    lists: impl Iterator<Item = &'n [NodeId]> + Clone,
    tied: impl Iterator<Item = [NodeId; 2]>,
) -> Vec<Vec<usize>> {
    let mut joined = Joined { parents: FxHashMap::default() };
    for nodes in lists.clone() {
        nodes[1..].iter().for_each(|&node| joined.join(nodes[0], node));
    }
    for [a, b] in tied {
        if joined.parents.contains_key(&a) && joined.parents.contains_key(&b) {
            joined.join(a, b);
        }
    }
    let mut numbers: FxHashMap<NodeId, usize> = FxHashMap::default();
    let mut components: Vec<Vec<usize>> = Vec::new();
    for (place, nodes) in lists.enumerate() {
        let next = numbers.len();
        let number = *numbers.entry(joined.root(nodes[0])).or_insert(next);
        if number == components.len() {
            components.push(Vec::new());
        }
        components[number].push(place);
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
