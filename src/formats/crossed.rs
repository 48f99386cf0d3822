//! Quadrilaterals whose corners do not go round: writers that number them row by row make bow ties of them.

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::element::{Cell, Order};
use crate::mesh::{Block, FaceKey, Mesh, NodeId};

/// Renumbers crossed quadrilaterals on the boundary of a linear mesh along the faces of the cells that have the same corners; notes how
/// many there were.
pub(super) fn uncross(mesh: &mut Mesh) {
    if mesh.order() != Order::LINEAR || !mesh.is_volume() {
        return;
    }
    let mut suspects: FxHashMap<[NodeId; 4], Option<[NodeId; 4]>> = FxHashMap::default();
    let mut all = 0;
    for block in mesh.side_blocks().filter(|block| block.cell == Cell::Quad) {
        all += block.tags.len();
        let crossed = quads(block).filter(|corners| is_crossed(corners.map(|node| mesh.points()[node.index()])));
        suspects.extend(crossed.map(|corners| (sorted(corners), None)));
    }
    if suspects.is_empty() {
        return;
    }
    for cell in mesh.cells().iter() {
        for side in cell.sides() {
            if let &[a, b, c, d] = side.corners()
                && let Some(found) = suspects.get_mut(&sorted([a, b, c, d]))
            {
                *found = Some([a, b, c, d]);
            }
        }
    }
    let mut renumbered = 0;
    for block in mesh.side_blocks_mut().filter(|block| block.cell == Cell::Quad) {
        for corners in block.nodes.chunks_exact_mut(Cell::Quad.corner_count()) {
            let own = [corners[0], corners[1], corners[2], corners[3]];
            if let Some(&Some(round)) = suspects.get(&sorted(own))
                && FaceKey::new(&own) != FaceKey::new(&round)
            {
                corners.copy_from_slice(&round);
                renumbered += 1;
            }
        }
    }
    if renumbered > 0 {
        mesh.note(format!(
            "{renumbered} of {all} quad elements on the boundary had their corners in crossed order, and were renumbered along the \
             faces of the cells"
        ));
    }
}

fn quads(block: &Block) -> impl Iterator<Item = [NodeId; 4]> + '_ {
    block.elements(Order::LINEAR).filter_map(|nodes| nodes.try_into().ok())
}

fn sorted(mut corners: [NodeId; 4]) -> [NodeId; 4] {
    corners.sort_unstable();
    corners
}

/// Whether the normals at some corners point against those at others.
fn is_crossed(corners: [DVec3; 4]) -> bool {
    let normal = |n: usize| {
        let at = corners[n];
        (corners[(n + 1) % 4] - at).cross(corners[(n + 3) % 4] - at)
    };
    (1..4).any(|n| normal(0).dot(normal(n)) < 0.0)
}
