//! A mesh as Nektar++ has it: its elements begin at the corners that it wants, and the nodes inside follow from the faces.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::corners::{self, highest};
use super::modified;
use crate::element::{Cell, Order, basis, interior_count, interior_start, lattice};
use crate::mesh::{Block, Mesh, NodeId};

/// Elements and points of a mesh as Nektar++ has it.
pub(super) struct Held {
    /// The number of each corner.
    pub(super) numbers: Vec<u32>,
    /// The cells, each beginning at the corner that it begins at there.
    pub(super) cells: Vec<Block>,
    /// The points.
    pub(super) points: Vec<DVec3>,
}

impl Held {
    /// A mesh as Nektar++ has it.
    ///
    /// # Errors
    /// Elements that it cannot have.
    pub(super) fn of(mesh: &Mesh) -> Result<Held, String> {
        let order = mesh.order();
        let pyramids = mesh.elements_of(Cell::Pyramid).len();
        if pyramids > 0 && order.get() > 2 {
            return Err(format!("Nektar++'s pyramids beyond P2 have other functions ({pyramids} pyramids); write P2"));
        }
        let numbers = corners::numbers(mesh)?;
        let mut turns = Turns::new(order);
        let turn = |block: &Block, turns: &mut Turns| {
            let mut own = Block { nodes: Vec::with_capacity(block.nodes.len()), ..block.clone() };
            for nodes in block.elements(order) {
                let slots = turns.of(block.cell, &begin(block.cell, nodes, &numbers));
                own.nodes.extend(slots.iter().map(|&slot| nodes[slot]));
            }
            own
        };
        let cells: Vec<Block> = mesh.cell_blocks().map(|block| turn(block, &mut turns)).collect();
        let mut points = mesh.points().to_vec();
        if mesh.is_volume() {
            cells.iter().for_each(|block| inside(block, order, &mut points));
        }
        Ok(Held { numbers, cells, points })
    }
}

/// Gives the nodes inside the cells of a block the places that follow from their faces.
fn inside(block: &Block, order: Order, points: &mut [DVec3]) {
    if interior_count(block.cell, order) == 0 {
        return;
    }
    let (weights, boundary) = (modified::interior(block.cell, order), interior_start(block.cell, order));
    let elements: Vec<&[NodeId]> = block.elements(order).collect();
    let places: Vec<Vec<DVec3>> = elements
        .par_iter()
        .map(|nodes| {
            let on: Vec<DVec3> = nodes[..boundary].iter().map(|node| points[node.index()]).collect();
            continued(weights, &on)
        })
        .collect();
    for (nodes, own) in elements.into_iter().zip(places) {
        nodes[boundary..].iter().zip(own).for_each(|(node, x)| points[node.index()] = x);
    }
}

/// Points inside by the weights of those on the boundary.
pub(super) fn continued(weights: &[f64], on: &[DVec3]) -> Vec<DVec3> {
    let about = on.first().copied().unwrap_or_default();
    let sum = |row: &[f64]| about + row.iter().zip(on).map(|(&w, &x)| w * (x - about)).sum::<DVec3>();
    weights.chunks_exact(on.len().max(1)).map(sum).collect()
}

/// The corners in the order in which Nektar++ is to have them.
fn begin(cell: Cell, nodes: &[NodeId], numbers: &[u32]) -> Vec<u8> {
    match cell {
        Cell::Tet => {
            let mut corners = [0u8, 1, 2, 3];
            corners.sort_by_key(|&corner| numbers[nodes[usize::from(corner)].index()]);
            let swaps = (0..4).flat_map(|a| (a + 1..4).map(move |b| (a, b)));
            if swaps.filter(|&(a, b)| corners[a] > corners[b]).count() % 2 == 1 {
                corners.swap(0, 1); // the same way round as it was
            }
            corners.to_vec()
        }
        Cell::Prism => {
            let top = highest(&nodes[..3], numbers) as u8;
            let triangle = [(top + 2) % 3, top, (top + 1) % 3];
            triangle.into_iter().chain(triangle.map(|corner| corner + 3)).collect()
        }
        _ => (0..cell.corner_count() as u8).collect(),
    }
}

/// Where the nodes of a cell stand when its corners are taken in another order.
pub(super) struct Turns {
    order: Order,
    known: FxHashMap<(Cell, Vec<u8>), Vec<usize>>,
}

impl Turns {
    pub(super) fn new(order: Order) -> Turns {
        Turns { order, known: FxHashMap::default() }
    }

    /// For each node of the cell with these corners, its place in the cell as it is. The corners must be those of one of its symmetries.
    pub(super) fn of(&mut self, cell: Cell, corners: &[u8]) -> &[usize] {
        let order = self.order;
        self.known.entry((cell, corners.to_vec())).or_insert_with(|| turned(cell, order, corners))
    }
}

fn turned(cell: Cell, order: Order, corners: &[u8]) -> Vec<usize> {
    let p = order.get() as f64;
    let nodes = lattice(cell, order);
    let place = |weights: Vec<f64>| {
        let mut at = [0.0; 3];
        for (weight, &corner) in weights.iter().zip(corners) {
            let own = cell.corners()[usize::from(corner)];
            (0..3).for_each(|axis| at[axis] += weight * f64::from(own[axis]) * p);
        }
        let at = at.map(|x| x.round() as u8);
        nodes.iter().position(|own| *own == at).unwrap_or_default()
    };
    basis::at_lattice(cell, Order::LINEAR, order).into_iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_is_a_permutation_that_begins_at_the_corners() {
        let mut turns = Turns::new(Order::MAX);
        for (cell, corners) in
            [(Cell::Tet, vec![2u8, 0, 1, 3]), (Cell::Prism, vec![2, 0, 1, 5, 3, 4]), (Cell::Quad, vec![1, 0, 3, 2])]
        {
            let own = turns.of(cell, &corners).to_vec();
            assert!(own.iter().zip(&corners).all(|(&slot, &corner)| slot == usize::from(corner)));
            let mut sorted = own.clone();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..own.len()), "{cell}: {own:?}");
        }
    }
}
