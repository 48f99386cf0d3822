//! A child process that reads a file for its parent, because malformed files make the libraries that read them crash or hang.
//!
//! The program executes itself with a hidden subcommand. The child writes its answer to its standard output, within limits of
//! memory and time; whatever happens to it, the parent gets an answer. CAD files are read so, and mesh files whose library is C.
//!
//! It is in a process group of its own, so that what is sent to the parent's (Ctrl-C, `timeout`) is dealt with by the parent, and ends
//! when its parent does.

use rustix::process::{
    Pid, Resource, Rlimit, Signal, getpid, getppid, getrlimit, kill_process, kill_process_group, setrlimit,
};
use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, Read, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// Variable in which the parent hands the memory limit (bytes) to the child.
const MEMORY_VARIABLE: &str = "SAGITTA_READER_MEMORY";

/// Variable in which the parent hands its own number and the child's time (milliseconds) to the child.
const WATCH_VARIABLE: &str = "SAGITTA_READER_WATCH";

/// Variable that tells the number of threads.
const THREADS_VARIABLE: &str = "RAYON_NUM_THREADS";

/// Threads of the child at most: each takes up to 128 MB of the address space for the allocator alone.
const THREADS: usize = 8;

/// What the child has beyond the time after which the parent ends it: it ends itself only where the parent cannot.
const GRACE: Duration = Duration::from_secs(2);

/// Time between two looks of the child at its parent and the clock.
const LOOK: Duration = Duration::from_millis(500);

/// Time in which a child that hangs can say where it stands.
const ANSWER: Duration = Duration::from_millis(100);

/// Signals that a process is sent for what itself does: SIGILL, SIGTRAP, SIGABRT, SIGBUS, SIGFPE, SIGSEGV, SIGSYS.
const OWN_FAULTS: [i32; 7] = [4, 5, 6, 7, 8, 11, 31];

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
    /// Bytes that it may write to its standard output.
    pub output: u64,
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

impl Outcome {
    /// The signal by which someone else ended it: the system, which has no memory left, or a user.
    #[must_use]
    pub fn killed(&self) -> Option<i32> {
        self.status.signal().filter(|signal| !OWN_FAULTS.contains(signal))
    }
}

/// This very program, for [`run`]: the file that it was started from, also where an upgrade has put another in its place since.
#[must_use]
pub fn this_program() -> PathBuf {
    let own = PathBuf::from("/proc/self/exe");
    if own.exists() { own } else { std::env::current_exe().unwrap_or(own) }
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
    /// It wrote more than it may, and was ended.
    #[error("wrote more than it may")]
    TooMuch,
    /// It could not be run.
    #[error("cannot be run: {0}")]
    Run(#[from] io::Error),
}

impl ChildError {
    /// What to say of a child that [was killed](Outcome::killed).
    pub const KILLED: &str =
        "not by what is in the file: the system does so where memory runs out (dmesg tells), and users can; try again";
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
    let watch = format!("{} {}", getpid().as_raw_nonzero(), limits.timeout.saturating_add(GRACE).as_millis());
    let mut child = Command::new(program)
        .arg(subcommand)
        .arg(path)
        .process_group(0)
        .env(MEMORY_VARIABLE, limits.memory.to_string())
        .env(WATCH_VARIABLE, watch)
        .env(THREADS_VARIABLE, threads().to_string())
        .envs(variables.iter().map(|(name, value)| (OsStr::new(name), value)))
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    limit_memory_of(&child, limits.memory);
    let (Some(mut pipe), Some(errors)) = (child.stdout.take(), child.stderr.take()) else {
        return Err(io::Error::other("it has no standard output").into());
    };
    let (sender, receiver) = mpsc::channel();
    let reading = std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let result = pipe.by_ref().take(limits.output.saturating_add(1)).read_to_end(&mut bytes).map(|_| bytes);
        let _ = sender.send(result); // the receiver has gone after a time-out
    });
    let listening = std::thread::spawn(move || warnings_in(errors));
    let Ok(bytes) = receiver.recv_timeout(limits.timeout) else {
        ask_for_place(&child);
        end(&mut child);
        let _ = reading.join();
        return Err(ChildError::TimedOut { warnings: listening.join().unwrap_or_default() });
    };
    if bytes.as_ref().is_ok_and(|bytes| bytes.len() as u64 > limits.output) {
        end(&mut child);
        return Err(ChildError::TooMuch);
    }
    let status = child.wait()?;
    Ok(Outcome { bytes: bytes?, status, warnings: listening.join().unwrap_or_default() })
}

