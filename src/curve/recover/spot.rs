//! Spots around which the wall goes back, or goes no farther.

use glam::DVec3;
use rayon::prelude::*;

use crate::mesh::{ElementId, Mesh};

/// Reach, in distances to the wall plus the element's size.
const REACH: f64 = 2.0;

/// A spot around which the wall goes back, or goes no farther.
pub(super) struct Spot {
    middle: DVec3,
    reach: f64,
}

impl Spot {
    /// Those of some elements of the straight `mesh`, `times` as far as to the wall, whose nodes are at `wall`.
    pub(super) fn around(elements: &[ElementId], mesh: &Mesh, wall: &[DVec3], times: usize) -> Vec<Spot> {
        let (straight, cells) = (mesh.points(), mesh.cells());
        let spot = |&element: &ElementId| {
            let nodes = cells.nodes(element);
            let middle = nodes.iter().map(|n| straight[n.index()]).sum::<DVec3>() / nodes.len() as f64;
            let size = nodes.iter().map(|n| straight[n.index()].distance(middle)).fold(0.0, f64::max);
            let nearest = wall.iter().map(|w| w.distance_squared(middle)).fold(f64::INFINITY, f64::min).sqrt();
            Spot { middle, reach: REACH * times as f64 * (nearest + size) }
        };
        elements.par_iter().map(spot).collect()
    }

    /// What stays of the displacement at `x`: `keep` within half the reach, all beyond it, smooth between.
    pub(super) fn fraction(&self, x: DVec3, keep: f64) -> f64 {
        let t = (2.0 * x.distance(self.middle) / self.reach - 1.0).clamp(0.0, 1.0);
        keep + (1.0 - keep) * t * t * (3.0 - 2.0 * t)
    }
}
