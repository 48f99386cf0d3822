//! Proven lower bounds of every element's measures, for pictures and statistics.

use glam::DVec3;
use rayon::prelude::*;

use super::certificate::Bench;
use super::elements::{Elements, MeshElements};
use super::{Finding, Settings};
use crate::mesh::Mesh;

/// For every element, in order, lower bounds that are proven.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    /// Of the minimum of `J / J_c`; minus infinity where `J_c` is not positive.
    pub relative: Vec<f64>,
    /// Of the scaled Jacobian, smallest over largest determinant.
    pub scaled: Vec<f64>,
}

/// Measures a mesh with its nodes at `positions`; `linear_corners` as for [`mesh`](super::mesh). Faces that lie in no plane are seen each
/// along the mean normal of its linear face.
#[must_use]
pub fn measured(mesh: &Mesh, positions: &[DVec3], linear_corners: Option<&[DVec3]>, settings: &Settings) -> Measured {
    let elements = match linear_corners.unwrap_or(positions) {
        corners if mesh.dimension() == 2 && mesh.plane(positions).is_none() => {
            MeshElements::of_surface(mesh, positions, corners)
        }
        _ => MeshElements::new(mesh, positions, linear_corners),
    };
    let bounds = |bench: &mut Bench, place: usize| {
        let Finding { relative, scaled, .. } =
            bench.with(&elements, elements.id(place), |judge, shape| judge.examine(shape, settings));
        (relative.lower, scaled.lower)
    };
    let (relative, scaled) = (0..elements.count()).into_par_iter().map_init(Bench::default, bounds).unzip();
    Measured { relative, scaled }
}
