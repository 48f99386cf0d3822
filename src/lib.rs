//! sagitta curves linear viscous meshes onto their CAD: P1 in, P2, P3 or P4 out, every element certified valid.
//!
//! The sagitta is the height of an arc over its chord: what a straight edge at a curved wall lacks. The library implements
//! Karman, *Curving for Viscous Meshes* (27th International Meshing Roundtable), and departs from it where measurements said so
//! (`docs/theory.md`).
//!
//! # Curve a mesh
//!
//! ```no_run
//! use cad::{Model, ReadOptions};
//! use sagitta::curve::{Settings, curve};
//! use sagitta::element::Order;
//! use sagitta::formats::{self, WriteOptions};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let mesh = formats::read("weeble.msh".as_ref())?;
//!     let cad = Model::read("weeble.step".as_ref(), &ReadOptions::default())?;
//!     let curved = curve(mesh, &cad, None, &Settings::new(Order::new(3)?), &mut ())?;
//!     assert!(curved.is_certified() && curved.off_cad.is_empty());
//!     formats::write("weeble_p3.msh".as_ref(), &curved.mesh, &WriteOptions::default())?;
//!     Ok(())
//! }
//! ```
//!
//! `()` is an observer that lets the work go on; implement [`curve::Observer`] to follow or end it. [`curve::Job`] does the same from
//! files, with a linkage file and a search for the CAD's unit. The programs in `examples/` also check, convert and project.
//!
//! # Check a mesh
//!
//! ```
//! use sagitta::certify::{self, Settings};
//! use sagitta::formats;
//!
//! let mesh = formats::read("fixtures/samples/cylprism_p2_msh41b.msh".as_ref())?;
//! let certificate = certify::mesh(&mesh, mesh.points(), None, &Settings::default());
//! assert!(certificate.holds() && certificate.relative.lower > 0.0);
//! # Ok::<(), formats::Error>(())
//! ```
//!
//! # The data's way
//!
//! ```text
//!  CAD file ──┐                         ┌─ linkage file (MeshLink XML), or none
//!             ▼                         ▼
//!         cad::Model ── groups ──► associate ◄── linear mesh
//!                                      │  every boundary point, edge, face → its CAD group
//!                                      ▼
//!                                   elevate      P1 → Pp, equispaced nodes, all straight: the targets
//!                                      ▼
//!                                   project      new wall nodes → their CAD group
//!                                      ▼
//!                                     fit        nodes of wall edges slide, so that the wall polynomial comes nearer to the CAD
//!                                      ▼
//!                                   perturb      wall displacement carried into planes and volume
//!                                      ▼
//!                                   smooth       stages: shape, then shape + Jacobian; wall nodes slide on the CAD
//!                                      ▼
//!                                   certify      a proof of det J > 0 for every element; recovery where it fails
//!                                      ▼
//!                       curved mesh + report
//! ```
//!
//! 1. [`formats`] reads the linear mesh into a [`mesh::Mesh`]; `cad::Model::read` reads the CAD.
//! 2. [`associate`] classifies boundary faces, edges and points on groups of CAD entities, by a linkage file, entity tags or geometry,
//!    and holds the candidates against the CAD.
//! 3. [`mesh::elevate`] makes the new nodes at their straight positions.
//! 4. [`curve::wall`] spreads the boundary's new nodes, puts them on their groups, and slides them so that the wall between them is
//!    nearer to the CAD.
//! 5. [`curve::perturb`] carries the wall's displacement into planar patches and into the volume.
//! 6. [`smooth`] lowers an objective made of the paper's costs ([`quality`]), stage by stage, on the active part of the mesh.
//! 7. [`certify`] proves every element valid, [`curve::proof`] every face on the CAD free of folds too; where that fails
//!    [`curve::recover`] takes the wall back until it holds, and forward again as far as it holds.
//! 8. [`report`] says what came out; [`formats`] writes it.
//!
//! Steps 3 to 6 are taken at P2 first and then at each order up to the one asked for, from where the one below ended. What is handed
//! from step to step is a [`curve::level::Level`].
//!
//! [`element`] is the one place that knows cells: their lattices, bases, sub-elements and sample tables.
#![forbid(unsafe_code)]
// They panic where the reader is gone; `cli::output` does not.
#![cfg_attr(not(test), warn(clippy::print_stdout, clippy::print_stderr))]

#[cfg(feature = "cad")]
pub mod associate;
pub mod certify;
pub mod cli;
#[cfg(feature = "cad")]
pub mod curve;
pub mod element;
pub mod formats;
pub mod html;
pub mod mesh;
pub mod picture;
pub mod quality;
pub mod report;
pub mod scene;
pub mod smooth;
#[cfg(feature = "cad")]
pub mod validate;
