//! Where smoothing begins at an order.

use glam::DVec3;
use rayon::prelude::*;

use super::below::Below;
use super::level::Level;
use super::perturb::perturb;
use crate::associate::Classification;

/// Where the nodes are before the first sweep: carried along by the walls from the curved mesh of the order below, or from the straight one.
///
/// A periodic image is where its original takes it.
#[must_use]
pub(super) fn start(level: &Level, below: Option<&Below>) -> Vec<DVec3> {
    let Some(below) = below else {
        let mut positions = perturb(level, level.wall.displacements());
        level.periodic.apply(&mut positions);
        return positions;
    };
    let raised = below.raised(level.mesh());
    let mut rest = level.wall.displacements();
    rest.par_iter_mut().zip(&raised).enumerate().for_each(|(n, (displacement, raised))| {
        *displacement = if level.plane_of(n).is_some() { DVec3::ZERO } else { *displacement - *raised };
    });
    let mut positions = perturb(level, rest);
    let frozen = |n: usize| level.case.settings.freeze_linear && n < level.elevated.linear_nodes;
    positions.par_iter_mut().zip(&raised).enumerate().for_each(|(n, (position, raised))| {
        *position = match (level.wall.classification(n), level.plane_of(n).filter(|_| !frozen(n))) {
            (Classification::Free, _) => *position + *raised,
            (_, Some(plane)) => plane.closest(*position + *raised),
            (_, None) => level.straight()[n] + level.wall.displacement(n),
        };
    });
    level.periodic.apply(&mut positions);
    positions
}
