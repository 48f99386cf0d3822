//! The driver: associate, go up order by order, prove, and recover where the proof fails.

use cad::Model;
use glam::DVec3;

use super::error::Error;
use super::input::{self, Associated};
use super::level::{Case, Level};
use super::observer::{Clock, Observer, Step};
use super::orders::{Continuation, Continued, LowerOrder};
use super::proof::Proof;
use super::recover::{OffCadFace, Recovered, recover};
use super::settings::Settings;
use super::wall_state::Wall;
use crate::associate::{Association, Linkage, OpenFace};
use crate::certify::{Certificate, Walls};
use crate::mesh::elevate::Elevated;
use crate::mesh::{Boundary, Mesh};
use crate::smooth::{Progress, Smoothed};

/// A curved mesh and how it came about.
#[derive(Debug)]
pub struct Curved {
    /// The mesh of order p, at its curved coordinates; sides of the skin that the linear mesh does not mark are marked, see
    /// [`Mesh::without_unmarked`].
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
    /// Boundary faces that belong to the CAD and stay straight, as it could not be decided on which of its faces they lie.
    pub open_faces: Vec<OpenFace>,
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
    let mesh = input::checked(mesh, settings.surface)?;
    input::check_cad(&mesh, cad, settings.surface)?;
    clock.step(Step::Associate);
    let associated = Associated::new(&mesh, cad, linkage, settings)?;
    drive(mesh, associated, settings, clock)
}

/// The steps that follow the association.
pub(super) fn drive(
    mut linear: Mesh,
    associated: Associated,
    settings: &Settings,
    mut clock: Clock,
) -> Result<Curved, Error> {
    let Associated { boundary, classified, open_faces, periodic, cad_unit, cad_scale } = associated;
    let mut association = classified.association;
    linear.periodic_mut().extend(periodic);
    let case = Case { settings, boundary: &boundary, association: &association };
    let Continued { mut level, mut smoothed, notes, below, lower_orders } =
        Continuation::new(case, linear)?.run(&mut clock)?;

    clock.step(Step::Certify);
    let proof = Proof::of(&level);
    // Recovery moves the cells behind faces; behind those of a surface mesh there are none.
    let good = proof.holds() && smoothed.end.worst() >= settings.floor;
    let holds = settings.surface || (good && level.wall.is_on_cad());
    let Recovered { proof, off_cad } = if holds {
        Recovered { proof, off_cad: Vec::new() }
    } else {
        clock.step(Step::Recover);
        let below = if proof.holds() { None } else { below.mesh(clock.observer) };
        let ended = smoothed.stopped;
        smoothed.stopped &= !clock.observer.may_recover();
        let mut watch = |progress: Progress| clock.observer.progress(&progress);
        let recovered = recover(&mut level, &mut smoothed, below.as_ref(), proof, &mut watch);
        smoothed.stopped |= ended;
        recovered
    };

    let Level { elevated: Elevated { mut mesh, linear_nodes, .. }, curved, wall, .. } = level;
    let mut straight = curved;
    straight.swap_with_slice(mesh.points_mut());
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
        open_faces,
        cad_unit,
        cad_scale,
        seconds,
    })
}
