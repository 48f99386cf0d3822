//! Meshes of order 1 to 4, as they stand in files: points, blocks of elements, entities and their names.

mod boundary;
mod condition;
pub mod elevate;
mod entity;
mod ids;
pub mod periodic;
mod zone;

use glam::DVec3;

pub use boundary::{Boundary, BoundaryFace};
pub use condition::Condition;
pub use entity::{Entity, EntityKey, Periodic, PhysicalName};
pub use ids::{ElementId, NodeId, TooMany};
pub use zone::Zone;

use crate::element::{Cell, Order};

/// A mesh of one polynomial order.
///
/// Nodes and elements keep the order and the numbers of the file. An elevated mesh is the same type: its first
/// points are the linear mesh's, its blocks those of the linear mesh with longer connectivity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Order of every element.
    pub order: Order,
    /// Coordinates, in the file's unit.
    pub points: Vec<DVec3>,
    /// The file's number of each node; unique, positive, possibly sparse.
    pub node_tags: Vec<u64>,
    /// The entity of lowest dimension that each node is classified on (MSH 4.1); `None` where the file does not say.
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

impl Mesh {
    /// Number of elements of the given dimension.
    #[must_use]
    pub fn element_count(&self, dimension: usize) -> usize {
        self.blocks.iter().filter(|b| b.cell.dimension() == dimension).map(|b| b.tags.len()).sum()
    }

    /// Blocks of the given dimension, with their place in [`Mesh::blocks`].
    pub fn blocks_of(&self, dimension: usize) -> impl Iterator<Item = (usize, &Block)> {
        self.blocks.iter().enumerate().filter(move |(_, b)| b.cell.dimension() == dimension)
    }

    /// Tags of the physical groups that an entity's elements belong to, each once; a negative one means reversed orientation.
    #[must_use]
    pub fn physical_tags_of(&self, entity: EntityKey) -> Vec<i32> {
        let of_entity = self.entities.iter().filter(|e| e.key == entity).flat_map(|e| &e.physical_tags);
        let of_blocks = self.blocks.iter().filter(|b| b.entity == entity).flat_map(|b| &b.physical_tags);
        let mut tags: Vec<i32> = Vec::new();
        for &tag in of_entity.chain(of_blocks) {
            if !tags.contains(&tag) {
                tags.push(tag);
            }
        }
        tags
    }

    /// Names of the physical groups that an entity's elements belong to, each once.
    #[must_use]
    pub fn names_of(&self, entity: EntityKey) -> Vec<String> {
        let mut names = Vec::new();
        for tag in self.physical_tags_of(entity) {
            let known = self.physical_names.iter().find(|n| n.dimension == entity.dimension && n.tag == tag.abs());
            if let Some(known) = known.filter(|known| !names.contains(&known.name)) {
                names.push(known.name.clone());
            }
        }
        names
    }

    /// What people call an entity: its physical names, else its dimension and number.
    #[must_use]
    pub fn label(&self, entity: EntityKey) -> String {
        let names = self.names_of(entity);
        if names.is_empty() { entity.to_string() } else { names.join(",") }
    }

    /// The points of an element.
    pub fn points_of<'a>(&'a self, nodes: &'a [NodeId]) -> impl ExactSizeIterator<Item = DVec3> + 'a {
        nodes.iter().map(|&n| self.points[n.index()])
    }
}
