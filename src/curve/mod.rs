//! The order of the steps, from files in to a curved mesh and its report.
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
//! | elements around the corners, for grid-line angles: 4 x `u32` a tet | 12 |
//! | boundary: classifications, displacements, association | 8 |
//! | CAD, code, allocator | 23 |
//!
//! At P3 and P4 the mesh of the order below is kept as well, as far as it takes to go on from it: places and nodes of the elements.
//!
//! Smoothing takes more for *active* nodes only (none in that case): a gradient and a Hessian block (96 bytes) for each node of each
//! active element and again for each node, the inverse block (72), and 8 pairs of steps and gradient changes (48 each): 1.3 kB an
//! active node at P2.

pub mod checkpoint;
pub mod layers;
pub(crate) mod orders;
pub mod periodic;
pub mod perturb;
pub mod proof;
pub mod recover;
pub mod wall;

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use cad::{Model, ReadOptions};
use glam::DVec3;

use crate::associate::{self, AssociateError, Association, Choice, ClassifyError, LinkageError, Summary, UnknownPatch};
use crate::certify::{self, Certificate, Walls};
use crate::curve::checkpoint::{CheckpointError, Work};
pub use crate::curve::orders::LowerOrder;
use crate::curve::orders::{Ascent, Climb, Level, Ready};
use crate::curve::proof::Proof;
use crate::curve::recover::backtrack::GivenUp;
use crate::curve::recover::{Climbed, Ladder};
use crate::curve::wall::Projected;
use crate::element::Order;
use crate::formats;
use crate::mesh::elevate::Elevated;
use crate::mesh::{Boundary, Mesh, TooMany};
use crate::smooth::{self, Checkpoint, Smoothed, Watch};

/// Elements that an error lists by number.
const LISTED: usize = 10;

/// What is to be curved, and how.
#[derive(Clone, Debug)]
pub struct Job {
    /// The linear mesh.
    pub mesh: PathBuf,
    /// The CAD it was made on.
    pub cad: PathBuf,
    /// The MeshLink file that periodic the two together; without it the mesh's entity tags do, or else geometry.
    pub linkage: Option<PathBuf>,
    /// Which patches are curved.
    pub patches: Choice,
    /// Order of the curved mesh, 2 to 4.
    pub order: Order,
    /// How far a linear node may be from its CAD entity; share of the mesh's box. Default 1e-3.
    pub max_offset: f64,
    /// Keep all linear nodes where they are.
    pub freeze_linear: bool,
    /// Keep nodes on curved walls where projection put them.
    pub freeze_walls: bool,
    /// Begin at the order itself, not at the curved mesh of the order below.
    pub direct: bool,
    /// Layers of elements off curved walls that may be curved; `None` leaves it to the walls' displacement.
    pub curve_layers: Option<NonZeroUsize>,
    /// What the CAD is multiplied by; `None` finds the factor between known units that makes it fit.
    pub cad_scale: Option<f64>,
    /// Limits of the CAD reader.
    pub reading: ReadOptions,
    /// The smoother's settings.
    pub smoothing: smooth::Settings,
    /// A checkpoint file to go on from.
    pub resume: Option<PathBuf>,
}

impl Job {
    /// A job with the default settings.
    #[must_use]
    pub fn new(mesh: PathBuf, cad: PathBuf, linkage: Option<PathBuf>, order: Order) -> Job {
        Job {
            mesh,
            cad,
            linkage,
            patches: Choice::All,
            order,
            max_offset: 1e-3,
            freeze_linear: false,
            freeze_walls: false,
            direct: false,
            curve_layers: None,
            cad_scale: Some(1.0),
            reading: ReadOptions::default(),
            smoothing: smooth::Settings::default(),
            resume: None,
        }
    }

