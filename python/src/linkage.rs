//! Linkage files: written and validated.

use std::path::PathBuf;

use pyo3::prelude::*;
use sagitta::associate::{LinkJob, Linked};
use sagitta::report::{Run, Told};
use sagitta::validate::Job;

use crate::curve::Source;
use crate::failure::Failure;
use crate::reading::Limits;
use crate::work;

/// Writes the linkage file of a mesh; gives what was associated as JSON and as text, and the file's text.
#[pyfunction]
#[allow(clippy::too_many_arguments)] // what `sagitta.link` hands on
pub(crate) fn link(
    py: Python<'_>,
    mesh: Source<'_>,
    name: PathBuf,
    cad: PathBuf,
    cad_scale: Option<f64>,
    tolerance: Option<f64>,
    by_tags: bool,
    limits: Limits,
) -> PyResult<(String, String, Vec<u8>)> {
    let reading = limits.reading(py, cad_scale.unwrap_or(1.0))?;
    let (reading, mesh_reading) = (reading.cad, reading.mesh);
    let job = LinkJob { mesh: mesh.name(name), cad, cad_scale, tolerance, by_tags, reading, mesh_reading };
    let mesh = mesh.memory();
    let linked = work::run(py, None, None, move |_| {
        let Linked { text, summary } = match mesh {
            Some(held) => job.run_on(held.mesh().clone()),
            None => job.run(),
        }?;
        Ok::<_, Failure>((
            serde_json::to_string(&Told { document: &summary, run: Run::ending_now() }).map_err(Failure::told)?,
            summary.to_string(),
            text,
        ))
    })?;
    linked.map_err(|failure| failure.raise(py))
}

/// Checks a linkage file, with its mesh and CAD as far as they are given; gives the findings as JSON and as text.
#[pyfunction]
pub(crate) fn validate(
    py: Python<'_>,
    linkage: PathBuf,
    mesh: Option<PathBuf>,
    cad: Option<PathBuf>,
    cad_scale: Option<f64>,
    tolerance: Option<f64>,
    limits: Limits,
) -> PyResult<(String, String)> {
    let reading = limits.reading(py, cad_scale.unwrap_or(1.0))?;
    let (reading, mesh_reading) = (reading.cad, reading.mesh);
    let job = Job { linkage, mesh, cad, tolerance, cad_scale, reading, mesh_reading };
    let found = work::run(py, None, None, move |_| {
        let validation = sagitta::validate::validate(&job)?;
        Ok::<_, Failure>((
            serde_json::to_string(&Told { document: &validation, run: Run::ending_now() }).map_err(Failure::told)?,
            validation.to_string(),
        ))
    })?;
    found.map_err(|failure| failure.raise(py))
}
