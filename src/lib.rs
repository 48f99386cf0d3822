//! sagitta curves linear viscous meshes onto their CAD: P1 in, P2, P3 or P4 out, every element certified valid.
//!
//! The sagitta is the height of an arc over its chord: what a straight edge at a curved wall lacks. The program implements
//! Karman, *Curving for Viscous Meshes* (27th International Meshing Roundtable), and departs from it where measurements said so.
//!
//! # The data's way
//!
//! ```text
//!  CAD file ──┐                         ┌─ linkage file (MeshLink XML), or none
//!             ▼                         ▼
//!         cad::Model ── groups ──► associate ◄── linear mesh
//!                                      │  every boundary point, edge, face → its CAD group
//!                                      ▼
//!                                   elevate      P1 → Pp, equispaced nodes, one copy kept unperturbed: the targets
//!                                      ▼
//!                                   project      new wall nodes → their CAD group
//!                                      ▼
//!                                     fit        nodes of wall edges slide, so that the wall polynomial comes nearer to the CAD
//!                                      ▼
//!                                   perturb      wall displacement carried into planes and volume
//!                                      ▼
//!                                   smooth       stages: shape, then shape + Jacobian; wall nodes slide on the CAD
//!                                      ▼
//!                                   certify      a proof of det J > 0 for every element; ladder, retreat where one fails
//!                                      ▼
//!                       curved mesh + report
//! ```
//!
//! The order of the steps stands in [`pipeline`]; each step is a module named after it:
//!
//! 1. [`formats`] reads the linear mesh into a [`mesh::Mesh`]; [`cad::Model::read`] reads the CAD in a child process.
//! 2. [`associate`] periodic boundary faces, edges and points to groups of CAD entities, by a linkage file, entity tags or geometry, and
//!    holds the candidates against the CAD.
//! 3. [`elevate`] makes the new nodes at their straight places.
//! 4. [`project`] spreads the boundary's new nodes and puts them on their groups; [`fit`] slides them on it so that the wall between
//!    them is nearer to the CAD.
//! 5. [`perturb`] carries the wall's displacement into planar patches and into the volume.
//! 6. [`smooth`] lowers an objective made of the paper's costs ([`quality`]), stage by stage, on the active part of the mesh.
//! 7. [`certify`] proves every element valid and every face on the CAD free of folds ([`proof`]), or the ladder (`src/ladder`)
//!    is climbed down, to [`retreat`], until it can, and up again as far as the proof holds.
//! 8. [`report`] tells what came out; [`formats`] writes it.
//!
//! Steps 3 to 6 are taken at P2 first and then at each order up to the one asked for, from where the one below ended
//! (`src/ascent.rs`).
//!
//! [`element`] is the one place that knows cells: their lattices, bases, sub-elements, sample tables and file orders.
#![forbid(unsafe_code)]

#[cfg(feature = "cad")]
pub mod associate;
pub mod certify;
pub mod cli;
#[cfg(feature = "cad")]
pub mod curve;
pub mod element;
pub mod formats;
pub mod mesh;
pub mod quality;
pub mod report;
pub mod smooth;
#[cfg(feature = "cad")]
pub mod validate;
