//! The elements of one dimension, by number.

use rayon::prelude::*;

use super::{Block, ElementId, EntityKey, FaceKey, NodeId};
use crate::element::{Cell, Order};

/// An element of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element<'a> {
    /// Its number among the elements of its dimension.
    pub id: ElementId,
    /// Its shape.
    pub cell: Cell,
    /// Its number in the file.
    pub tag: u64,
    /// The entity that it lies on.
    pub entity: EntityKey,
    /// Its nodes in internal order, corners first.
    pub nodes: &'a [NodeId],
}

impl<'a> Element<'a> {
    /// The nodes at its corners.
    #[must_use]
    pub fn corners(&self) -> &'a [NodeId] {
        &self.nodes[..self.cell.corner_count()]
    }

    /// The ends of its edges, in the order of [`Cell::edges`].
    pub fn edges(&self) -> impl ExactSizeIterator<Item = [NodeId; 2]> + use<'a> {
        let nodes = self.nodes;
        self.cell.edges().iter().map(move |edge| edge.map(|q| nodes[usize::from(q)]))
    }

    /// Its sides, in the order of [`Cell::sides`]: the same key in every element that has the side.
    pub fn sides(&self) -> impl Iterator<Item = FaceKey> + use<'a> {
        let nodes = self.nodes;
        self.cell.sides().map(move |corners| FaceKey::picked(nodes, corners))
    }
}

/// All elements of one dimension of a mesh, numbered by [`ElementId`] over its blocks in file order.
#[derive(Clone, Debug)]
pub struct Elements<'a> {
    order: Order,
    blocks: Vec<&'a Block>,
    /// Number of the first element of each block.
    firsts: Vec<usize>,
    count: usize,
}

impl<'a> Elements<'a> {
    pub(super) fn new(order: Order, blocks: impl Iterator<Item = &'a Block>) -> Elements<'a> {
        let mut elements = Elements { order, blocks: Vec::new(), firsts: Vec::new(), count: 0 };
        for block in blocks {
            elements.blocks.push(block);
            elements.firsts.push(elements.count);
            elements.count += block.tags.len();
        }
        elements
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The order of all of them.
    #[must_use]
    pub fn order(&self) -> Order {
        self.order
    }

    /// Their blocks, in file order.
    #[must_use]
    pub fn blocks(&self) -> &[&'a Block] {
        &self.blocks
    }

    /// An element by its number, which must be one of this mesh's.
    #[must_use]
    pub fn get(&self, id: ElementId) -> Element<'a> {
        let (block, place) = self.place(id);
        let stride = block.stride(self.order);
        let nodes = &block.nodes[place * stride..][..stride];
        Element { id, cell: block.cell, tag: block.tags[place], entity: block.entity, nodes }
    }

    /// The shape of an element.
    #[must_use]
    pub fn cell(&self, id: ElementId) -> Cell {
        self.place(id).0.cell
    }

    /// The nodes of an element, in internal order.
    #[must_use]
    pub fn nodes(&self, id: ElementId) -> &'a [NodeId] {
        let (block, place) = self.place(id);
        let stride = block.stride(self.order);
        &block.nodes[place * stride..][..stride]
    }

    /// The block of an element, and its place there.
    fn place(&self, id: ElementId) -> (&'a Block, usize) {
        let own = self.firsts.partition_point(|&first| first <= id.index()) - 1;
        (self.blocks[own], id.index() - self.firsts[own])
    }

    /// The number of the element at a place in their order, below their count.
    #[must_use]
    pub fn id(&self, place: usize) -> ElementId {
        ElementId::numbered(place)
    }

    /// All numbers, rising.
    pub fn ids(&self) -> impl ExactSizeIterator<Item = ElementId> + Clone + use<> {
        (0..self.count).map(ElementId::numbered)
    }

    /// All numbers, rising, in parallel.
    pub fn par_ids(&self) -> impl IndexedParallelIterator<Item = ElementId> + Clone + use<> {
        (0..self.count).into_par_iter().map(ElementId::numbered)
    }

