//! What is told of a curved mesh: to people as text, to programs as JSON.
//!
//! Each JSON document is a struct of this module, field by field; its `schema` changes when a field changes its meaning or
//! goes away. Lengths are in the mesh's unit, times in seconds, memory in bytes.

mod certificate;
mod check;
#[cfg(feature = "cad")]
mod curved;
#[cfg(feature = "cad")]
mod feet;

pub use certificate::{CertificateReport, WorstElement};
pub use check::CheckReport;
#[cfg(feature = "cad")]
pub use {curved::*, feet::*};
