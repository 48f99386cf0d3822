//! Curving: from a linear mesh, its CAD and perhaps a linkage, all in memory, to a curved mesh that is proven valid.
//!
//! [`curve`] is the driver: it associates the mesh with the CAD, goes up order by order ([`orders`]) to the one asked for, proves the
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
//! | places, and straight places: 2 x `DVec3` | 48 |
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
//! At P3 and P4 the mesh of the order below is kept as well, as far as it takes to go on from it: places and nodes of the elements.
//!
//! Smoothing takes more for *active* nodes only (none in that case): a gradient and a Hessian block (96 bytes) for each node of each
//! active element and again for each node, the inverse block (72), and 8 pairs of steps and gradient changes (48 each): 1.3 kB an
//! active node at P2.

pub mod checkpoint;
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
pub mod wall;

use cad::Model;
use glam::DVec3;

pub use error::{Error, JobError};
pub use job::Job;
pub use observer::{Observer, Step};
pub use orders::LowerOrder;
pub use settings::Settings;

use crate::associate::{Association, Linkage};
use crate::certify::{Certificate, Walls};
use crate::mesh::elevate::Elevated;
use crate::mesh::{Boundary, Mesh};
use crate::smooth::{Progress, Smoothed};
use input::Associated;
use level::{Case, Level, Wall};
use observer::Clock;
use orders::{Continuation, Continued};
use proof::Proof;
use recover::{OffCadFace, Recovered, recover};

/// A curved mesh and how it came about.
#[derive(Debug)]
pub struct Curved {
    /// The mesh of order p, at its curved coordinates.
    pub mesh: Mesh,
    /// Straight coordinates of its nodes: the targets.
    pub straight: Vec<DVec3>,
    /// Linear nodes; they come first.
    pub linear_nodes: usize,
    /// What lies on which CAD group.
    pub association: Association,
    /// The linear mesh's boundary elements.
    pub boundary: Boundary,
    /// State of the boundary nodes, and counts of closest points.
    pub wall: Wall,
    /// What the smoother did at the orders below.
    pub lower_orders: Vec<LowerOrder>,
    /// What the smoother did.
    pub smoothed: Smoothed,
    /// What is proven of the mesh.
    pub certificate: Certificate,
    /// What is proven of the faces on the CAD.
    pub walls: Walls,
    /// Boundary faces that are off the CAD, so that the elements behind them are valid.
    pub off_cad: Vec<OffCadFace>,
    /// The CAD's unit, as its file names it.
    pub cad_unit: String,
    /// What the CAD was multiplied by.
    pub cad_scale: f64,
    /// Seconds a step, all orders together.
    pub seconds: Vec<(Step, f64)>,
}

impl Curved {
    /// Whether every element is proven valid and every face on the CAD free of folds.
    #[must_use]
    pub fn is_certified(&self) -> bool {
        self.certificate.holds() && self.walls.hold()
    }
}

/// Curves a linear mesh onto its CAD, all in memory. Which mesh faces lie on which CAD faces comes from the linkage; without one from
/// the mesh's entity tags where they are the CAD's numbers, else from geometry.
///
/// # Errors
/// [`Error`]: the mesh cannot be curved, or does not belong to the CAD.
pub fn curve(
    mesh: Mesh,
    cad: &Model,
    linkage: Option<&Linkage>,
    settings: &Settings,
    observer: &mut dyn Observer,
) -> Result<Curved, Error> {
    let mut clock = Clock::new(observer);
    clock.step(Step::Read);
    input::check_mesh(&mesh)?;
    input::check_cad(cad)?;
    clock.step(Step::Associate);
    let associated = Associated::new(&mesh, cad, linkage, settings)?;
    drive(mesh, associated, settings, clock)
}

/// The steps that follow the association.
fn drive(mut linear: Mesh, associated: Associated, settings: &Settings, mut clock: Clock) -> Result<Curved, Error> {
    let Associated { boundary, mut association, periodic, cad_unit, cad_scale } = associated;
    linear.periodic.extend(periodic);
    let case = Case { settings, boundary: &boundary, association: &association };
    let Continued { mut level, mut smoothed, notes, below, lower_orders } =
        Continuation::new(case, linear)?.run(&mut clock)?;

    clock.step(Step::Certify);
    let proof = Proof::of(&level);
    let Recovered { proof, off_cad } = if proof.holds() {
        Recovered { proof, off_cad: Vec::new() }
    } else {
        let below = below.mesh(clock.observer);
        let mut watch = |progress: Progress| clock.observer.progress(&progress);
        recover(&mut level, &mut smoothed, below.as_ref(), proof, &mut watch)
    };

    let Level { elevated: Elevated { mut mesh, linear_nodes, .. }, curved, wall, .. } = level;
    let straight = std::mem::replace(&mut mesh.points, curved);
    association.notes.extend(notes);
    let Proof { certificate, walls } = proof;
    let seconds = clock.finish();
    Ok(Curved {
        mesh,
        straight,
        linear_nodes,
        association,
        boundary,
        wall,
        lower_orders,
        smoothed,
        certificate,
        walls,
        off_cad,
        cad_unit,
        cad_scale,
        seconds,
    })
}
