//! How files are read: CAD and CGNS by the program inside the package.

use std::path::PathBuf;
use std::time::Duration;

use cad::Reader;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use sagitta::formats;

use crate::failure::Failure;

/// What reading files may use; a dictionary with these keys.
#[derive(Clone, Debug, FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Limits {
    /// Seconds that reading the CAD may take.
    cad_timeout: f64,
    /// Bytes that reading one file may take; by default half of the machine's.
    memory_limit: Option<u64>,
}

/// How the files of one call are read.
pub(crate) struct Reading {
    pub(crate) cad: cad::ReadOptions,
    pub(crate) mesh: formats::ReadOptions,
}

impl Limits {
    /// How files are read within these limits.
    pub(crate) fn reading(&self, py: Python<'_>, cad_scale: f64) -> PyResult<Reading> {
        let program = program(py)?;
        let reader = Reader::new(program.clone());
        let memory_limit = self.memory_limit.unwrap_or_else(|| reader.memory_limit.min(cad::memory::half_of_machine()));
        let timeout = Duration::try_from_secs_f64(self.cad_timeout).map_err(|error| {
            pyo3::exceptions::PyValueError::new_err(format!("cad_timeout={}: {error}", self.cad_timeout))
        })?;
        let reader = Reader { timeout, memory_limit, ..reader };
        Ok(Reading {
            cad: cad::ReadOptions { scale: cad_scale, reader: Some(reader) },
            mesh: formats::ReadOptions {
                reader: Some(program),
                memory_limit: self.memory_limit,
                ..formats::ReadOptions::default()
            },
        })
    }
}

/// The program `bin/sagitta` of the package.
fn program(py: Python<'_>) -> PyResult<PathBuf> {
    static PROGRAM: PyOnceLock<PathBuf> = PyOnceLock::new();
    let found = PROGRAM.get_or_try_init(py, || {
        let package: PathBuf = py.import("sagitta")?.filename()?.extract()?;
        let program = package.with_file_name("bin").join("sagitta");
        if program.is_file() {
            return Ok(program);
        }
        let what = "the program that reads CAD is missing from the package: install sagitta again";
        Err(Failure::told(format!("{}: {what}", program.display())).raise(py))
    });
    found.cloned()
}
