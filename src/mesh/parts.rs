//! What a mesh is made of, as readers put it together.

use glam::DVec3;
use rayon::prelude::*;

use super::{Block, Condition, Entity, EntityKey, NodeId, Periodic, PhysicalName, TooMany, Zone};
use crate::element::{Cell, Order};

/// The parts of a [`Mesh`](super::Mesh).
///
/// Nodes and elements keep the order and the numbers of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// Order of every element.
    pub order: Order,
    /// Coordinates, in the file's unit.
    pub points: Vec<DVec3>,
    /// The file's number of each node; unique, positive, possibly sparse. Left empty they count from 1.
    pub node_tags: Vec<u64>,
    /// The entity of lowest dimension that each node is classified on (MSH 4.1); `None` where the file does not say. May be
    /// left empty.
    pub node_entities: Vec<Option<EntityKey>>,
    /// Parameters of nodes on their entity, where the file gives them: `(node, u, v)`; curves have `v = 0`.
    pub node_parameters: Vec<(NodeId, [f64; 2])>,
    /// Elements, in file order.
    pub blocks: Vec<Block>,
    /// What the file says of its entities.
    pub entities: Vec<Entity>,
    /// Names of physical groups.
    pub physical_names: Vec<PhysicalName>,
    /// Pairs of entities whose nodes correspond.
    pub periodic: Vec<Periodic>,
    /// Boundary conditions, where the file names them apart from the groups (CGNS, UGRID).
    pub conditions: Vec<Condition>,
    /// Parts whose nodes the file numbers each from 1 (CGNS, PLOT3D); empty where there is one such part, as `node_tags`
    /// are its numbers then.
    pub zones: Vec<Zone>,
    /// What reading changed or left out.
    pub notes: Vec<String>,
}

/// Why parts make no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Inconsistent {
    /// More nodes or elements than can be numbered.
    #[error(transparent)]
    TooMany(#[from] TooMany),
    /// A list of node values that has not one for every node.
    #[error("{found} {what} for {nodes} nodes")]
    Values {
        /// What the list holds.
        what: &'static str,
        /// Its length.
        found: usize,
        /// Number of nodes.
        nodes: usize,
    },
    /// A block whose nodes are not those of its elements.
    #[error("block {block}: {found} nodes for {elements} elements of {stride} each")]
    Nodes {
        /// Its place in [`Parts::blocks`].
        block: usize,
        /// Length of its connectivity.
        found: usize,
        /// Number of element tags.
        elements: usize,
        /// Nodes an element.
        stride: usize,
    },
    /// A node number beyond the points.
    #[error("{what} refer to node {node}, and there are {nodes} nodes")]
    UnknownNode {
        /// What has the number.
        what: &'static str,
        /// The number, counted from 0.
        node: usize,
        /// Number of nodes.
        nodes: usize,
    },
}

impl Parts {
    /// Adds an element, numbered one more than the elements so far, to the block of its kind on its entity.
    pub fn push(&mut self, cell: Cell, entity: EntityKey, nodes: &[NodeId]) {
        let tag = 1 + self.blocks.iter().map(|block| block.tags.len() as u64).sum::<u64>();
        let known = self.blocks.iter().position(|block| block.entity == entity && block.cell == cell);
        let place = known.unwrap_or_else(|| {
            self.blocks.push(Block::new(cell, entity));
            self.blocks.len() - 1
        });
        self.blocks[place].tags.push(tag);
        self.blocks[place].nodes.extend_from_slice(nodes);
    }

    /// Fills in what may be left empty, and holds the parts against each other.
    pub(super) fn complete(&mut self) -> Result<(), Inconsistent> {
        let nodes = self.points.len();
        NodeId::new(nodes)?;
        if self.node_tags.is_empty() {
            self.node_tags = (1..=nodes as u64).collect();
        }
        if self.node_entities.is_empty() {
            self.node_entities = vec![None; nodes];
        }
        for (what, found) in [("node numbers", self.node_tags.len()), ("node entities", self.node_entities.len())] {
            if found != nodes {
                return Err(Inconsistent::Values { what, found, nodes });
            }
        }
        for (place, block) in self.blocks.iter().enumerate() {
            let (found, elements, stride) = (block.nodes.len(), block.tags.len(), block.stride(self.order));
            if found != elements * stride {
                return Err(Inconsistent::Nodes { block: place, found, elements, stride });
            }
        }
        let elements = self.blocks.iter().map(|block| block.tags.len()).sum();
        super::ElementId::new(elements)?;
        let beyond = |what, largest: Option<NodeId>| match largest.map(NodeId::index).filter(|&node| node >= nodes) {
            Some(node) => Err(Inconsistent::UnknownNode { what, node, nodes }),
            None => Ok(()),
        };
        for block in &self.blocks {
            beyond("elements", block.nodes.par_iter().copied().max())?;
        }
        beyond("node parameters", self.node_parameters.iter().map(|&(node, _)| node).max())?;
        beyond("periodic pairs", self.periodic.iter().flat_map(|own| &own.pairs).map(|&(a, b)| a.max(b)).max())?;
        beyond("zones", self.zones.iter().filter_map(|zone| zone.nodes.par_iter().copied().max()).max())
    }
}
