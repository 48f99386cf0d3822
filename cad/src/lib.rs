//! CAD models for mesh curving, and the closest point on them: a stand-in for Project Geode on OpenCASCADE (OCCT).
//!
//! * [`Model::read`] reads STEP, IGES and BREP and hands out plain, numbered, named entities in the unit of the file. It reads in this
//!   process, or has a [`Reader`] do it in a child process that a malformed file may crash.
//! * [`Group`] is a set of faces, edges and vertices; [`Group::closest`] gives the [`Foot`] of a point on it, trims respected, and says
//!   whether it is proven to be the closest point; [`Group::closest_batch`] does so for many, in parallel.
//! * [`Model::evaluate`] gives derivatives, normals and curvatures; [`Model::resolve`] turns references of linkage files into entities.
//! * [`Airfoil`] makes CAD of an airfoil's coordinates.
//! * [`BoxTree`] is the tree of boxes that the search uses, for other uses too.
//!
//! The search runs on plain arrays (closed forms, Bezier spans with their control hulls, OCCT's own parameters); the answer is
//! evaluated by OCCT on the original surface. This crate knows no mesh.
#![forbid(unsafe_code)]
#![cfg_attr(not(feature = "occt"), allow(dead_code))] // of the box tree, what only the search uses

#[cfg(feature = "occt")]
mod airfoil;
mod boxes;
pub mod child;
#[cfg(feature = "occt")]
mod closest;
#[cfg(feature = "occt")]
mod geometry;
mod ids;
pub mod memory;
#[cfg(feature = "occt")]
mod model;
#[cfg(feature = "occt")]
mod read;
pub mod regular;
pub mod tolerance;
mod unit;

pub use boxes::{Aabb, BoxTree, Nearest};
pub use ids::{EdgeId, EntityId, FaceId, VertexId};
pub use unit::unit_factor;

#[cfg(feature = "occt")]
pub use {
    airfoil::{Airfoil, AirfoilError},
    closest::foot::{Doubt, End, Foot},
    closest::group::{Group, GroupError},
    closest::hint::Hint,
    geometry::evaluation::{CurvePoint, Evaluation, SurfacePoint},
    model::containment::Stray,
    model::crease::Crease,
    model::health::{Health, TrimFault},
    model::reference::ReferenceError,
    model::{Edge, Face, Kind, Label, Model, NamedGroup, Sewing, SourceFormat, Unit, Vertex},
    read::import::{ReadError, ReadOptions, Reader},
    read::reader::{READER_SUBCOMMAND, serve_reader},
};
