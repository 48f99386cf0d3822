//! CAD models for mesh curving, and the closest point on them: a stand-in for Project Geode on OpenCASCADE (OCCT).
//!
//! * [`Model::read`] reads STEP, IGES and BREP in a child process and hands out plain, numbered, named entities
//!   in the unit of the file. The child is the calling program itself: its `main` must begin with
//!   `if first argument == READER_SUBCOMMAND { return serve_reader(path) }`.
//! * [`Group`] is a set of faces, edges and vertices; [`Group::closest`] gives the [`Foot`] of a point on it, trims respected, and says
//!   whether it is proven to be the closest point; [`Group::closest_batch`] does so for many, in parallel.
//! * [`Model::evaluate`] gives derivatives, normals and curvatures; [`Model::resolve`] turns references of linkage files into entities.
//! * [`BoxTree`] is the tree of boxes that the search uses, for other uses too.
//!
//! The search runs on plain arrays (closed forms, Bezier spans with their control hulls, OCCT's own parameters); the answer is
//! evaluated by OCCT on the original surface. This crate knows no mesh.
#![forbid(unsafe_code)]

mod assemble;
mod bezier;
mod boxes;
mod certificate;
mod chart;
pub mod child;
mod closed_form;
mod curve;
mod finish;
mod foot;
mod format;
mod group;
mod health;
mod hint;
mod ids;
mod import;
mod leaf;
mod model;
mod newton;
mod payload;
mod reader;
mod reference;
mod search;
mod sewing;
mod slab;
pub mod tolerance;
mod trim;
mod unit;

pub use boxes::{Aabb, BoxTree, Nearest};
pub use foot::{CurvePoint, Doubt, End, Evaluation, Foot, SurfacePoint};
pub use group::{Group, GroupError};
pub use health::{Health, TrimFault};
pub use hint::Hint;
pub use ids::{EdgeId, EntityId, FaceId, VertexId};
pub use import::{ReadError, ReadOptions};
pub use model::{Edge, Face, Kind, Label, Model, NamedGroup, SourceFormat, Unit, Vertex};
pub use reader::{READER_SUBCOMMAND, serve_reader};
pub use reference::ReferenceError;
pub use sewing::Sewing;
pub use unit::unit_factor;
