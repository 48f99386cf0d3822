//! Errors of the library as exceptions, by their cause.

use std::path::{Path, PathBuf};

use cad::ReadError;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sagitta::associate::{LinkError, LinkageError, ReadLinearError};
use sagitta::curve::{Error as CurveError, JobError};
use sagitta::formats;
use sagitta::validate::ValidateError;

/// The classes of `sagitta.errors`.
#[derive(Clone, Copy, Debug)]
enum Class {
    Error,
    File,
    Mesh,
    Cad,
    Linkage,
    Association,
}

impl Class {
    fn name(self) -> &'static str {
        match self {
            Class::Error => "Error",
            Class::File => "FileError",
            Class::Mesh => "MeshError",
            Class::Cad => "CadError",
            Class::Linkage => "LinkageError",
            Class::Association => "AssociationError",
        }
    }
}

/// Why something was not done.
#[derive(Debug)]
pub(crate) struct Failure {
    class: Class,
    message: String,
    file: Option<PathBuf>,
    place: Option<String>,
    /// The system's number of its error.
    number: Option<i32>,
}

impl Failure {
    fn new(class: Class, message: impl ToString) -> Failure {
        Failure { class, message: message.to_string(), file: None, place: None, number: None }
    }

    /// One that has no class of its own.
    pub(crate) fn told(message: impl ToString) -> Failure {
        Failure::new(Class::Error, message)
    }

    /// A mesh that cannot be worked with.
    pub(crate) fn of_mesh(message: impl ToString) -> Failure {
        Failure::new(Class::Mesh, message)
    }

    /// CAD that cannot be worked with.
    pub(crate) fn of_cad(file: &Path, message: impl ToString) -> Failure {
        Failure::new(Class::Cad, message).about(file)
    }

    fn about(mut self, file: &Path) -> Failure {
        self.file = Some(file.to_owned());
        self
    }

    fn at(mut self, place: impl ToString) -> Failure {
        self.place = Some(place.to_string());
        self
    }

    fn of_system(message: impl ToString, file: &Path, source: &std::io::Error) -> Failure {
        Failure { number: source.raw_os_error(), ..Failure::new(Class::File, message).about(file) }
    }

    /// The exception.
    pub(crate) fn raise(self, py: Python<'_>) -> PyErr {
        let message = self.message.clone();
        self.exception(py).unwrap_or_else(|error| {
            let told = PyRuntimeError::new_err(message);
            told.set_cause(py, Some(error)); // the package is not whole
            told
        })
    }

    fn exception(self, py: Python<'_>) -> PyResult<PyErr> {
        let class = py.import("sagitta.errors")?.getattr(self.class.name())?;
        let known = PyDict::new(py);
        known.set_item("file", self.file)?;
        known.set_item("place", self.place)?;
        if let Some(number) = self.number {
            known.set_item("errno", number)?;
        }
        Ok(PyErr::from_value(class.call((self.message,), Some(&known))?))
    }
}

impl From<formats::Error> for Failure {
    fn from(error: formats::Error) -> Failure {
        match &error {
            formats::Error::Io { file, source, .. } => Failure::of_system(&error, file, source),
            formats::Error::Content { file, place, .. } => Failure::of_mesh(&error).about(file).at(place),
            formats::Error::Format { file, .. } | formats::Error::Inexpressible { file, .. } => {
                Failure::of_mesh(&error).about(file)
            }
        }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Failure {
        match &error {
            ReadError::Open { path, source } => Failure::of_system(&error, path, source),
            ReadError::Scale { path, .. }
            | ReadError::Format { path, .. }
            | ReadError::Reader { path, .. }
            | ReadError::Refused { path, .. }
            | ReadError::Crashed { path, .. }
            | ReadError::Killed { path, .. }
            | ReadError::NoAnswer { path, .. }
            | ReadError::TimedOut { path, .. }
            | ReadError::OutOfMemory { path, .. }
            | ReadError::Empty { path } => Failure::of_cad(path, &error),
        }
    }
}

/// An exception on a linkage file, whose message names the place where there is one.
fn of_linkage(error: &LinkageError, file: Option<&Path>) -> Failure {
    let failure = Failure::new(Class::Linkage, error);
    let failure = match file {
        Some(file) => failure.about(file),
        None => failure,
    };
    match error {
        LinkageError::Read(cause) => match cause.position() {
            Some(position) => failure.at(position),
            None => failure,
        },
        LinkageError::Zone { place, .. }
        | LinkageError::Reference { place, .. }
        | LinkageError::Node { place, .. }
        | LinkageError::Periodic { place, .. }
        | LinkageError::Face { place, .. } => failure.at(place),
        LinkageError::Refused(_) | LinkageError::Empty { .. } | LinkageError::OtherMeshes { .. } => failure,
    }
}

/// The exception of a curving; `linkage` is the linkage file.
pub(crate) fn of_job(error: JobError, linkage: Option<&Path>) -> Failure {
    match error {
        JobError::Mesh(error) => error.into(),
        JobError::Cad(error) => error.into(),
        JobError::Curve { ref cause, .. } => match &**cause {
            CurveError::Linkage(cause) => of_linkage(cause, linkage),
            CurveError::Associate(_) => Failure::new(Class::Association, &error),
            CurveError::Checkpoint(_) | CurveError::TooMany(_) => Failure::told(&error),
            CurveError::NoFaces => Failure::new(Class::Cad, &error),
            _ => Failure::of_mesh(&error),
        },
    }
}

impl From<ValidateError> for Failure {
    fn from(error: ValidateError) -> Failure {
        match error {
            ValidateError::Mesh(error) => error.into(),
            ValidateError::Cad(error) => error.into(),
            ValidateError::Linkage(_) => Failure::new(Class::Linkage, &error),
        }
    }
}

impl From<ReadLinearError> for Failure {
    fn from(error: ReadLinearError) -> Failure {
        match error {
            ReadLinearError::Mesh(error) => error.into(),
            ReadLinearError::NotLinear { ref mesh, .. } => Failure::of_mesh(&error).about(mesh),
        }
    }
}

impl From<LinkError> for Failure {
    fn from(error: LinkError) -> Failure {
        match error {
            LinkError::Mesh(error) => error.into(),
            LinkError::Cad(error) => error.into(),
            LinkError::Nothing { .. } => Failure::new(Class::Association, &error),
            LinkError::TooLarge(_) | LinkError::Write(_) => Failure::told(&error),
        }
    }
}
