//! What is asked of a curving, as Python hands it over.

use std::num::NonZeroUsize;
use std::time::Duration;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sagitta::associate::Choice;
use sagitta::curve::Settings;
use sagitta::element::Order;
use sagitta::smooth;

/// A dictionary with these keys; see `sagitta.curve`.
#[derive(Clone, Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Wishes {
    order: usize,
    surface: bool,
    only: Option<Vec<String>>,
    straight: Option<Vec<String>>,
    by_tags: bool,
    tolerance: Option<f64>,
    max_offset: f64,
    freeze_linear: bool,
    freeze_walls: bool,
    direct: bool,
    curve_layers: Option<NonZeroUsize>,
    floor: f64,
    threshold: f64,
    alpha: Option<f64>,
    max_sweeps: usize,
    survey_factor: usize,
    time_limit: Option<f64>,
    pub(crate) threads: Option<usize>,
}

impl Wishes {
    /// The library's settings.
    ///
    /// # Errors
    /// `ValueError` where a number is out of its range.
    pub(crate) fn settings(&self) -> PyResult<Settings> {
        let wrong = |what: String| Err(PyValueError::new_err(what));
        let order = match Order::new(self.order) {
            Ok(order) if order > Order::LINEAR => order,
            _ => return wrong(format!("order={}: it is 2, 3 or 4", self.order)),
        };
        let fractions = [("floor", Some(self.floor)), ("threshold", Some(self.threshold)), ("alpha", self.alpha)];
        for (name, value) in fractions {
            if let Some(value) = value.filter(|value| !(0.0..=1.0).contains(value)) {
                return wrong(format!("{name}={value}: it is a number from 0 to 1"));
            }
        }
        for (name, value) in [("tolerance", self.tolerance), ("max_offset", Some(self.max_offset))] {
            if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
                return wrong(format!("{name}={value}: it is a positive number"));
            }
        }
        if !(1..=16).contains(&self.survey_factor) {
            return wrong(format!("survey_factor={}: it is 1 to 16", self.survey_factor));
        }
        if self.threads == Some(0) {
            return wrong("threads=0: it is at least 1".to_owned());
        }
        Ok(Settings {
            patches: self.patches()?,
            surface: self.surface,
            order,
            by_tags: self.by_tags,
            tolerance: self.tolerance,
            max_offset: self.max_offset,
            freeze_linear: self.freeze_linear,
            freeze_walls: self.freeze_walls,
            direct: self.direct,
            curve_layers: self.curve_layers,
            floor: self.floor,
            smoothing: smooth::Settings {
                threshold: self.threshold,
                alpha: self.alpha,
                max_sweeps: self.max_sweeps,
                survey_factor: self.survey_factor,
                engine: smooth::Engine::default(),
            },
            resume: None,
        })
    }

    fn patches(&self) -> PyResult<Choice> {
        match (&self.only, &self.straight) {
            (Some(_), Some(_)) => Err(PyValueError::new_err("only and straight exclude each other")),
            (Some(names), None) => Ok(Choice::Curve(names.clone())),
            (None, Some(names)) => Ok(Choice::Straight(names.clone())),
            (None, None) => Ok(Choice::All),
        }
    }

    /// The time after which smoothing ends.
    pub(crate) fn limit(&self) -> PyResult<Option<Duration>> {
        let limit = self.time_limit.map(Duration::try_from_secs_f64).transpose();
        limit.map_err(|error| PyValueError::new_err(format!("time_limit: {error}")))
    }
}