    /// What a checkpoint of this job belongs to.
    pub(crate) fn work(&self, elements: usize, straight: &[DVec3], displacement: &[DVec3]) -> Work {
        let smooth::Settings { threshold, alpha, max_sweeps: _, survey_factor, engine } = &self.smoothing;
        let held = (self.freeze_linear, self.freeze_walls, self.curve_layers, self.direct);
        let settings = format!("{:?}", (threshold, alpha, survey_factor, engine, held));
        Work::new(elements, straight, displacement, &settings)
    }
}

/// Steps of the pipeline, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)] // the names are those of the modules
pub enum Step {
    Read,
    Associate,
    Elevate,
    Project,
    Perturb,
    Smooth,
    Certify,
}

impl Step {
    /// All steps, in order.
    pub const ALL: [Step; 7] =
        [Step::Read, Step::Associate, Step::Elevate, Step::Project, Step::Perturb, Step::Smooth, Step::Certify];

    /// The step's word in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Step::Read => "read",
            Step::Associate => "associate",
            Step::Elevate => "elevate",
            Step::Project => "project",
            Step::Perturb => "perturb",
            Step::Smooth => "smooth",
            Step::Certify => "certify",
        }
    }
}

/// Who is told how the work goes on.
pub trait Observer {
    /// The steps from [`Step::Elevate`] to [`Step::Smooth`] begin, for a mesh of this order.
    fn order(&mut self, _order: Order) {}
    /// A step begins.
    fn step(&mut self, step: Step);
    /// The smoother finished a sweep; false ends it.
    fn progress(&mut self, progress: &smooth::Progress) -> bool;
    /// A state from which [`Job::resume`] goes on.
    fn checkpoint(&mut self, _work: &Work, _checkpoint: &Checkpoint) {}
}

/// Hands on what the smoother tells.
pub(crate) struct Told<'a> {
    pub(crate) observer: &'a mut dyn Observer,
    pub(crate) work: Work,
}

impl Watch for Told<'_> {
    fn progress(&mut self, progress: smooth::Progress) -> bool {
        self.observer.progress(&progress)
    }

    fn checkpoint(&mut self, checkpoint: &Checkpoint) {
        self.observer.checkpoint(&self.work, checkpoint);
    }
}

