//! Where the judge reads elements from.

use glam::DVec3;

use crate::element::{Cell, Order};
use crate::mesh::{Block, Mesh};

/// An element's coordinates, in memory that is used again.
#[derive(Clone, Debug, Default)]
pub struct Buffer {
    /// Nodes in internal order.
    pub points: Vec<DVec3>,
    /// Corners of the unperturbed linear element; empty where there is none.
    pub corners: Vec<DVec3>,
}

/// Numbered elements of three dimensions, of any kinds and orders.
pub trait Elements: Sync {
    /// How many there are.
    fn count(&self) -> usize;

    /// Fills the empty buffer with an element.
    fn read(&self, element: usize, into: &mut Buffer) -> (Cell, Order);
}

/// The volume elements of a mesh, numbered over its blocks in file order.
#[derive(Clone, Debug)]
pub struct MeshElements<'a> {
    order: Order,
    positions: &'a [DVec3],
    unperturbed: Option<&'a [DVec3]>,
    blocks: Vec<(usize, &'a Block)>,
    count: usize,
}

impl<'a> MeshElements<'a> {
    /// The elements of a mesh with its nodes at `positions`, and the points of its linear nodes before they were moved (the first
    /// of an elevated mesh's); without these an element's reference is its own straight corners.
    #[must_use]
    pub fn new(mesh: &'a Mesh, positions: &'a [DVec3], unperturbed: Option<&'a [DVec3]>) -> MeshElements<'a> {
        let mut count = 0;
        let mut blocks = Vec::new();
        for (_, block) in mesh.blocks_of(3) {
            blocks.push((count, block));
            count += block.elements(mesh.order).len();
        }
        MeshElements { order: mesh.order, positions, unperturbed, blocks, count }
    }
}

impl Elements for MeshElements<'_> {
    fn count(&self) -> usize {
        self.count
    }

    fn read(&self, element: usize, into: &mut Buffer) -> (Cell, Order) {
        let (first, block) = self.blocks[self.blocks.partition_point(|&(first, _)| first <= element) - 1];
        let stride = block.stride(self.order);
        let nodes = &block.nodes[(element - first) * stride..][..stride];
        into.points.extend(nodes.iter().map(|n| self.positions[n.index()]));
        if let Some(points) = self.unperturbed {
            into.corners.extend(nodes[..block.cell.corner_count()].iter().map(|n| points[n.index()]));
        }
        (block.cell, self.order)
    }
}
