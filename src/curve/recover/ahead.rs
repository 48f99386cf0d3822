//! Release ahead of smoothing: at a corner with `q <= 0`, or in a column of cells that the wall's displacement takes up
//! ([`super::super::curvability`]), no smoothing makes the elements valid while the wall's nodes are held, and trying bends what is around.
//!
//! The wing of nektar at P3 (`q` of -0.126 and -0.016 at two corners) ended with four faces off the CAD after 4 433 sweeps, and ends with two
//! after 3 126; the coarse ONERA M6 at P3 with `J / J_c` of 0.296, and with 0.351.

use rustc_hash::FxHashSet;

use super::offending::{Offending, Reach};
use crate::curve::curvability::{Spot, impossible};
use crate::curve::level::Level;
use crate::curve::proof::behind_faces;

/// Releases wall nodes of a level that is projected and not smoothed yet: those between the ends of one edge at each impossible corner, and
/// all but the linear ones of the face under each column that is taken up.
pub fn release_ahead(level: &mut Level) {
    let (mut cornered, mut corners, mut taken_up) = (Vec::new(), FxHashSet::default(), FxHashSet::default());
    for spot in impossible(level) {
        match spot {
            Spot::ElementCorner { element, .. } => cornered.push(element),
            Spot::FaceCorner { face, .. } => drop(corners.insert(face)),
            Spot::Column { face, .. } => drop(taken_up.insert(face)),
        }
    }
    cornered.extend(behind_faces(level, &corners));
    for (mut elements, reach) in [(cornered, Reach::Edge), (behind_faces(level, &taken_up), Reach::Whole)] {
        elements.sort_unstable();
        elements.dedup();
        if !elements.is_empty() {
            let nodes = Offending { level }.nodes(&elements, reach);
            nodes.into_iter().for_each(|n| level.wall.release(n));
        }
    }
}
