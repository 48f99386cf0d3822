//! The certificate: a proof, for every element, that its Jacobian determinant is positive on the whole closed cell.
//!
//! The determinant of a curved element is a polynomial. Its Bernstein coefficients bound it, subdivision makes the
//! bounds as tight as need be, and all rounding is bounded, so that a verdict is a theorem about the coordinates as
//! they stand in `f64`. Only [`crate::element`] is used: the judge shares no sample points and no cost with the smoother.
//!
//! For the pyramid the determinant is that of `(X_a / s, X_b / s, X_c)` on the closed cube of its reference coordinates `(a, b, c)`,
//! `s = 1 - c`: at the apex it depends on the direction, and all directions count.

mod certificate;
mod check;
mod contest;
mod elements;
mod face;
mod form;
mod judge;
mod judged;
#[cfg(test)]
mod layer_tests;
mod measured;
#[cfg(test)]
mod mesh_tests;
mod pieces;
#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod plane_tests;
mod product;
#[cfg(test)]
#[path = "../../tests/suite/common/random.rs"]
mod random;
#[cfg(test)]
#[allow(clippy::panic)]
mod random_tests;
mod real;
mod rounding;
#[cfg(test)]
mod rounding_tests;
mod scaled;
mod search;
mod straight;
#[cfg(test)]
mod tests;
mod verdict;

pub use certificate::{Certificate, Tally, certify, mesh, surface};
pub use check::{NotCertifiable, check};
pub use elements::{Buffer, Elements, MeshElements};
pub use face::{FaceFinding, WallFace, Walls, mean_normal, walls};
pub use judge::{Judge, Shape};
pub use judged::Judged;
pub use measured::{Measured, measured};
pub use verdict::{Bounds, Finding, Method, Verdict};

/// When the certificate stops to subdivide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Wanted distance of the bounds of min `J / J_c`; relative where the minimum is larger than 1. Default 0.05: an
    /// element's verdict does not depend on it.
    pub gap: f64,
    /// Largest number of pieces an element is cut into before it counts as undecided. Default 2000.
    pub pieces: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { gap: 0.05, pieces: 2000 }
    }
}
