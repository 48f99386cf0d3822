//! A child process that reads a file for its parent, because malformed files make the libraries that read them crash or hang.
//!
//! The program executes itself with a hidden subcommand. The child writes its answer to its standard output, within limits of
//! memory and time; whatever happens to it, the parent gets an answer. CAD files are read so, and mesh files whose library is C.

use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::time::Duration;

/// Variable in which the parent hands the memory limit (bytes) to the child.
const MEMORY_VARIABLE: &str = "SAGITTA_READER_MEMORY";

/// How lines of the child's standard error begin that tell of malformed things.
const WARNING_PREFIX: &str = "sagitta-warning ";

/// Bytes of the child's standard error that are looked at.
const ERRORS: u64 = 1 << 20;

/// What the child may use.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Wall time.
    pub timeout: Duration,
    /// Address space, in bytes.
    pub memory: u64,
}

/// What came of the child.
#[derive(Debug)]
pub struct Outcome {
    /// Its standard output.
    pub bytes: Vec<u8>,
    /// How it ended.
    pub status: ExitStatus,
    /// What it warned of on its standard error.
    pub warnings: Vec<String>,
}

/// Why there is no outcome.
#[derive(Debug, thiserror::Error)]
pub enum ChildError {
    /// It took longer than it may, and was ended.
    #[error("took longer than it may")]
    TimedOut {
        /// What it had warned of until then.
        warnings: Vec<String>,
    },
    /// It could not be run.
    #[error("cannot be run: {0}")]
    Run(#[from] io::Error),
}

/// Runs `program subcommand path` with these variables, to its end or the time limit.
///
/// # Errors
/// [`ChildError`]; a child that crashed is no error here: its [`Outcome::status`] tells.
pub fn run(
    program: &Path,
    subcommand: &str,
    path: &Path,
    variables: &[(&str, String)],
    limits: Limits,
) -> Result<Outcome, ChildError> {
    let mut child = Command::new(program)
        .arg(subcommand)
        .arg(path)
        .env(MEMORY_VARIABLE, limits.memory.to_string())
        .envs(variables.iter().map(|(name, value)| (OsStr::new(name), value)))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let (Some(mut pipe), Some(errors)) = (child.stdout.take(), child.stderr.take()) else {
        return Err(io::Error::other("it has no standard output").into());
    };
    let (sender, receiver) = mpsc::channel();
    let reading = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let result = pipe.read_to_end(&mut bytes).map(|_| bytes);
        let _ = sender.send(result); // the receiver has gone after a time-out
    });
    let listening = std::thread::spawn(move || warnings_in(errors));
    let Ok(bytes) = receiver.recv_timeout(limits.timeout) else {
        end(&mut child);
        let _ = reading.join();
        return Err(ChildError::TimedOut { warnings: listening.join().unwrap_or_default() });
    };
    let status = child.wait()?;
    Ok(Outcome { bytes: bytes?, status, warnings: listening.join().unwrap_or_default() })
}

/// Warnings among the first lines of the child's standard error; the rest is read and dropped, so that the child never waits.
fn warnings_in(mut errors: impl Read) -> Vec<String> {
    let mut bytes = Vec::new();
    let mut head = errors.by_ref().take(ERRORS);
    let _ = head.read_to_end(&mut bytes); // what was read before an error counts
    let _ = io::copy(&mut errors, &mut io::sink());
    let text = String::from_utf8_lossy(&bytes);
    text.lines().filter_map(|line| line.strip_prefix(WARNING_PREFIX)).map(str::to_owned).collect()
}

/// Ends the child and collects it; it may have ended by itself meanwhile.
fn end(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

/// In the child: keeps to the memory limit that the parent has set.
pub fn limit_memory() {
    let Some(bytes) = std::env::var(MEMORY_VARIABLE).ok().and_then(|text| text.parse().ok()) else { return };
    let maximum = getrlimit(Resource::As).maximum;
    let current = maximum.map_or(bytes, |maximum: u64| maximum.min(bytes));
    // a limit that the system refuses leaves the parent's time limit
    let _ = setrlimit(Resource::As, Rlimit { current: Some(current), maximum });
}

/// In the child: the pipe to the parent; whatever a library prints on standard output goes to `/dev/null` from here on.
#[must_use]
pub fn take_stdout() -> Option<File> {
    let pipe = rustix::io::dup(std::io::stdout()).ok()?;
    let null = File::options().write(true).open("/dev/null").ok()?;
    rustix::stdio::dup2_stdout(&null).ok()?;
    Some(File::from(pipe))
}
