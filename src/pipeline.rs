//! The order of the steps, from files in to a curved mesh and its report.

use std::path::{Path, PathBuf};
use std::time::Instant;

use cad::{Model, ReadOptions};
use glam::DVec3;

use crate::associate::{self, AssociateError, Association, Boundary, Claims, LinkageError};
use crate::element::Order;
use crate::elevate::{Elevated, elevate};
use crate::formats;
use crate::mesh::{Mesh, TooMany};
use crate::perturb::perturb;
use crate::project::{CadConstraint, Projected, project};
use crate::smooth::{self, Problem, Smoothed, smooth};

/// What is to be curved, and how.
#[derive(Clone, Debug)]
pub struct Job {
    /// The linear mesh.
    pub mesh: PathBuf,
    /// The CAD it was made on.
    pub cad: PathBuf,
    /// The MeshLink file that ties the two together; without it the mesh's entity tags do.
    pub linkage: Option<PathBuf>,
    /// Order of the curved mesh, 2 to 4.
    pub order: Order,
    /// How far a linear node may be from its CAD entity; share of the mesh's box. Default 1e-3.
    pub max_offset: f64,
    /// Keep all linear nodes where they are.
    pub freeze_linear: bool,
    /// Keep nodes on curved walls where projection put them.
    pub freeze_walls: bool,
    /// Limits and unit of the CAD reader.
    pub reading: ReadOptions,
    /// The smoother's settings.
    pub smoothing: smooth::Settings,
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
}

/// Who is told how the work goes on.
pub trait Observer {
    /// A step begins.
    fn step(&mut self, step: Step);
    /// The smoother finished a sweep.
    fn progress(&mut self, progress: &smooth::Progress);
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
    #[error("{mesh} and {cad}: {cause}", mesh = mesh.display(), cad = cad.display())]
    Associate { mesh: PathBuf, cad: PathBuf, cause: AssociateError },
    #[error(transparent)]
    TooMany(#[from] TooMany),
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
    /// Hosts, displacements and counts of the projection.
    pub projected: Projected,
    /// What the smoother did.
    pub smoothed: Smoothed,
    /// Seconds a step.
    pub seconds: Vec<(Step, f64)>,
}

/// Curves a mesh.
///
/// # Errors
/// [`PipelineError`]; nothing was written then.
pub fn curve(job: &Job, observer: &mut dyn Observer) -> Result<Curved, PipelineError> {
    let mut clock = Clock::new(observer);
    clock.step(Step::Read);
    let linear = formats::read(&job.mesh)?;
    let model = Model::read(&job.cad, &job.reading)?;

    clock.step(Step::Associate);
    let boundary = Boundary::new(&linear);
    let claims = match &job.linkage {
        Some(path) => associate::read_linkage(path, &linear, &boundary, &model)?,
        None => Claims::by_tags(&linear, &boundary, &model),
    };
    let association = associate::associate(&linear, &boundary, &model, &claims, job.max_offset)
        .map_err(|cause| refused(&job.mesh, &job.cad, cause))?;

    clock.step(Step::Elevate);
    let mut elevated = elevate(&linear, job.order)?;

    clock.step(Step::Project);
    let projected = project(&elevated, &boundary, &association, job.freeze_linear);

    clock.step(Step::Perturb);
    let mut places = perturb(&elevated, &boundary, &association, &projected);

    clock.step(Step::Smooth);
    let straight = elevated.mesh.points.clone();
    let problem = Problem::new(&elevated.mesh, &straight);
    let constraint =
        CadConstraint::new(&association, &projected, elevated.linear_nodes, job.freeze_walls, job.freeze_linear);
    let smoothed = smooth(&problem, &constraint, &job.smoothing, &mut places, |progress| {
        clock.observer.progress(&progress);
        true
    });
    elevated.mesh.points = places;
    let seconds = clock.finish();
    let Elevated { mesh, linear_nodes, .. } = elevated;
    Ok(Curved { mesh, straight, linear_nodes, association, projected, smoothed, seconds })
}

fn refused(mesh: &Path, cad: &Path, cause: AssociateError) -> PipelineError {
    PipelineError::Associate { mesh: mesh.to_owned(), cad: cad.to_owned(), cause }
}

/// Times the steps and tells the observer.
struct Clock<'a> {
    observer: &'a mut dyn Observer,
    current: Option<(Step, Instant)>,
    seconds: Vec<(Step, f64)>,
}

impl<'a> Clock<'a> {
    fn new(observer: &'a mut dyn Observer) -> Clock<'a> {
        Clock { observer, current: None, seconds: Vec::new() }
    }

    fn step(&mut self, step: Step) {
        self.close();
        self.current = Some((step, Instant::now()));
        self.observer.step(step);
    }

    fn close(&mut self) {
        if let Some((step, start)) = self.current.take() {
            self.seconds.push((step, start.elapsed().as_secs_f64()));
        }
    }

    fn finish(mut self) -> Vec<(Step, f64)> {
        self.close();
        self.seconds
    }
}
