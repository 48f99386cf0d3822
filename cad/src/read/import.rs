//! Reading a CAD file: in this process or, as malformed files make OCCT crash or hang, in a child.

use crate::child::{self, ChildError, Limits, Outcome};
use crate::model::{Model, SourceFormat};
use crate::read::assemble;
use crate::read::payload::{self, Answer};
use crate::read::reader::{self, READER_SUBCOMMAND, SCALE_VARIABLE};
use opencascade_sys as sys;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::time::Duration;
use thiserror::Error;

/// How a CAD file is read.
#[derive(Clone, Debug)]
pub struct ReadOptions {
    /// Factor of all coordinates, default 1: the model is handed out in the unit of the file times this (a file in mm with 0.001 comes in m).
    /// Tolerances and boxes follow; [`Model::unit`] still tells the unit of the file.
    pub scale: f64,
    /// The program that parses the file in a process of its own; default `None`: this process parses it.
    ///
    /// Malformed files make OCCT dereference null, run for ever or eat up the memory; without a reader that happens to this process, and
    /// nothing limits it. Files from outside should be read by a [`Reader`].
    pub reader: Option<Reader>,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self { scale: 1.0, reader: None }
    }
}

/// A program that parses CAD files for this one, and what it may use for one file.
///
/// It is started as `program __read-cad FILE` and must answer [`READER_SUBCOMMAND`] by calling [`serve_reader`](crate::serve_reader) and
/// nothing else. That may be the host itself, if its `main` begins so, or the crate's own `cad-reader`.
#[derive(Clone, Debug)]
pub struct Reader {
    /// The program.
    pub program: PathBuf,
    /// Wall time after which it is ended; by default 300 s.
    pub timeout: Duration,
    /// Address space in bytes; by default 4 GB.
    pub memory_limit: u64,
}

impl Reader {
    /// A program, with the default limits.
    pub fn new(program: impl Into<PathBuf>) -> Self {
        Self { program: program.into(), timeout: Duration::from_secs(300), memory_limit: 4 << 30 }
    }
}

