//! A curving from files.

use std::path::PathBuf;

use cad::{Model, ReadOptions};

use super::curvability::{self, spots};
use super::driver::{Curved, drive};
use super::error::{Error, JobError};
use super::input::{Associated, check_cad, checked};
use super::level::Case;
use super::observer::{Clock, Observer, Step};
use super::orders::projected;
use super::settings::Settings;
use crate::associate::{self, AssociateError, Classified, Linkage, OpenFace, Summary};
use crate::certify;
use crate::element::Order;
use crate::formats;
use crate::mesh::{Boundary, Mesh};

/// What is to be curved, and how.
#[derive(Clone, Debug)]
pub struct Job {
    /// The linear mesh.
    pub mesh: PathBuf,
    /// The CAD it was made on.
    pub cad: PathBuf,
    /// The MeshLink file that links the two; without it the mesh's entity tags do, or else geometry.
    pub linkage: Option<PathBuf>,
    /// What the CAD is multiplied by; `None` finds the factor between known units that makes it fit.
    pub cad_scale: Option<f64>,
    /// How the CAD is read: in this process, or by a reading program.
    pub reading: ReadOptions,
    /// How the mesh is read.
    pub mesh_reading: formats::ReadOptions,
    /// The solver that the curved mesh is for, and the file that it is to be given; a mesh that it cannot take is not curved.
    pub solver: Option<(PathBuf, &'static formats::Solver)>,
    /// What is asked for.
    pub settings: Settings,
}

/// What is known of a curving before it is begun.
#[derive(Debug)]
pub struct Preview {
    /// What would lie on what, and where the CAD leaves little room.
    pub summary: Summary,
    /// The linear mesh.
    pub linear: Mesh,
    /// Its boundary elements.
    pub boundary: Boundary,
    /// Those that belong to the CAD and would stay straight.
    pub open_faces: Vec<OpenFace>,
}

impl Job {
    /// A job with the default settings.
    #[must_use]
    pub fn new(mesh: PathBuf, cad: PathBuf, linkage: Option<PathBuf>, order: Order) -> Job {
        let (reading, settings) = (ReadOptions::default(), Settings::new(order));
        let mesh_reading = formats::ReadOptions::default();
        Job { mesh, cad, linkage, cad_scale: Some(1.0), reading, mesh_reading, solver: None, settings }
    }

    /// Reads the files and curves the mesh.
    ///
    /// # Errors
    /// [`JobError`]; nothing was written then.
    pub fn run(&self, observer: &mut dyn Observer) -> Result<Curved, JobError> {
        let mut clock = Clock::new(observer);
        clock.step(Step::Read);
        if !formats::is_mesh(&self.mesh)? {
            self.read_mesh()?; // says so before the CAD is waited for
        }
        let (linear, cad) = rayon::join(|| self.read_mesh(), || self.read_first());
        self.curve(linear?, cad?, clock)
    }

    /// As [`Job::run`], on a mesh that is in memory: [`Job::mesh`] is what messages, linkage file and report call it.
    ///
    /// # Errors
    /// Those of [`Job::run`].
    pub fn run_on(&self, linear: Mesh, observer: &mut dyn Observer) -> Result<Curved, JobError> {
        let mut clock = Clock::new(observer);
        clock.step(Step::Read);
        let linear = self.checked(linear)?;
        let cad = self.read_first()?;
        self.curve(linear, cad, clock)
    }

    /// The steps that follow reading.
    fn curve(&self, linear: Mesh, cad: Model, mut clock: Clock) -> Result<Curved, JobError> {
        clock.step(Step::Associate);
        let associate = |cad: &Model| self.associated(&linear, cad);
        let associated = self.scaled(cad, associate)?.0;
        let curved = drive(linear, associated, &self.settings, clock).map_err(|cause| self.error(cause))?;
        self.held(curved)
    }

