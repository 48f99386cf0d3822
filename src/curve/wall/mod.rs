//! The boundary's nodes: put on the CAD, fitted to it, and kept on it.

mod constraint;
pub(super) mod corner;
pub mod fit;
mod project;
mod rim;
mod tight;

pub use constraint::CadConstraint;
pub use project::project;
pub(in crate::curve) use rim::follow_rims;
