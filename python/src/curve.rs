//! Curving.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use sagitta::curve::{Job, Trace};

use crate::failure::of_job;
use crate::mesh::{Curving, Held, Mesh, solver_named};
use crate::reading::Limits;
use crate::settings::Wishes;
use crate::work::{self, Follower};

/// Where the linear mesh comes from: a file, or a mesh in memory.
#[derive(FromPyObject)]
pub(crate) enum Source<'py> {
    Memory(Bound<'py, Mesh>),
    File(PathBuf),
}

impl Source<'_> {
    /// What messages, linkage files and reports call it.
    pub(crate) fn name(&self, name: PathBuf) -> PathBuf {
        match self {
            Source::Memory(_) => name,
            Source::File(path) => path.clone(),
        }
    }

    /// The mesh, if it is in memory.
    pub(crate) fn memory(&self) -> Option<Arc<Held>> {
        match self {
            Source::Memory(mesh) => Some(mesh.get().held.clone()),
            Source::File(_) => None,
        }
    }
}

/// Curves a linear mesh onto its CAD; `name` is what a mesh in memory is called.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // what `sagitta.curve` hands on
pub(crate) fn curve(
    py: Python<'_>,
    mesh: Source<'_>,
    name: PathBuf,
    cad: PathBuf,
    cad_scale: Option<f64>,
    linkage: Option<PathBuf>,
    wishes: Wishes,
    limits: Limits,
    target: Option<(PathBuf, String)>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Mesh> {
    let reading = limits.reading(py, cad_scale.unwrap_or(1.0))?;
    let solver = target.map(|(file, solver)| Ok::<_, PyErr>((file, solver_named(&solver)?))).transpose()?;
    let job = Job {
        mesh: mesh.name(name),
        cad,
        linkage,
        cad_scale,
        reading: reading.cad,
        mesh_reading: reading.mesh,
        solver,
        settings: wishes.settings()?,
    };
    let (limit, order, linear) = (wishes.limit()?, job.settings.order, mesh.memory());
    let curved = work::run(py, wishes.threads, progress.as_ref(), move |link| {
        let mut follower = Follower::new(link, limit, order);
        let mut trace = Trace::new(&mut follower);
        let curved = match linear {
            Some(held) => job.run_on(held.mesh().clone(), &mut trace),
            None => job.run(&mut trace),
        };
        match curved {
            Ok(curved) => {
                let sweeps = trace.sweeps(&curved.smoothed);
                Ok(Held::Curved(Box::new(Curving { curved, job, sweeps })))
            }
            Err(error) => Err(of_job(error, job.linkage.as_deref())),
        }
    })?;
    curved.map(Mesh::new).map_err(|failure| failure.raise(py))
}