    /// The mesh as the solver has it that it is for, proven anew where that is not the mesh that was made.
    fn held(&self, mut curved: Curved) -> Result<Curved, JobError> {
        let Some((file, solver)) = &self.solver else { return Ok(curved) };
        let Some(points) = formats::held(file, solver, &curved.mesh)? else { return Ok(curved) };
        let moved = curved.mesh.points().iter().zip(&points).filter(|(own, held)| own != held).count();
        if moved > 0 {
            curved.mesh.points_mut().copy_from_slice(&points);
            let linear = &curved.straight[..curved.linear_nodes];
            curved.certificate = certify::mesh(&curved.mesh, &points, Some(linear), &certify::Settings::default());
            let title = solver.title;
            curved.association.notes.push(format!(
                "{moved} nodes inside cells are where {title} makes them from the faces; that mesh is what is certified and written"
            ));
        }
        Ok(curved)
    }

    /// What would lie on what, and where the CAD leaves little room: reads, associates and projects, and goes no further.
    ///
    /// # Errors
    /// [`JobError`].
    pub fn association(&self) -> Result<Preview, JobError> {
        let linear = self.read_mesh()?;
        let associate = |cad: &Model| self.associated(&linear, cad);
        let (own, cad) = self.scaled(self.read_first()?, associate)?;
        let Classified { candidates, association, inference, source } = &own.classified;
        let mut summary = associate::summary(source, &linear, &own.boundary, &cad, candidates, inference.as_ref());
        summary.notes = linear.notes().iter().chain(&association.notes).cloned().collect();
        let case = Case { settings: &self.settings, boundary: &own.boundary, association };
        let level = projected(case, &linear, self.settings.order).map_err(|cause| self.error(cause))?;
        summary.spots = spots(&level).iter().map(|spot| curvability::report(&level, spot)).collect();
        let Associated { boundary, open_faces, .. } = own;
        Ok(Preview { summary, linear, boundary, open_faces })
    }

    fn read_mesh(&self) -> Result<Mesh, JobError> {
        self.checked(formats::read_with(&self.mesh, &self.mesh_reading)?)
    }

    /// A mesh that can be curved, and that the solver takes.
    fn checked(&self, linear: Mesh) -> Result<Mesh, JobError> {
        if let Some((file, solver)) = &self.solver {
            formats::check_solver(file, solver, &linear, self.settings.order)?;
        }
        checked(linear, self.settings.surface).map_err(|cause| self.error(cause))
    }

    /// The CAD, in its own unit where the one that fits is not known yet.
    fn read_first(&self) -> Result<Model, JobError> {
        self.read_cad(self.cad_scale.unwrap_or(1.0))
    }

    fn read_cad(&self, scale: f64) -> Result<Model, JobError> {
        Ok(Model::read(&self.cad, &ReadOptions { scale, ..self.reading.clone() })?)
    }

    fn associated(&self, linear: &Mesh, cad: &Model) -> Result<Associated, Error> {
        check_cad(linear, cad, self.settings.surface)?;
        Associated::new(linear, cad, self.read_linkage()?.as_ref(), &self.settings)
    }

    fn read_linkage(&self) -> Result<Option<Linkage>, Error> {
        let read = |path: &PathBuf| Linkage::read(path, &self.mesh);
        Ok(self.linkage.as_ref().map(read).transpose()?)
    }

    /// What `associate` makes of the CAD, read again in another unit where the job asks for the unit that fits.
    fn scaled<T>(&self, cad: Model, associate: impl Fn(&Model) -> Result<T, Error>) -> Result<(T, Model), JobError> {
        let named = |cause| self.error(cause);
        match associate(&cad) {
            Ok(associated) => Ok((associated, cad)),
            Err(Error::Associate(cause)) => match *cause {
                AssociateError::Scale { factor, .. } if self.cad_scale.is_none() => {
                    let cad = self.read_cad(factor)?;
                    Ok((associate(&cad).map_err(named)?, cad))
                }
                cause => Err(named(Error::Associate(Box::new(cause)))),
            },
            Err(cause) => Err(named(cause)),
        }
    }

    fn error(&self, cause: Error) -> JobError {
        JobError::new(cause, &self.mesh, &self.cad, self.linkage.as_deref())
    }
}
