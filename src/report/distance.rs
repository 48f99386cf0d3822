//! How far the curved boundary is from the CAD.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use crate::associate::Classification;
use crate::curve::Curved;
use crate::mesh::FaceKey;
use crate::scene::samples;

/// The distance of a boundary face, or of several, from the CAD, at the samples of each.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    /// The largest.
    pub max: f64,
    /// Where it is.
    pub at: DVec3,
    /// Sum of the squares.
    squares: f64,
    /// Number of samples.
    samples: usize,
}

impl Distance {
    /// The root of the mean square.
    #[must_use]
    pub fn rms(&self) -> f64 {
        (self.squares / self.samples as f64).sqrt()
    }

    /// That of both together; the first has the place where they are equally far.
    #[must_use]
    pub fn and(self, other: Distance) -> Distance {
        let farthest = if other.max > self.max { other } else { self };
        let squares = self.squares + other.squares;
        Distance { max: farthest.max, at: farthest.at, squares, samples: self.samples + other.samples }
    }
}

/// The distance of a boundary face, by its index in [`Curved::boundary`], from the CAD that it is associated with, at (3p)^2 samples.
#[must_use]
pub fn distance(curved: &Curved, face: usize) -> Option<Distance> {
    let Classification::Surface(surface) = curved.association.faces[face] else { return None };
    let group = &curved.association.surfaces[surface].group;
    let (mesh, nodes) = (&curved.mesh, curved.boundary.nodes(face, &curved.mesh));
    let far = samples(mesh, curved.boundary.faces[face].cell, nodes).into_iter().map(|x| {
        let distance = group.distance(x);
        Distance { max: distance, at: x, squares: distance * distance, samples: 1 }
    });
    far.reduce(Distance::and)
}

/// The largest distance of a boundary face's nodes from the CAD that it is associated with.
pub(super) fn node_distance(curved: &Curved, face: usize) -> Option<f64> {
    let Classification::Surface(surface) = curved.association.faces[face] else { return None };
    let group = &curved.association.surfaces[surface].group;
    let nodes = curved.boundary.nodes(face, &curved.mesh);
    nodes.iter().map(|n| group.distance(curved.mesh.points()[n.index()])).reduce(f64::max)
}

/// The largest distance of each boundary face from the CAD that it is associated with, by its corners; of faces that are associated with none
/// nothing stands there.
#[must_use]
pub fn face_distances(curved: &Curved) -> FxHashMap<FaceKey, f64> {
    let faces = 0..curved.boundary.faces.len();
    let of = |face: usize| Some((FaceKey::new(&curved.boundary.corners[face]), distance(curved, face)?.max));
    faces.into_par_iter().filter_map(of).collect()
}