/// Why a CAD file could not be read. Every variant names the file.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The file cannot be opened.
    #[error("{}: cannot be opened: {source}", path.display())]
    Open {
        /// The CAD file.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// [`ReadOptions::scale`] is no factor.
    #[error("{}: a scale of {scale} is not possible: it must be finite and greater than 0", path.display())]
    Scale {
        /// The CAD file.
        path: PathBuf,
        /// What was asked for.
        scale: f64,
    },
    /// Neither STEP nor IGES nor BREP by its content.
    #[error("{}: not a CAD file: neither STEP nor IGES nor BREP by its content{}", path.display(), instead.map_or_else(String::new, |told| format!(" ({told})")))]
    Format {
        /// The CAD file.
        path: PathBuf,
        /// What it seems to be, and what to do.
        instead: Option<&'static str>,
    },
    /// The reading program cannot be started.
    #[error("{}: the reading process {} cannot be run: {source}", path.display(), reader.display())]
    Reader {
        /// The CAD file.
        path: PathBuf,
        /// The program.
        reader: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// OCCT understood the file so far as to refuse it.
    #[error("{}: OpenCASCADE cannot read it: {cause}", path.display())]
    Refused {
        /// The CAD file.
        path: PathBuf,
        /// What OCCT said.
        cause: String,
    },
    /// OCCT crashed on the file.
    #[error("{}: OpenCASCADE crashed while reading it ({status}): the file is malformed, e.g. has dangling references{}", path.display(), suspects(warnings))]
    Crashed {
        /// The CAD file.
        path: PathBuf,
        /// Signal or exit code of the child.
        status: ExitStatus,
        /// What OCCT's checks said of entities before it crashed.
        warnings: Vec<String>,
    },
    /// Someone ended the reading process: the system, for want of memory, or a user.
    #[error("{}: the reading process was killed ({status}); {}", path.display(), ChildError::KILLED)]
    Killed {
        /// The CAD file.
        path: PathBuf,
        /// Signal of the child.
        status: ExitStatus,
    },
    /// The reading program ended well without an answer.
    #[error("{}: the reading process {} gave no answer: it is no reader of this version; start again", path.display(), reader.display())]
    NoAnswer {
        /// The CAD file.
        path: PathBuf,
        /// The program.
        reader: PathBuf,
    },
    /// Reading took too long.
    #[error("{}: reading took longer than {} s and was ended: a malformed file, or raise the time limit{}", path.display(), limit.as_secs_f64(), suspects(warnings))]
    TimedOut {
        /// The CAD file.
        path: PathBuf,
        /// The limit.
        limit: Duration,
        /// What OCCT's checks said of entities until then.
        warnings: Vec<String>,
    },
    /// Reading needed too much memory.
    #[error("{}: reading needs more than {} MB of memory: a malformed file, or raise the limit", path.display(), limit >> 20)]
    OutOfMemory {
        /// The CAD file.
        path: PathBuf,
        /// The limit in bytes.
        limit: u64,
    },
    /// Nothing to project on.
    #[error("{}: the file holds no face and no edge", path.display())]
    Empty {
        /// The CAD file.
        path: PathBuf,
    },
}

/// The first of the entities that may have been the cause.
fn suspects(warnings: &[String]) -> String {
    let first: Vec<&str> = warnings.iter().take(3).map(String::as_str).collect();
    if first.is_empty() { String::new() } else { format!("; {} malformed: {}", warnings.len(), first.join("; ")) }
}

impl Model {
    /// Reads a STEP, IGES or BREP file (by content; EGADS files are BREP with a trailer). All lengths come in the unit of the file
    /// times [`ReadOptions::scale`].
    ///
    /// # Errors
    /// [`ReadError`]: with [`ReadOptions::reader`] also when OCCT crashes, hangs or eats up the memory, which happens to that process only.
    pub fn read(path: &Path, options: &ReadOptions) -> Result<Self, ReadError> {
        let owned = || path.to_path_buf();
        match crate::read::format::detect(path) {
            Err(source) => return Err(ReadError::Open { path: owned(), source }),
            Ok(None) => {
                let instead = crate::read::format::foreign(path).unwrap_or_default();
                return Err(ReadError::Format { path: owned(), instead });
            }
            Ok(Some(SourceFormat::Iges)) if !crate::read::format::iges_is_whole(path).unwrap_or(true) => {
                let cause = "the file is cut short: its terminate section is missing".to_owned();
                return Err(ReadError::Refused { path: owned(), cause });
            }
            Ok(Some(_)) => {}
        }
        if !(options.scale.is_finite() && options.scale > 0.0) {
            return Err(ReadError::Scale { path: owned(), scale: options.scale });
        }
        match &options.reader {
            None => reader::read_here(path, options.scale).map_err(|cause| of_cause(path, cause)),
            Some(reader) => read_by(reader, path, options.scale),
        }
    }
}

fn of_cause(path: &Path, cause: String) -> ReadError {
    let path = path.to_path_buf();
    if cause.starts_with("no face") { ReadError::Empty { path } } else { ReadError::Refused { path, cause } }
}

/// What the child made of a file.
fn read_by(reader: &Reader, path: &Path, scale: f64) -> Result<Model, ReadError> {
    let owned = || path.to_path_buf();
    let out_of_memory = || ReadError::OutOfMemory { path: owned(), limit: reader.memory_limit };
    let outcome = run(reader, path, scale)?;
    let killed = outcome.killed().is_some();
    let Outcome { bytes, status, warnings } = outcome;
    match payload::read(&bytes) {
        Some((Answer::Model(description), shape)) => {
            let refused = |cause: String| ReadError::Refused { path: owned(), cause };
            let shape = sys::shape_from_bytes(shape).map_err(|error| refused(error.to_string()))?;
            assemble::model(path, &shape, description, scale).map_err(refused)
        }
        Some((Answer::Failure(cause), _)) if is_memory(&cause) => Err(out_of_memory()),
        Some((Answer::Failure(cause), _)) => Err(of_cause(path, cause + &suspects(&warnings))),
        // Rust's allocator aborts where C++ throws
        None if killed => Err(ReadError::Killed { path: owned(), status }),
        None if status.success() => Err(ReadError::NoAnswer { path: owned(), reader: reader.program.clone() }),
        None if status.signal() == Some(6) => Err(out_of_memory()),
        None => Err(ReadError::Crashed { path: owned(), status, warnings }),
    }
}

fn is_memory(cause: &str) -> bool {
    cause.contains("bad_alloc") || cause.contains("Standard_OutOfMemory")
}

/// Runs the child to its end or the time limit; gives what it wrote.
fn run(reader: &Reader, path: &Path, scale: f64) -> Result<Outcome, ReadError> {
    let limits = Limits { timeout: reader.timeout, memory: reader.memory_limit, output: reader.memory_limit };
    let scale = (SCALE_VARIABLE, scale.to_string());
    child::run(&reader.program, READER_SUBCOMMAND, path, &[scale], limits).map_err(|error| match error {
        ChildError::TimedOut { warnings } => {
            ReadError::TimedOut { path: path.to_path_buf(), limit: reader.timeout, warnings }
        }
        ChildError::TooMuch => ReadError::OutOfMemory { path: path.to_path_buf(), limit: reader.memory_limit },
        ChildError::Run(source) => {
            ReadError::Reader { path: path.to_path_buf(), reader: reader.program.clone(), source }
        }
    })
}
