//! The paper's costs, equations (2) to (8), as pure functions of positions and targets.
//!
//! They are what is reported, thresholded and blended. What the smoother descends on is built from the same
//! quantities but lives in [`crate::smooth`].

mod cost;
mod grid_lines;
mod shape;
mod size;

pub use cost::{alpha, blend, nodal};
pub use grid_lines::{GridLineAngles, GridLines};
pub use shape::{Cut, c_wcn, c_wcn_slope, corner_frame, element_c_wcn};
pub(crate) use shape::{Norms, cofactor, norms, squared};
pub use size::{element_c_jac, jacobians};
