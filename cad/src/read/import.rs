//! Reading a CAD file: in a child process, because malformed files make OCCT crash or hang.

use crate::child::{self, ChildError, Limits, Outcome};
use crate::model::{Model, SourceFormat};
use crate::read::assemble;
use crate::read::payload::{self, Answer};
use crate::read::reader::{READER_SUBCOMMAND, SCALE_VARIABLE};
use opencascade_sys as sys;
use std::io;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::ExitStatus;
use std::time::Duration;
use thiserror::Error;

/// Scale of the model, limits of the reading child, and which program it is.
#[derive(Clone, Debug)]
pub struct ReadOptions {
    /// Wall time after which the child is ended; default 300 s.
    pub timeout: Duration,
    /// Address space of the child in bytes; default 4 GB.
    pub memory_limit: u64,
    /// Program that calls [`serve_reader`](crate::serve_reader) when its first argument is [`READER_SUBCOMMAND`]; default this very program.
    pub reader: PathBuf,
    /// Factor of all coordinates, default 1: the model is handed out in the unit of the file times this (a file in mm with 0.001 comes in m).
    /// Tolerances and boxes follow; [`Model::unit`] still tells the unit of the file.
    pub scale: f64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        let reader = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("/proc/self/exe"));
        Self { timeout: Duration::from_secs(300), memory_limit: 4 << 30, reader, scale: 1.0 }
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
    #[error("{}: not a CAD file: neither STEP nor IGES nor BREP by its content", path.display())]
    Format {
        /// The CAD file.
        path: PathBuf,
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
    /// [`ReadError`]: also when OCCT crashes, hangs or eats up the memory, which happens to the child process only.
    pub fn read(path: &Path, options: &ReadOptions) -> Result<Self, ReadError> {
        let owned = || path.to_path_buf();
        match crate::read::format::detect(path) {
            Err(source) => return Err(ReadError::Open { path: owned(), source }),
            Ok(None) => return Err(ReadError::Format { path: owned() }),
            Ok(Some(SourceFormat::Iges)) if !crate::read::format::iges_is_whole(path).unwrap_or(true) => {
                let cause = "the file is cut short: its terminate section is missing".to_owned();
                return Err(ReadError::Refused { path: owned(), cause });
            }
            Ok(Some(_)) => {}
        }
        if !(options.scale.is_finite() && options.scale > 0.0) {
            return Err(ReadError::Scale { path: owned(), scale: options.scale });
        }
        let Outcome { bytes, status, warnings } = run(path, options)?;
        let refused = |cause: String| ReadError::Refused { path: owned(), cause };
        match payload::read(&bytes) {
            Some((Answer::Model(description), shape)) => {
                let shape = sys::shape_from_bytes(shape).map_err(|error| refused(error.to_string()))?;
                assemble::model(path, &shape, description, options.scale).map_err(refused)
            }
            Some((Answer::Failure(cause), _)) if is_memory(&cause) => {
                Err(ReadError::OutOfMemory { path: owned(), limit: options.memory_limit })
            }
            Some((Answer::Failure(cause), _)) if cause.starts_with("no face") => {
                Err(ReadError::Empty { path: owned() })
            }
            Some((Answer::Failure(cause), _)) => Err(refused(cause + &suspects(&warnings))),
            // Rust's allocator aborts where C++ throws
            None if status.signal() == Some(6) => {
                Err(ReadError::OutOfMemory { path: owned(), limit: options.memory_limit })
            }
            None => Err(ReadError::Crashed { path: owned(), status, warnings }),
        }
    }
}

fn is_memory(cause: &str) -> bool {
    cause.contains("bad_alloc") || cause.contains("Standard_OutOfMemory")
}

/// Runs the child to its end or the time limit; gives what it wrote.
fn run(path: &Path, options: &ReadOptions) -> Result<Outcome, ReadError> {
    let limits = Limits { timeout: options.timeout, memory: options.memory_limit };
    let scale = (SCALE_VARIABLE, options.scale.to_string());
    child::run(&options.reader, READER_SUBCOMMAND, path, &[scale], limits).map_err(|error| match error {
        ChildError::TimedOut { warnings } => {
            ReadError::TimedOut { path: path.to_path_buf(), limit: options.timeout, warnings }
        }
        ChildError::Run(source) => {
            ReadError::Reader { path: path.to_path_buf(), reader: options.reader.clone(), source }
        }
    })
}
