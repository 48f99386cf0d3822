//! Meshes of order 1 to 4, as they stand in files: points, blocks of elements, entities and their names.

mod block;
mod boundary;
mod components;
mod condition;
mod elements;
pub mod elevate;
mod entity;
mod face_key;
mod ids;
mod incidence;
mod linear_positions;
mod parts;
pub mod periodic;
mod plane;
mod skin;
mod zone;

use std::collections::BTreeMap;

use glam::DVec3;

pub use block::Block;
pub use boundary::{Boundary, BoundaryFace};
pub(crate) use components::components;
pub use condition::Condition;
pub use elements::{Element, Elements};
pub use entity::{Entity, EntityKey, Periodic, PhysicalName};
pub use face_key::FaceKey;
pub use ids::{ElementId, NodeId, TooMany};
pub use incidence::Incidence;
pub use linear_positions::{NotItsLinear, linear_positions};
pub use parts::{Inconsistent, Parts};
pub use plane::Plane;
pub use skin::Skin;
pub use zone::Zone;

use crate::element::{Cell, Order};

/// A mesh of one polynomial order: [`Parts`] that fit each other.
///
/// Nodes and elements keep the order and the numbers of the file. An elevated mesh is the same type: its first
/// points are the linear mesh's, its blocks those of the linear mesh with longer connectivity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    parts: Parts,
}

impl Mesh {
    /// A mesh of parts that fit each other.
    ///
    /// # Errors
    /// [`Inconsistent`] where a list is too long or too short, or a node number is beyond the points.
    pub fn new(mut parts: Parts) -> Result<Mesh, Inconsistent> {
        parts.complete()?;
        Ok(Mesh { parts })
    }

    /// What the mesh is made of, to be changed and put together again.
    #[must_use]
    pub fn into_parts(self) -> Parts {
        self.parts
    }

    /// Order of every element.
    #[must_use]
    pub fn order(&self) -> Order {
        self.parts.order
    }

