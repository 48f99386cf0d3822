//! Where smoothing begins at an order.

use glam::DVec3;
use rayon::prelude::*;

use super::below::Below;
use super::level::Level;
use super::perturb::perturb;
use crate::associate::Classification;

/// Where the nodes are before the first sweep: carried along by the walls from the curved mesh of the order below, or from the straight one;
/// released nodes are where that has them.
///
/// A periodic image is where its original takes it.
#[must_use]
pub(super) fn start(level: &mut Level, below: Option<&Below>) -> Vec<DVec3> {
    let raised = below.map(|below| below.raised(level.mesh()));
    let released: Vec<usize> = level.wall.released().collect();
    let places: Vec<DVec3> = released.iter().map(|&n| level.wall.displacement(n)).collect();
    let begun = |n: usize| raised.as_ref().map_or(DVec3::ZERO, |raised| raised[n]);
    released.iter().for_each(|&n| level.wall.displace(n, begun(n)));
    let mut begin = match raised {
        Some(raised) => carried_from(level, raised),
        None => perturb(level, level.wall.displacements()),
    };
    released.iter().zip(places).for_each(|(&n, place)| level.wall.displace(n, place));
    level.periodic.apply(&mut begin);
    begin
}

/// Carried along by the walls from a mesh that `raised` moves the nodes to.
fn carried_from(level: &Level, raised: Vec<DVec3>) -> Vec<DVec3> {
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
    positions
}
