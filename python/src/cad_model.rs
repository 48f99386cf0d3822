//! CAD, and closest points on it.

use std::path::PathBuf;
use std::sync::Arc;

use cad::{EntityId, Group, Model};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use sagitta::report::end_of;

use crate::failure::Failure;
use crate::reading::Limits;
use crate::work;

/// A CAD model; see `sagitta.Cad`.
#[pyclass(frozen)]
pub(crate) struct Cad {
    model: Arc<Model>,
}

/// The feet of points on CAD.
#[pyclass(frozen, get_all)]
pub(crate) struct Feet {
    points: Py<PyArray2<f64>>,
    distance: Py<PyArray1<f64>>,
    parameters: Py<PyArray2<f64>>,
    proven: Py<PyArray1<bool>>,
    entity: Vec<String>,
    end: Vec<&'static str>,
}

/// A face, edge or vertex: its number as a reference, what it is, its own reference in the file, its name.
type Entity = (String, String, String, String);

#[pymethods]
impl Cad {
    #[new]
    fn new(py: Python<'_>, path: PathBuf, scale: f64, limits: Limits) -> PyResult<Cad> {
        let reading = limits.reading(py, scale)?.cad;
        let read = work::run(py, None, None, move |_| Model::read(&path, &reading))?;
        read.map(|model| Cad { model: Arc::new(model) }).map_err(|error| Failure::from(error).raise(py))
    }

    /// The file.
    #[getter]
    fn path(&self) -> PathBuf {
        self.model.path().to_owned()
    }

    /// What the coordinates were multiplied by.
    #[getter]
    fn scale(&self) -> f64 {
        self.model.scale()
    }

    /// The file's unit.
    #[getter]
    fn unit(&self) -> String {
        self.model.unit().name.clone()
    }

    /// Opposite corners of the box around it.
    #[getter]
    fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        let bounds = self.model.bounds();
        (bounds.min.to_array(), bounds.max.to_array())
    }

    /// Its faces.
    #[getter]
    fn faces(&self) -> Vec<Entity> {
        let faces = self.model.faces().iter();
        faces.map(|own| self.entity(own.id.into(), own.kind.to_string())).collect()
    }

    /// Its edges.
    #[getter]
    fn edges(&self) -> Vec<Entity> {
        let edges = self.model.edges().iter();
        edges.map(|own| self.entity(own.id.into(), own.kind.to_string())).collect()
    }

    /// Named groups and their members.
    #[getter]
    fn groups(&self) -> Vec<(String, Vec<String>)> {
        let name = |name: &str, reference: &str| if name.is_empty() { reference } else { name }.to_owned();
        let groups = self.model.groups().iter();
        let members = |members: &[EntityId]| members.iter().map(ToString::to_string).collect();
        groups.map(|own| (name(&own.name, &own.reference), members(&own.members))).collect()
    }

    /// Closest points on some entities, on all faces and free edges where none are named.
    fn project(&self, py: Python<'_>, points: PyReadonlyArray2<'_, f64>, references: Vec<String>) -> PyResult<Feet> {
        let entities = self.model.select(&references).map_err(|error| PyKeyError::new_err(error.to_string()))?;
        let points: Vec<_> = points.as_array().rows().into_iter().map(|x| glam::dvec3(x[0], x[1], x[2])).collect();
        let model = self.model.clone();
        let feet = work::run(py, None, None, move |_| {
            Group::of(&model, &entities).map(|group| group.closest_batch(&points, &mut []))
        })?;
        let feet = feet.map_err(|error| Failure::of_cad(self.model.path(), error).raise(py))?;
        Feet::new(py, &feet)
    }
}

impl Cad {
    fn entity(&self, id: EntityId, kind: String) -> Entity {
        let label = self.model.label(id);
        let (reference, name) = label.map_or_else(Default::default, |own| (own.reference.clone(), own.name.clone()));
        (id.to_string(), kind, reference, name)
    }
}

impl Feet {
    /// The feet as arrays; those that there are not are NaN.
    fn new(py: Python<'_>, feet: &[Option<cad::Foot>]) -> PyResult<Feet> {
        let (mut points, mut parameters) = (Vec::with_capacity(3 * feet.len()), Vec::with_capacity(2 * feet.len()));
        for foot in feet {
            points.extend(foot.as_ref().map_or([f64::NAN; 3], |foot| foot.point.to_array()));
            parameters.extend(foot.as_ref().and_then(|foot| foot.parameters).unwrap_or([f64::NAN; 2]));
        }
        let distance = feet.iter().map(|foot| foot.as_ref().map_or(f64::NAN, |foot| foot.distance)).collect();
        let proven = feet.iter().map(|foot| foot.as_ref().is_some_and(cad::Foot::is_proven)).collect();
        let entity = |foot: &Option<cad::Foot>| foot.as_ref().map_or_else(String::new, |foot| foot.entity.to_string());
        Ok(Feet {
            points: PyArray1::from_vec(py, points).reshape([feet.len(), 3])?.unbind(),
            distance: PyArray1::from_vec(py, distance).unbind(),
            parameters: PyArray1::from_vec(py, parameters).reshape([feet.len(), 2])?.unbind(),
            proven: PyArray1::from_vec(py, proven).unbind(),
            entity: feet.iter().map(entity).collect(),
            end: feet.iter().map(|foot| foot.as_ref().map_or("", end_of)).collect(),
        })
    }
}
