//! Which elements may be curved: those within a number of layers off the curved walls.

use std::num::NonZeroUsize;

use glam::DVec3;
use rayon::prelude::*;

use super::level::{Case, Level};
use crate::associate::{Association, Classification};
use crate::mesh::{Boundary, Element, ElementId, Mesh};

/// Keeps all elements straight that lie beyond so many layers of elements off the curved walls. The first layer are the
/// elements that touch a curved wall, each next one those that touch a node of the layers before it. The nodes of the
/// elements beyond get the classification [`Classification::Straight`], and the displacement ends before them
/// ([`WallNode::beyond_layers`](super::wall_state::WallNode::beyond_layers)).
pub fn leave_straight_beyond(layers: NonZeroUsize, level: &mut Level) {
    let Case { boundary, association, .. } = level.case;
    let Level { elevated, periodic, wall, .. } = level;
    let mesh = &elevated.mesh;
    let mut near = at_curved_walls(mesh, boundary, association);
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

/// Whether each node is a corner of a curved wall.
fn at_curved_walls(mesh: &Mesh, boundary: &Boundary, association: &Association) -> Vec<bool> {
    let mut at = vec![false; mesh.points().len()];
    for (classification, corners) in association.faces.iter().zip(&boundary.corners) {
        if matches!(classification, Classification::Surface(_)) && association.plane_of(*classification).is_none() {
            corners.iter().for_each(|n| at[n.index()] = true);
        }
    }
    at
}

/// The layer of each cell: 1 for those at curved walls, one more for those at a node of the layer before; 0 where there is none.
#[must_use]
pub fn layers(mesh: &Mesh, boundary: &Boundary, association: &Association) -> Vec<usize> {
    let (cells, mut near) = (mesh.cells(), at_curved_walls(mesh, boundary, association));
    let mut layers = vec![0; cells.len()];
    let mut left: Vec<ElementId> = cells.ids().collect();
    for layer in 1.. {
        let (reached, beyond): (Vec<ElementId>, Vec<ElementId>) =
            left.into_par_iter().partition(|&id| cells.nodes(id).iter().any(|n| near[n.index()]));
        for &id in &reached {
            layers[id.index()] = layer;
            cells.nodes(id).iter().for_each(|n| near[n.index()] = true);
        }
        left = beyond;
        if reached.is_empty() || left.is_empty() {
            break;
        }
    }
    layers
}

/// Whether each cell is straight: all its nodes are where its corners alone would put them.
#[must_use]
pub fn straight_elements(mesh: &Mesh, straight: &[DVec3]) -> Vec<bool> {
    let is = |own: Element| own.nodes.iter().all(|n| mesh.points()[n.index()] == straight[n.index()]);
    mesh.cells().par_iter().map(is).collect()
}
