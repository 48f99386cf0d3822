//! Which elements may be curved: those within a number of layers off the curved walls.

use std::num::NonZeroUsize;

use glam::DVec3;
use rayon::prelude::*;

use super::level::{Case, Level};
use crate::associate::Classification;
use crate::mesh::{Element, Mesh};

/// Keeps all elements straight that lie beyond so many layers of elements off the curved walls. The first layer are the
/// elements that touch a curved wall, each next one those that touch a node of the layers before it. The nodes of the
/// elements beyond get the classification [`Classification::Straight`], and the displacement ends before them
/// ([`WallNode::beyond_layers`](super::wall_state::WallNode::beyond_layers)).
pub fn leave_straight_beyond(layers: NonZeroUsize, level: &mut Level) {
    let Case { boundary, association, .. } = level.case;
    let Level { elevated, periodic, wall, .. } = level;
    let mesh = &elevated.mesh;
    let mut near = vec![false; mesh.points().len()];
    for (classification, corners) in association.faces.iter().zip(&boundary.corners) {
        if matches!(classification, Classification::Surface(_)) && association.plane_of(*classification).is_none() {
            corners.iter().for_each(|n| near[n.index()] = true);
        }
    }
    let cells = mesh.cells();
    let mut within = vec![false; cells.len()];
    for _ in 0..layers.get() {
        periodic.spread(&mut near);
        for (within, own) in within.iter_mut().zip(cells.iter()) {
            *within |= own.nodes.iter().any(|n| near[n.index()]);
        }
        let reached = cells.iter().zip(&within).filter(|(_, within)| **within);
        reached.flat_map(|(own, _)| own.nodes).for_each(|n| near[n.index()] = true);
    }
    let mut held = vec![false; mesh.points().len()];
    let beyond = cells.iter().zip(&within).filter(|(_, within)| !**within);
    beyond.flat_map(|(own, _)| own.nodes).for_each(|n| held[n.index()] = true);
    periodic.spread(&mut held);
    wall.keep_straight(&held, elevated.linear_nodes);
}

/// Whether each cell is straight: all its nodes are where its corners alone would put them.
#[must_use]
pub fn straight_elements(mesh: &Mesh, straight: &[DVec3]) -> Vec<bool> {
    let is = |own: Element| own.nodes.iter().all(|n| mesh.points()[n.index()] == straight[n.index()]);
    mesh.cells().par_iter().map(is).collect()
}