    /// Coordinates of the nodes, in the file's unit.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.parts.points
    }

    /// Coordinates of the nodes, to be changed in place.
    pub fn points_mut(&mut self) -> &mut [DVec3] {
        &mut self.parts.points
    }

    /// The file's number of each node; unique, positive, possibly sparse.
    #[must_use]
    pub fn node_tags(&self) -> &[u64] {
        &self.parts.node_tags
    }

    /// The entity of lowest dimension that each node is classified on (MSH 4.1); `None` where the file does not say.
    #[must_use]
    pub fn node_entities(&self) -> &[Option<EntityKey>] {
        &self.parts.node_entities
    }

    /// Parameters of nodes on their entity, where the file gives them: `(node, u, v)`; curves have `v = 0`.
    #[must_use]
    pub fn node_parameters(&self) -> &[(NodeId, [f64; 2])] {
        &self.parts.node_parameters
    }

    /// Elements of every dimension, in file order.
    #[must_use]
    pub fn blocks(&self) -> &[Block] {
        &self.parts.blocks
    }

    /// What the file says of its entities.
    #[must_use]
    pub fn entities(&self) -> &[Entity] {
        &self.parts.entities
    }

    /// Names of physical groups.
    #[must_use]
    pub fn physical_names(&self) -> &[PhysicalName] {
        &self.parts.physical_names
    }

    /// Pairs of entities whose nodes correspond.
    #[must_use]
    pub fn periodic(&self) -> &[Periodic] {
        &self.parts.periodic
    }

    /// Pairs of entities, to be added to or taken out; their nodes must be nodes of the mesh.
    #[cfg(feature = "cad")] // only curving finds pairs that no file names
    pub(crate) fn periodic_mut(&mut self) -> &mut Vec<Periodic> {
        &mut self.parts.periodic
    }

    /// Boundary conditions, where the file names them apart from the groups (CGNS, UGRID).
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.parts.conditions
    }

    /// Parts whose nodes the file numbers each from 1 (CGNS, PLOT3D); none where there is one such part.
    #[must_use]
    pub fn zones(&self) -> &[Zone] {
        &self.parts.zones
    }

    /// What reading changed or left out.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.parts.notes
    }

    /// Names of groups and conditions, to be changed in place.
    pub(crate) fn names_mut(&mut self) -> impl Iterator<Item = &mut String> {
        let groups = self.parts.physical_names.iter_mut().map(|group| &mut group.name);
        groups.chain(self.parts.conditions.iter_mut().map(|condition| &mut condition.name))
    }

    /// Adds a note of what reading found.
    pub(crate) fn note(&mut self, note: String) {
        self.parts.notes.push(note);
    }

    /// The largest dimension of an element, 0 to 3: that of the mesh's cells.
    #[must_use]
    pub fn dimension(&self) -> usize {
        let with_elements = self.parts.blocks.iter().filter(|block| !block.tags.is_empty());
        with_elements.map(|block| block.cell.dimension()).max().unwrap_or(0)
    }

    /// The dimension of the sides of the cells, 0 to 2.
    fn side_dimension(&self) -> u8 {
        self.dimension().saturating_sub(1) as u8
    }

    /// Whether the cells fill a volume.
    #[must_use]
    pub fn is_volume(&self) -> bool {
        self.dimension() == 3
    }

    /// The elements of the mesh's own dimension: volumes, or faces where there are none.
    #[must_use]
    pub fn cells(&self) -> Elements<'_> {
        Elements::new(self.parts.order, self.cell_blocks())
    }

    /// The elements of one dimension less than the cells: those on the boundary, or between parts of the mesh.
    #[must_use]
    pub fn sides(&self) -> Elements<'_> {
        Elements::new(self.parts.order, self.side_blocks())
    }

    /// Number of elements of each kind that there is.
    #[must_use]
    pub fn counts(&self) -> BTreeMap<Cell, usize> {
        let mut counts = BTreeMap::new();
        for block in self.blocks().iter().filter(|block| !block.tags.is_empty()) {
            *counts.entry(block.cell).or_default() += block.tags.len();
        }
        counts
    }

    /// The elements of one kind, numbered among themselves.
    #[must_use]
    pub fn elements_of(&self, cell: Cell) -> Elements<'_> {
        Elements::new(self.parts.order, self.parts.blocks.iter().filter(move |block| block.cell == cell))
    }

    /// Blocks of cells.
    pub fn cell_blocks(&self) -> impl Iterator<Item = &Block> + Clone {
        self.blocks_of(self.dimension()).map(|(_, block)| block)
    }

    /// Blocks of sides.
    pub fn side_blocks(&self) -> impl Iterator<Item = &Block> + Clone {
        let own = self.dimension();
        self.parts.blocks.iter().filter(move |block| block.cell.dimension() + 1 == own)
    }

    /// Blocks of sides, to be changed in place; their nodes must be nodes of the mesh, as many as before.
    pub(crate) fn side_blocks_mut(&mut self) -> impl Iterator<Item = &mut Block> {
        let own = self.dimension();
        self.parts.blocks.iter_mut().filter(move |block| block.cell.dimension() + 1 == own)
    }

    /// Blocks of the given dimension, with their place in the list of all.
    fn blocks_of(&self, dimension: usize) -> impl Iterator<Item = (usize, &Block)> + Clone {
        self.parts.blocks.iter().enumerate().filter(move |(_, b)| b.cell.dimension() == dimension)
    }

    /// Tags of the physical groups that an entity's elements belong to, each once; a negative one means reversed orientation.
    #[must_use]
    pub fn physical_tags_of(&self, entity: EntityKey) -> Vec<i32> {
        let of_entity = self.parts.entities.iter().filter(|e| e.key == entity).flat_map(|e| &e.physical_tags);
        let of_blocks = self.parts.blocks.iter().filter(|b| b.entity == entity).flat_map(|b| &b.physical_tags);
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
            let known =
                self.parts.physical_names.iter().find(|n| n.dimension == entity.dimension && n.tag == tag.abs());
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
        nodes.iter().map(|&n| self.parts.points[n.index()])
    }
}
