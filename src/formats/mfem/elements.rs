//! Elements as they stand in the file: by their corners.

use std::collections::BTreeSet;

use crate::element::Cell;
use crate::mesh::NodeId;

/// Elements of one dimension.
#[derive(Default)]
pub(super) struct Elements {
    /// Attribute and cell of each.
    pub(super) kinds: Vec<(i32, Cell)>,
    /// The vertices at the corners of all, one element behind the other.
    pub(super) corners: Vec<NodeId>,
}

impl Elements {
    /// Cell, attribute and corners of each.
    pub(super) fn iter(&self) -> impl Iterator<Item = (Cell, i32, &[NodeId])> {
        let mut rest = &self.corners[..];
        self.kinds.iter().map(move |&(attribute, cell)| {
            let (own, others) = rest.split_at(cell.corner_count());
            rest = others;
            (cell, attribute, own)
        })
    }

    /// The attributes that there are.
    pub(super) fn attributes(&self) -> BTreeSet<i32> {
        self.kinds.iter().map(|&(attribute, _)| attribute).collect()
    }
}

/// Gives the vertices that the cells use numbers without gaps, as MFEM does before it counts nodes; how many they are.
pub(super) fn compress(vertices: usize, cells: &mut Elements, sides: &mut Elements) -> usize {
    let mut used = vec![false; vertices];
    cells.corners.iter().for_each(|corner| used[corner.index()] = true);
    let mut next = 0;
    let numbers: Vec<NodeId> = used
        .into_iter()
        .map(|used| {
            next += usize::from(used);
            // No more than there were; what is not used has no number.
            if used { NodeId::new(next - 1).unwrap_or(NodeId::NONE) } else { NodeId::NONE }
        })
        .collect();
    for corner in cells.corners.iter_mut().chain(&mut sides.corners) {
        *corner = numbers.get(corner.index()).copied().unwrap_or(NodeId::NONE);
    }
    next
}
