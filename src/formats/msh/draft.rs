//! The mesh while its file is being read.

use std::collections::HashMap;

use glam::DVec3;

use super::fault::MshFault;
use super::node_order::ORDER;
use super::node_tags::NodeTags;
use super::source::Source;
use super::type_code::{self, Type};
use crate::element::{Cell, Order};
use crate::formats::error::{Fault, Flaw};
use crate::mesh::{EntityKey, Inconsistent, Mesh, NodeId, Parts};

/// What has been read so far.
#[derive(Default)]
pub(super) struct Draft {
    pub(super) parts: Parts,
    /// The order that the first element fixed.
    order: Option<Order>,
    /// Present once the nodes have been read.
    node_tags: Option<NodeTags>,
    /// Entities of a partitioned mesh and the entities that they are parts of.
    pub(super) parents: HashMap<EntityKey, EntityKey>,
}

/// What a Gmsh element number means, with the permutation of its nodes.
#[derive(Clone, Copy)]
pub(super) struct ElementType {
    pub(super) cell: Cell,
    slots: &'static [u8],
}

impl ElementType {
    /// Number of nodes.
    pub(super) fn node_count(self) -> usize {
        self.slots.len()
    }
}

/// Sections of Gmsh's that say nothing of the mesh.
const BESIDE: [&str; 7] = [
    "Comments",
    "NodeData",
    "ElementData",
    "ElementNodeData",
    "InterpolationScheme",
    "GhostElements",
    "Parametrizations",
];

impl Draft {
    /// Notes a section that is not read, unless it is known to say nothing of the mesh: it may be one of those that are, misspelt.
    pub(super) fn pass_over(&mut self, section: &str) {
        if !BESIDE.contains(&section) {
            let name: String = section.chars().take(40).collect();
            self.parts.notes.push(format!("a section ${name}, which is not known, is not used"));
        }
    }

    /// The entity of the unpartitioned mesh.
    pub(super) fn parent(&self, key: EntityKey) -> EntityKey {
        self.parents.get(&key).copied().unwrap_or(key)
    }

    /// Adds a node.
    pub(super) fn push_node(
        &mut self,
        source: &impl Source,
        tag: u64,
        point: [f64; 3],
        entity: Option<EntityKey>,
    ) -> Result<NodeId, Flaw> {
        if tag == 0 {
            return Err(source.flaw(MshFault::ZeroNode));
        }
        if !point.iter().all(|x| x.is_finite()) {
            return Err(source.flaw(Fault::NotFinite(tag)));
        }
        let node = NodeId::new(self.parts.points.len()).map_err(|e| source.flaw(e))?;
        self.parts.points.push(DVec3::from_array(point));
        self.parts.node_tags.push(tag);
        self.parts.node_entities.push(entity);
        Ok(node)
    }

    /// Adds the parameters of the node just added.
    pub(super) fn push_parameters(&mut self, source: &impl Source, node: NodeId, uv: [f64; 2]) -> Result<(), Flaw> {
        if !uv.iter().all(|x| x.is_finite()) {
            return Err(source.flaw(Fault::NotFinite(self.parts.node_tags[node.index()])));
        }
        self.parts.node_parameters.push((node, uv));
        Ok(())
    }

    /// Closes the list of nodes: from here on they can be looked up.
    pub(super) fn end_nodes(&mut self, source: &impl Source) -> Result<(), Flaw> {
        let table = NodeTags::new(&self.parts.node_tags).map_err(|fault| source.flaw(fault))?;
        self.node_tags = Some(table);
        Ok(())
    }

    /// Whether the nodes have been read.
    pub(super) fn has_nodes(&self) -> bool {
        self.node_tags.is_some()
    }

    /// The node of a number that `what` number `by` refers to.
    pub(super) fn node(&self, source: &impl Source, tag: u64, what: &'static str, by: u64) -> Result<NodeId, Flaw> {
        match self.node_tags.as_ref().and_then(|tags| tags.get(tag)) {
            Some(node) => Ok(node),
            None => Err(source.flaw(MshFault::UnknownNode { what, by, node: tag })),
        }
    }

    /// The element that a Gmsh number means; fixes the order of the mesh, or compares with it.
    pub(super) fn element_type(&mut self, source: &impl Source, code: i32) -> Result<ElementType, Flaw> {
        let (cell, order) = match type_code::meaning(code) {
            Some(Type::Complete(cell, order)) => (cell, order),
            Some(Type::Incomplete) => return Err(source.flaw(MshFault::IncompleteElementType(code))),
            Some(Type::TooHigh) => return Err(source.flaw(MshFault::OrderTooHigh(code))),
            None => return Err(source.flaw(MshFault::UnknownElementType(code))),
        };
        let slots = ORDER.slots(cell, order).unwrap_or_default();
        if cell != Cell::Point {
            let mesh = *self.order.get_or_insert(order);
            if mesh != order {
                return Err(source.flaw(Fault::MixedOrders { order: mesh, here: order }));
            }
        }
        Ok(ElementType { cell, slots })
    }

    /// Appends the nodes of element `tag`, given by file numbers in file order, in internal order.
    pub(super) fn push_element(
        &self,
        source: &impl Source,
        kind: ElementType,
        tag: u64,
        numbers: &[u64],
        nodes: &mut Vec<NodeId>,
    ) -> Result<(), Flaw> {
        let base = nodes.len();
        nodes.resize(base + numbers.len(), NodeId::default());
        for (&slot, &number) in kind.slots.iter().zip(numbers) {
            nodes[base + usize::from(slot)] = self.node(source, number, "element", tag)?;
        }
        Ok(())
    }

    /// The finished mesh.
    pub(super) fn finish(mut self) -> Result<Mesh, Inconsistent> {
        self.parts.order = self.order.unwrap_or_default();
        Mesh::new(self.parts)
    }
}