/// Threads of the child: as many as the environment says or there are cores, within the bound.
fn threads() -> usize {
    let told = std::env::var(THREADS_VARIABLE).ok().and_then(|text| text.parse().ok()).filter(|&number| number > 0);
    let cores = || std::thread::available_parallelism().map_or(1, usize::from);
    told.unwrap_or_else(cores).min(THREADS)
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

/// Has a child that hangs say where it stands, as a last warning; one that cannot ends.
fn ask_for_place(child: &Child) {
    if kill_process(Pid::from_child(child), Signal::XCPU).is_ok() {
        std::thread::sleep(ANSWER);
    }
}

/// Ends the child with what it may have started, and collects it; it may have ended by itself meanwhile.
fn end(child: &mut Child) {
    let _ = kill_process_group(Pid::from_child(child), Signal::KILL);
    let _ = child.wait();
}

/// Sets the memory limit of a child that does not do so itself.
fn limit_memory_of(child: &Child, bytes: u64) {
    let limit = Rlimit { current: Some(bytes), maximum: Some(bytes) };
    #[cfg(target_os = "linux")]
    let _ = rustix::process::prlimit(Some(rustix::process::Pid::from_child(child)), Resource::As, limit); // it may have ended
    #[cfg(not(target_os = "linux"))]
    let _ = (child, limit);
}

/// In the child, first of all: keeps to the limits that the parent has set, and ends with it.
pub fn keep_to_limits() {
    end_with_parent();
    limit_memory();
}

/// Has the child end at once when its parent ends, and by itself some time after its parent should have ended it. A child without a parent
/// that says so is left alone.
fn end_with_parent() {
    let Ok(watch) = std::env::var(WATCH_VARIABLE) else { return };
    let mut numbers = watch.split(' ').map(str::parse::<u64>);
    let (Some(Ok(parent)), Some(Ok(time))) = (numbers.next(), numbers.next()) else { return };
    let parent = i32::try_from(parent).ok().and_then(Pid::from_raw);
    // The system tells of the end of the parent's thread, which waits for the child.
    #[cfg(target_os = "linux")]
    let _ = rustix::process::set_parent_process_death_signal(Some(Signal::KILL));
    let (start, time) = (Instant::now(), Duration::from_millis(time));
    let watch = move || {
        while getppid() == parent && start.elapsed() < time {
            std::thread::sleep(LOOK);
        }
        let _ = kill_process(getpid(), Signal::KILL);
    };
    // Without a thread the signal of the system is left.
    let _ = std::thread::Builder::new().stack_size(1 << 16).spawn(watch);
}

fn limit_memory() {
    let Some(bytes) = std::env::var(MEMORY_VARIABLE).ok().and_then(|text| text.parse().ok()) else { return };
    let maximum = getrlimit(Resource::As).maximum;
    let current = maximum.map_or(bytes, |maximum: u64| maximum.min(bytes));
    // a limit that the system refuses leaves the parent's time limit
    let _ = setrlimit(Resource::As, Rlimit { current: Some(current), maximum });
}

/// In the child: a line for [`Outcome::warnings`].
pub fn warn(text: &str) {
    // Where the parent is gone there is no one to tell.
    let _ = writeln!(io::stderr(), "{WARNING_PREFIX}{}", text.escape_debug());
}

/// In the child: the pipe to the parent; whatever a library prints on standard output goes to `/dev/null` from here on.
#[must_use]
pub fn take_stdout() -> Option<File> {
    let pipe = rustix::io::dup(std::io::stdout()).ok()?;
    let null = File::options().write(true).open("/dev/null").ok()?;
    rustix::stdio::dup2_stdout(&null).ok()?;
    Some(File::from(pipe))
}
