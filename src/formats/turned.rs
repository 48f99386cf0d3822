//! Cells that a writer numbers the other way round.
//!
//! Formats and programs differ in which way a prism's triangles turn; the sign of a cell's volume tells.

use rayon::prelude::*;

use crate::element::{Cell, mirrored, signed_volume};
use crate::mesh::{NodeId, Parts};

/// Turns every cell of negative volume, and notes how many of each kind there were.
pub(super) fn turn(mesh: &mut Parts) {
    let (order, points) = (mesh.order, &mesh.points);
    for cell in Cell::VOLUME {
        let exchanged = mirrored(cell, order);
        let (mut all, mut turned) = (0, 0);
        for block in mesh.blocks.iter_mut().filter(|block| block.cell == cell) {
            all += block.tags.len();
            let elements = block.nodes.par_chunks_exact_mut(exchanged.len());
            turned += elements
                .filter_map(|nodes: &mut [NodeId]| {
                    let mut corners = [glam::DVec3::ZERO; 8];
                    let corners = &mut corners[..cell.corner_count()];
                    corners.iter_mut().zip(&*nodes).for_each(|(x, node)| *x = points[node.index()]);
                    (signed_volume(cell, corners) < 0.0).then(|| {
                        let given = nodes.to_vec();
                        nodes.iter_mut().zip(&exchanged).for_each(|(node, &n)| *node = given[usize::from(n)]);
                    })
                })
                .count();
        }
        if turned > 0 {
            mesh.notes.push(format!(
                "{turned} of {all} {cell} cells were numbered the other way round (negative volume) and were renumbered"
            ));
        }
    }
}
