//! sagitta curves linear viscous meshes onto their CAD.
#![forbid(unsafe_code)]

pub mod associate;
pub mod certify;
pub mod cli;
pub mod element;
pub mod elevate;
pub mod formats;
pub mod mesh;
pub mod perturb;
pub mod pipeline;
pub mod project;
pub mod quality;
pub mod report;
pub mod retreat;
pub mod smooth;