    /// The elements, in the order of their numbers.
    pub fn iter(&self) -> impl Iterator<Item = Element<'a>> + Clone {
        let order = self.order;
        self.blocks.iter().zip(&self.firsts).flat_map(move |(&block, &first)| {
            let own = block.nodes.chunks_exact(block.stride(order)).zip(&block.tags).enumerate();
            own.map(move |(place, (nodes, &tag))| {
                let id = ElementId::numbered(first + place);
                Element { id, cell: block.cell, tag, entity: block.entity, nodes }
            })
        })
    }

    /// The elements, in the order of their numbers, in parallel.
    pub fn par_iter(&self) -> impl IndexedParallelIterator<Item = Element<'a>> {
        self.par_ids().map(|id| self.get(id))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::mesh::{Inconsistent, Mesh, Parts};
    use glam::DVec3;

    /// A tet, a triangle on it, and a second tet in a block of its own that shares the triangle.
    fn parts() -> Parts {
        let node = |n: usize| NodeId::new(n).unwrap();
        let block = |cell: Cell, tag: u64, nodes: &[usize]| Block {
            tags: vec![tag],
            nodes: nodes.iter().map(|&n| node(n)).collect(),
            ..Block::new(cell, EntityKey::new(cell.dimension() as u8, tag as i32))
        };
        let blocks = vec![
            block(Cell::Tet, 7, &[0, 1, 2, 3]),
            block(Cell::Triangle, 3, &[2, 1, 0]),
            block(Cell::Tet, 9, &[0, 2, 1, 4]),
        ];
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Z];
        Parts { points, blocks, ..Parts::default() }
    }

    #[test]
    fn cells_and_sides_are_numbered_in_file_order() {
        let mesh = Mesh::new(parts()).unwrap();
        let (cells, sides) = (mesh.cells(), mesh.sides());
        assert_eq!((mesh.dimension(), cells.len(), sides.len()), (3, 2, 1));
        assert_eq!(cells.iter().map(|own| own.tag).collect::<Vec<_>>(), [7, 9]);
        assert_eq!(cells.par_iter().collect::<Vec<_>>(), cells.iter().collect::<Vec<_>>());
        for id in cells.ids() {
            assert_eq!((cells.get(id).nodes, cells.get(id).cell), (cells.nodes(id), cells.cell(id)));
            let side = FaceKey::new(sides.get(ElementId::default()).corners());
            assert_eq!(cells.get(id).sides().filter(|own| *own == side).count(), 1, "the tets share the triangle");
        }
        assert_eq!((mesh.node_tags(), mesh.node_entities()), (&[1, 2, 3, 4, 5][..], &[None; 5][..]));
    }

    #[test]
    fn a_mesh_of_faces_has_faces_as_cells() {
        let mut parts = parts();
        parts.blocks.retain(|block| block.cell == Cell::Triangle);
        let mesh = Mesh::new(parts).unwrap();
        assert_eq!((mesh.dimension(), mesh.cells().len(), mesh.sides().len()), (2, 1, 0));
        assert_eq!(mesh.cells().get(ElementId::default()).sides().count(), 3);
        assert!(Mesh::default().cells().is_empty());
    }

    #[test]
    fn parts_that_do_not_fit_are_refused() {
        let refused = |spoil: fn(&mut Parts)| {
            let mut parts = parts();
            spoil(&mut parts);
            Mesh::new(parts).unwrap_err()
        };
        let unknown = refused(|parts| parts.points.truncate(4));
        assert_eq!(unknown, Inconsistent::UnknownNode { what: "elements", node: 4, nodes: 4 });
        let nodes = refused(|parts| parts.blocks[1].nodes.truncate(2));
        assert_eq!(nodes, Inconsistent::Nodes { block: 1, found: 2, elements: 1, stride: 3 });
        let values = refused(|parts| parts.node_tags = vec![1, 2]);
        assert_eq!(values, Inconsistent::Values { what: "node numbers", found: 2, nodes: 5 });
    }
}
