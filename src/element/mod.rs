//! One table of cells; lattice, basis, Bernstein nets, sub-elements and the formats' node orders are derived from it.
//!
//! Everything that depends on the kind of a cell lives below this module: the rest of the program asks a
//! [`Cell`] for its lattice, its faces or its sample tables and loops over the answer.

pub mod basis;
pub mod bernstein;
mod cell;
pub mod derivative;
mod extension;
mod filling;
mod lattice;
mod net;
mod orientation;
pub mod samples;
mod subdivision;
mod tables;
mod volume;

pub use cell::{Cell, Face, Order, OrderOutOfRange};
pub use extension::interior_extension;
pub use filling::Filling;
pub(crate) use lattice::{between, embed, shifted};
pub use lattice::{edge_nodes, face_lattice, lattice, side_nodes};
pub use net::Net;
pub use orientation::{InteriorSlots, canonical, interior_count, interior_slots, interior_start, mirrored};
pub use samples::Samples;
pub use subdivision::{corner_simplices, simplex_nodes};
pub use tables::Tables;
pub use volume::signed_volume;