/// Why there is no curved mesh. Every message names the file it is about.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the causes say it
pub enum PipelineError {
    #[error(transparent)]
    Mesh(#[from] formats::Error),
    #[error(transparent)]
    Cad(#[from] cad::ReadError),
    #[error(transparent)]
    Linkage(#[from] LinkageError),
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    #[error("{mesh} and {cad}: {cause}", mesh = mesh.display(), cad = cad.display())]
    Associate { mesh: PathBuf, cad: PathBuf, cause: Box<AssociateError> },
    #[error("{mesh}: {cause}", mesh = mesh.display())]
    TooMany { mesh: PathBuf, cause: TooMany },
    #[error("{mesh}: {cause}", mesh = mesh.display())]
    UnknownPatch { mesh: PathBuf, cause: UnknownPatch },
    #[error("{mesh}: has no volume elements (tets, pyramids, prisms, hexes): nothing to curve", mesh = mesh.display())]
    NoVolume { mesh: PathBuf },
    #[error("{cad}: has no faces: nothing to curve onto", cad = cad.display())]
    NoFaces { cad: PathBuf },
    #[error("{mesh}: is of order {order} already; give the linear mesh", mesh = mesh.display())]
    NotLinear { mesh: PathBuf, order: Order },
    #[error(
        "{mesh}: the linear mesh is itself inverted in {count} elements: {listed}; mend it first",
        mesh = mesh.display()
    )]
    Inverted { mesh: PathBuf, count: usize, listed: String },
}

/// A curved mesh and how it came about.
#[derive(Debug)]
pub struct Curved {
    /// The mesh of order p.
    pub mesh: Mesh,
    /// The same, straight: the targets.
    pub straight: Vec<DVec3>,
    /// Linear nodes; they come first.
    pub linear_nodes: usize,
    /// What lies on which CAD group.
    pub association: Association,
    /// The linear mesh's two-dimensional elements.
    pub boundary: Boundary,
    /// Classifications, displacements and counts of the projection.
    pub projected: Projected,
    /// What the smoother did at the orders below.
    pub lower_orders: Vec<LowerOrder>,
    /// What the smoother did.
    pub smoothed: Smoothed,
    /// What is proven of the mesh.
    pub certificate: Certificate,
    /// What is proven of the faces on the CAD.
    pub walls: Walls,
    /// Boundary faces that are not on the CAD, so that the elements behind them are valid.
    pub given_up: Vec<GivenUp>,
    /// The CAD's unit, as its file names it.
    pub cad_unit: String,
    /// What the CAD was multiplied by.
    pub cad_scale: f64,
    /// Seconds a step, all orders together.
    pub seconds: Vec<(Step, f64)>,
}

/// Curves a mesh.
///
/// # Errors
/// [`PipelineError`]; nothing was written then.
pub fn curve(job: &Job, observer: &mut dyn Observer) -> Result<Curved, PipelineError> {
    let mut clock = Clock::new(observer);
    clock.step(Step::Read);
    if !formats::is_mesh(&job.mesh)? {
        read_linear(&job.mesh)?; // says so before the CAD is waited for
    }
    let (linear, model) = rayon::join(|| read_linear(&job.mesh), || read_model(job));
    let (mut linear, model) = (linear?, model?);

    clock.step(Step::Associate);
    let boundary = Boundary::new(&linear);
    let (tied, cad) = classify(job, &linear, &boundary, model)?;
    let mut association = tied.association;
    // The linkage file may know of pairs that the mesh file does not.
    let known: Vec<_> = linear.periodic.iter().map(|pair| pair.slave).collect();
    linear.periodic.extend(tied.candidates.periodic.into_iter().filter(|pair| !known.contains(&pair.slave)));

    let ascent = Ascent::new(job, linear, &boundary, &association)?;
    let Climb { level, mut below, lower_orders } = ascent.climb(&mut clock)?;
    let Level { mut ready, places, mut smoothed } = level;

    clock.step(Step::Certify);
    let ladder = Ladder::new(job, &boundary, &association, &mut ready, &mut below);
    let Climbed { given_up, proof: Proof { certificate, walls }, straight } =
        ladder.climb(places, &mut smoothed, |progress| clock.observer.progress(&progress));
    drop(below);
    let Ready { elevated, projected, notes, .. } = ready;
    association.notes.extend(notes);
    let Elevated { mesh, linear_nodes, .. } = elevated;
    Ok(Curved {
        mesh,
        straight,
        linear_nodes,
        association,
        boundary,
        projected,
        lower_orders,
        smoothed,
        certificate,
        walls,
        given_up,
        cad_unit: cad.model.unit().name.clone(),
        cad_scale: cad.scale,
        seconds: clock.finish(),
    })
}

/// What would lie on what: reads and associates, and goes no further.
///
/// # Errors
/// [`PipelineError`].
pub fn association(job: &Job) -> Result<Summary, PipelineError> {
    let linear = read_linear(&job.mesh)?;
    let boundary = Boundary::new(&linear);
    let (tied, cad) = classify(job, &linear, &boundary, read_model(job)?)?;
    let mut summary =
        associate::summary(&tied.source, &linear, &boundary, &cad.model, &tied.candidates, tied.inference.as_ref());
    summary.notes = linear.notes.iter().cloned().chain(tied.association.notes).collect();
    Ok(summary)
}

fn read_model(job: &Job) -> Result<Model, PipelineError> {
    let model = Model::read(&job.cad, &scaled(job, job.cad_scale.unwrap_or(1.0)))?;
    if model.faces().is_empty() {
        return Err(PipelineError::NoFaces { cad: job.cad.clone() });
    }
    Ok(model)
}

/// Reads the linear mesh and refuses what cannot be curved.
fn read_linear(path: &Path) -> Result<Mesh, PipelineError> {
    let mesh = path.to_owned();
    let linear = formats::read(path)?;
    if linear.order != Order::LINEAR {
        return Err(PipelineError::NotLinear { mesh, order: linear.order });
    }
    if linear.element_count(3) == 0 {
        return Err(PipelineError::NoVolume { mesh });
    }
    let certificate = certify::mesh(&linear, &linear.points, None, &certify::Settings::default());
    if !certificate.holds() {
        let tags: Vec<u64> = linear.blocks_of(3).flat_map(|(_, block)| block.tags.iter().copied()).collect();
        let some = certificate.failures.iter().take(LISTED).map(|f| format!("{} {}", f.cell, tags[f.element]));
        let count = certificate.failures.len();
        let more = if count > LISTED { ", ..." } else { "" };
        let listed = some.collect::<Vec<_>>().join(", ") + more;
        return Err(PipelineError::Inverted { mesh, count, listed });
    }
    Ok(linear)
}

fn scaled(job: &Job, scale: f64) -> ReadOptions {
    ReadOptions { scale, ..job.reading.clone() }
}

/// PeriodicConstraint the mesh to its CAD, read again in another unit where the job asks for the unit that fits.
fn classify(
    job: &Job,
    linear: &Mesh,
    boundary: &Boundary,
    model: Model,
) -> Result<(associate::Classified, Cad), PipelineError> {
    let straight = job.patches.straight(linear, boundary);
    let straight = straight.map_err(|cause| PipelineError::UnknownPatch { mesh: job.mesh.clone(), cause })?;
    let attempt = |model: &Model| -> Result<associate::Classified, PipelineError> {
        let choose = |candidates: &mut associate::Candidates| candidates.leave_straight(boundary, &straight);
        let linkage = job.linkage.as_deref().map(|path| [path, &job.mesh]);
        associate::classify(linkage, linear, boundary, model, job.max_offset, &choose).map_err(|error| match error {
            ClassifyError::Linkage(error) => error.into(),
            ClassifyError::Associate(cause) => refused(&job.mesh, &job.cad, cause),
        })
    };
    let first = attempt(&model);
    if let (None, Err(PipelineError::Associate { cause, .. })) = (job.cad_scale, &first)
        && let AssociateError::Scale { factor, .. } = **cause
    {
        let model = Model::read(&job.cad, &scaled(job, factor))?;
        return Ok((attempt(&model)?, Cad { model, scale: factor }));
    }
    Ok((first?, Cad { model, scale: job.cad_scale.unwrap_or(1.0) }))
}

/// The CAD as it was used.
struct Cad {
    model: Model,
    scale: f64,
}

fn refused(mesh: &Path, cad: &Path, cause: AssociateError) -> PipelineError {
    PipelineError::Associate { mesh: mesh.to_owned(), cad: cad.to_owned(), cause: Box::new(cause) }
}

/// Times the steps and tells the observer.
pub(crate) struct Clock<'a> {
    pub(crate) observer: &'a mut dyn Observer,
    current: Option<(Step, Instant)>,
    seconds: Vec<(Step, f64)>,
}

impl<'a> Clock<'a> {
    pub(crate) fn new(observer: &'a mut dyn Observer) -> Clock<'a> {
        Clock { observer, current: None, seconds: Vec::new() }
    }

    pub(crate) fn step(&mut self, step: Step) {
        self.close();
        self.current = Some((step, Instant::now()));
        self.observer.step(step);
    }

    fn close(&mut self) {
        if let Some((step, start)) = self.current.take() {
            let spent = start.elapsed().as_secs_f64();
            match self.seconds.iter_mut().find(|(own, _)| *own == step) {
                Some((_, seconds)) => *seconds += spent,
                None => self.seconds.push((step, spent)),
            }
        }
    }

    fn finish(mut self) -> Vec<(Step, f64)> {
        self.close();
        self.seconds
    }
}
