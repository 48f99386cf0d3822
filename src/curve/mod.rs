//! Curving: from a linear mesh, its CAD and perhaps a linkage, all in memory, to a curved mesh that is proven valid.
//!
//! [`curve`] is the driver: it associates the mesh with the CAD, goes up order by order (`orders.rs`) to the one asked for, proves the
//! result ([`proof`]), and where that fails calls [`recover`]. [`Job`] does the same from files. What is handed from step to step is
//! the [`level::Level`]: the mesh at one order with its straight and its curved coordinates, and the state of its boundary.
//!
//! # Memory
//!
//! What a mesh of tets takes at P2, in bytes a node of the curved mesh (0.127 linear nodes and 0.74 tets a node), when the report is
//! made. `wing_sharp --scale 5 --quick` (5.85 million nodes, 4.33 million tets) takes 1.10 GB there, 187 bytes a node, linear mesh,
//! CAD and program included; that is the peak of the whole run (`/usr/bin/time`). All rows but the last are computed from the
//! types; the last is what remains.
//!
//! | array | bytes |
//! |---|---|
//! | positions, and straight positions: 2 x `DVec3` | 48 |
//! | nodes of the elements: 10 x `u32` a tet | 30 |
//! | numbers in the file: `u64` a node and an element | 14 |
//! | entity of each node | 12 |
//! | edges: 2 ends, first new node, 3 x `u32` | 10 |
//! | costs of the elements: 32 a tet | 24 |
//! | proven minima: `f64` a tet | 6 |
//! | elements around the corners, for turning angles: 4 x `u32` a tet | 12 |
//! | boundary: classifications, displacements, association | 8 |
//! | CAD, code, allocator | 23 |
//!
//! Where a report, a page or a VTU file is asked for, the four measures of the elements take 24 bytes a node more.
//!
//! At P3 and P4 the mesh of the order below is kept as well, as far as it takes to go on from it: positions and nodes of the elements.
//!
//! Smoothing takes more for *active* nodes only (none in that case): a gradient and a Hessian block (96 bytes) for each node of each
//! active element and again for each node, the inverse block (72), and 8 pairs of steps and gradient changes (48 each): 1.3 kB an
//! active node at P2.

pub mod below;
pub mod checkpoint;
mod checkpointing;
pub mod curvability;
mod deadline;
mod driver;
mod error;
mod input;
mod job;
pub mod layers;
pub mod level;
mod observer;
mod orders;
pub mod periodic;
pub mod perturb;
pub mod proof;
pub mod recover;
mod settings;
mod smoothing;
mod start;
mod surface;
mod trace;
pub mod wall;
pub mod wall_state;

pub use checkpointing::Checkpointing;
pub use deadline::Deadline;
pub use driver::{Curved, curve};
pub use error::{Error, JobError};
pub use job::{Job, Preview};
pub use observer::{Observer, Step};
pub use orders::LowerOrder;
pub use settings::Settings;
pub use trace::{Sweep, Trace};
