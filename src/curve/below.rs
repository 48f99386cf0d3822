//! The curved mesh of a lower order: where a higher order begins, and what it falls back to.
//!
//! The polynomial of the order below is the same polynomial in the order above.

use glam::DVec3;
use rayon::prelude::*;

use super::level::Level;
use crate::element::{Cell, Order, basis};
use crate::mesh::{Mesh, NodeId};

/// Weights of nodes that are as good as zero: a node on a face takes nothing from those off it.
const NOTHING: f64 = 1e-13;
/// Elements that are raised at a time: what they take while they wait does not grow with the mesh.
const BATCH: usize = 1 << 12;

/// The curved mesh of a lower order: what it takes to go on from it.
#[derive(Clone, Debug)]
pub struct Below {
    /// Its order.
    pub order: Order,
    /// Cell kind and nodes of each block's elements.
    blocks: Vec<(Cell, Vec<NodeId>)>,
    /// What moved each node from its straight position.
    moved: Vec<DVec3>,
}

impl From<Level<'_>> for Below {
    fn from(level: Level) -> Below {
        let (mesh, mut moved) = (level.elevated.mesh.into_parts(), level.curved);
        moved.par_iter_mut().zip(&mesh.points).for_each(|(position, straight)| *position -= *straight);
        let blocks = mesh.blocks.into_iter().map(|block| (block.cell, block.nodes)).collect();
        Below { order: mesh.order, blocks, moved }
    }
}

impl Below {
    /// What moves each node of the straight mesh `above`, of a higher order and with the same elements, onto this curved mesh.
    #[must_use]
    pub fn raised(&self, above: &Mesh) -> Vec<DVec3> {
        let mut raised = vec![DVec3::ZERO; above.points().len()];
        let mut own = Vec::new();
        for (high, (cell, low)) in above.blocks().iter().zip(&self.blocks) {
            let mut weights = basis::at_lattice(*cell, self.order, above.order());
            weights.iter_mut().flatten().filter(|w| w.abs() < NOTHING).for_each(|w| *w = 0.0);
            let strides = [high.stride(above.order()), cell.node_count(self.order)];
            let of_element = |(own, low): (&mut [DVec3], &[NodeId])| {
                let still = low.iter().all(|n| self.moved[n.index()] == DVec3::ZERO);
                for (own, weights) in own.iter_mut().zip(&weights).filter(|_| !still) {
                    *own = low.iter().zip(weights).map(|(n, &w)| self.moved[n.index()] * w).sum();
                }
                !still
            };
            for (high, low) in high.nodes.chunks(BATCH * strides[0]).zip(low.chunks(BATCH * strides[1])) {
                own.resize(high.len(), DVec3::ZERO);
                let elements = own.par_chunks_exact_mut(strides[0]).zip(low.par_chunks_exact(strides[1]));
                let moved: Vec<bool> = elements.with_min_len(64).map(of_element).collect();
                let elements = high.chunks_exact(strides[0]).zip(own.chunks_exact(strides[0]));
                for ((nodes, own), _) in elements.zip(moved).filter(|(_, moved)| *moved) {
                    nodes.iter().zip(own).for_each(|(node, own)| raised[node.index()] = *own);
                }
            }
        }
        raised
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::bernstein;
    use crate::mesh::elevate::elevate;
    use crate::mesh::{Block, EntityKey, Parts};

    /// One element of a kind, at its unit corners.
    fn alone(cell: Cell) -> Mesh {
        let points: Vec<DVec3> = cell.corners().iter().map(|c| DVec3::from(c.map(f64::from))).collect();
        let nodes = (0..points.len()).map(|n| NodeId::new(n).unwrap()).collect();
        let entity = EntityKey::new(cell.dimension() as u8, 1);
        let block = Block { tags: vec![1], nodes, ..Block::new(cell, entity) };
        Mesh::new(Parts { points, blocks: vec![block], ..Parts::default() }).unwrap()
    }

    /// A curved mesh from its straight one.
    fn lower(straight: &Mesh, places: &[DVec3]) -> Below {
        let blocks = straight.blocks().iter().map(|block| (block.cell, block.nodes.clone())).collect();
        let moved = places.iter().zip(straight.points()).map(|(place, straight)| *place - *straight).collect();
        Below { order: straight.order(), blocks, moved }
    }

    #[test]
    fn a_raised_element_is_the_same_polynomial() {
        for cell in Cell::VOLUME {
            for high in Order::all().filter(|o| o.get() > 2) {
                for low in Order::all().filter(|o| o.get() > 1 && *o < high) {
                    let [below, above] = [low, high].map(|order| elevate(&alone(cell), order).unwrap().mesh);
                    // Bent at every node, differently.
                    let bend = |(n, x): (usize, &DVec3)| *x + DVec3::new(0.1, -0.07, 0.05) * (1.0 + n as f64).sin();
                    let places: Vec<DVec3> = below.points().iter().enumerate().map(bend).collect();
                    let moved = lower(&below, &places).raised(&above);
                    let raised: Vec<DVec3> = above.points().iter().zip(&moved).map(|(x, d)| *x + *d).collect();
                    let place = |mesh: &Mesh, places: &[DVec3], at: [f64; 3]| -> DVec3 {
                        let values = basis::values(cell, mesh.order(), at);
                        mesh.blocks()[0].nodes.iter().zip(values).map(|(n, v)| places[n.index()] * v).sum()
                    };
                    for unit in [[0.2, 0.3, 0.1], [0.31, 0.05, 0.4], [0.05, 0.62, 0.17]] {
                        let at = bernstein::chart(cell, unit);
                        let gap = place(&below, &places, at).distance(place(&above, &raised, at));
                        assert!(gap < 1e-12, "{cell} {low} to {high} at {unit:?}: {gap:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_does_not_move_stays_to_the_bit() {
        let order = |p: usize| Order::new(p).unwrap();
        let [below, above] = [2, 3].map(|p| elevate(&alone(Cell::Tet), order(p)).unwrap().mesh);
        let mut places = below.points().to_vec();
        places[9] += DVec3::splat(0.1); // the middle of the edge 2-3
        let moved = lower(&below, &places).raised(&above);
        let on_face = |x: &DVec3| x.y == 0.0 || x.z == 0.0; // faces without that edge
        let still = above.points().iter().zip(&moved).filter(|(x, _)| on_face(x));
        assert!(still.clone().count() > 10);
        assert!(still.clone().all(|(_, d)| *d == DVec3::ZERO));
        assert!(moved.iter().any(|d| *d != DVec3::ZERO));
    }
}
