//! Recovery: what is done where, after smoothing, elements are not proven valid or faces on the CAD not free of folds; never a worse
//! mesh (`docs/theory.md`, section 11).
//!
//! 1. Smooth again, with surveys twice as dense, where elements fail.
//! 2. Release the wall nodes that make elements impossible: one edge's first, more only where that is not enough (`release.rs`). Where some
//!    end off the CAD though no corner of the wall is impossible ([`super::curvability`]), steps 3 and 5 instead, if they end on it.
//! 3. Take the displacement back around the failing elements, at first by half, more from round to round, with a fraction that falls
//!    smoothly with the distance, and smooth again; wall nodes that are off the CAD stay where they were put.
//! 4. [`backtrack`], element by element, which ends in a valid mesh whatever came before.
//! 5. Forward again what went back, step by step, as far as the mesh stays proven (`forward.rs`).
//!
//! Back means to the curved mesh of the order below, where that is proven valid: on it the wall follows the CAD as well as that order
//! can, and all nodes go back together. Otherwise it means the straight mesh: the wall goes back, and the volume is carried along as
//! by the first perturbation, so that layers move whole. The torus at scale 0.5, whose prisms lean by up to 88 degrees off their own
//! faces, is inverted at P3 after 20 sweeps; by way of P2 it then comes to the CAD with C_JAC 0.35, by way of the straight mesh with
//! 0.08 (`tests/suite/fallback.rs`).

mod ahead;
mod attempt;
pub mod backtrack;
mod forward;
mod off_cad;
mod offending;
mod recovery;
mod release;
mod spot;

pub use ahead::release_ahead;
pub use off_cad::{Departure, OffCadFace, off_cad_faces};
pub use recovery::{Recovered, recover};
