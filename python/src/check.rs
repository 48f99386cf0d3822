//! Certifying meshes that others made.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use sagitta::certify::{self, Settings};
use sagitta::mesh::linear_positions;
use sagitta::report::{CheckReport, Run};
use sagitta::scene::Measures;

use crate::curve::Source;
use crate::failure::Failure;
use crate::mesh::Held;
use crate::reading::Limits;
use crate::work;

/// Certifies a mesh, against the linear mesh where one is given; gives the report as JSON and as text.
#[pyfunction]
pub(crate) fn check(
    py: Python<'_>,
    mesh: Source<'_>,
    name: PathBuf,
    linear: Option<Source<'_>>,
    limits: Limits,
) -> PyResult<(String, String)> {
    let reading = limits.reading(py, 1.0)?.mesh;
    let known = |source: &Source<'_>| (source.memory(), source.name(name.clone()));
    let (mesh, linear) = (known(&mesh), linear.as_ref().map(known));
    let checked = work::run(py, None, None, move |_| {
        let read = |(held, path): (Option<Arc<Held>>, PathBuf)| match held {
            Some(held) => Ok((held, path)),
            None => {
                sagitta::formats::read_with(&path, &reading).map(|mesh| (Arc::new(Held::Plain(Box::new(mesh))), path))
            }
        };
        let (mesh, path) = read(mesh)?;
        let mesh = mesh.mesh();
        let told = |why: &dyn std::fmt::Display| Failure::of_mesh(format!("{}: {why}", path.display()));
        let corners = match linear {
            Some(linear) => {
                let (linear, _) = read(linear)?;
                Some(linear_positions(mesh, linear.mesh()).map_err(|why| told(&why))?)
            }
            None => None,
        };
        let certificate = certify::check(mesh, mesh.points(), corners.as_deref(), &Settings::default());
        let certificate = certificate.map_err(|why| told(&why))?;
        let measures = Measures { j_over_jc: certificate.minima.clone(), ..Measures::of(mesh, corners.as_deref()) };
        let report = CheckReport::new(&path, mesh, &certificate, &measures, Run::ending_now());
        let json = serde_json::to_string(&report).map_err(Failure::told)?;
        Ok::<_, Failure>((json, report.to_string()))
    })?;
    checked.map_err(|failure| failure.raise(py))
}
