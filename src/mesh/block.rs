//! Runs of elements.

use super::{EntityKey, NodeId};
use crate::element::{Cell, Order};

/// A run of elements of one cell on one entity.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Shape of all elements of the block.
    pub cell: Cell,
    /// The entity that the elements lie on.
    pub entity: EntityKey,
    /// Physical tags of the elements where the format gives them to elements rather than to entities (MSH 2.2).
    pub physical_tags: Vec<i32>,
    /// The file's element numbers.
    pub tags: Vec<u64>,
    /// Nodes, `cell.node_count(order)` an element, in internal (CGNS) order.
    pub nodes: Vec<NodeId>,
}

impl Block {
    /// A block that has no elements yet.
    #[must_use]
    pub fn new(cell: Cell, entity: EntityKey) -> Block {
        Block { cell, entity, physical_tags: Vec::new(), tags: Vec::new(), nodes: Vec::new() }
    }

    /// Nodes of an element: the chunk length of [`Block::nodes`].
    #[must_use]
    pub fn stride(&self, order: Order) -> usize {
        self.cell.node_count(order)
    }

    /// The elements' nodes, one slice an element.
    pub fn elements(&self, order: Order) -> impl ExactSizeIterator<Item = &[NodeId]> {
        self.nodes.chunks_exact(self.stride(order))
    }
}
