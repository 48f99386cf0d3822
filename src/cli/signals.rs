//! Signals that ask the program to end: an interrupt (Ctrl-C), `kill`, the end of a terminal or a session.
//!
//! While there is nothing to keep the first of them ends the program. From [`heed`] on the first is a wish that the command looks for, and
//! the second ends the program. Signals at nearly the same time are one wish: `timeout` sends one to the program and one to its group.
//! Where the result has its name already the program ends with what the result is worth, not as interrupted.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use signal_hook::low_level::{exit, signal_name};

use super::exit::{DONE, INTERRUPTED, SIDE_FILE};
use super::output::message;
use crate::formats;

/// Signals so soon after the first wish are the same wish.
const ONE_WISH: Duration = Duration::from_secs(1);

/// How long the last message may take: whoever reads stderr may have stopped reading.
const LAST_MESSAGE: Duration = Duration::from_millis(500);

/// Whether the command looks for the first wish.
static HEEDED: AtomicBool = AtomicBool::new(false);

/// Whether there was one.
static WISHED: AtomicBool = AtomicBool::new(false);

/// The file that is the command's result, and its exit code once that is there.
static RESULT: Mutex<Option<(PathBuf, u8)>> = Mutex::new(None);

/// From here on, once this file has its name, an end counts as that of a command whose result is worth `code`.
pub(super) fn result_is(path: &Path, code: u8) {
    *RESULT.lock().unwrap_or_else(PoisonError::into_inner) = Some((path.to_path_buf(), code));
}

/// Takes the signals over, but those that whoever started the program has it ignore (`nohup`, `&` in a script). A file that grows over
/// the limit of file sizes becomes an error of writing instead of the end.
///
/// # Errors
/// The system has no thread or no pipe left.
pub(super) fn take_over() -> std::io::Result<()> {
    signal_hook::flag::register(SIGXFSZ, Arc::default())?;
    let ignored = ignored();
    let heard = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| ignored & (1 << (signal - 1)) == 0);
    let mut signals = Signals::new(heard)?;
    let serve = move || {
        let mut first: Option<Instant> = None;
        for signal in signals.forever() {
            let same = first.is_none_or(|first| first.elapsed() < ONE_WISH);
            if HEEDED.load(Ordering::Relaxed) && same {
                if first.is_none() {
                    first = Some(Instant::now());
                    WISHED.store(true, Ordering::Relaxed);
                    acknowledge(signal);
                }
            } else {
                end(signal);
            }
        }
    };
    std::thread::Builder::new().name("signals".into()).spawn(serve).map(drop)
}

/// From here on the first wish to end only shows in [`wished`].
#[cfg(feature = "cad")]
pub(super) fn heed() {
    HEEDED.store(true, Ordering::Relaxed);
}

/// Whether the command should come to its end.
#[cfg(feature = "cad")]
pub(super) fn wished() -> bool {
    WISHED.load(Ordering::Relaxed)
}

/// Tells what becomes of the first wish, and what a second one loses; beside the work, as whoever reads stderr may have stopped reading.
fn acknowledge(signal: i32) {
    let signal = signal_name(signal).unwrap_or("signal");
    std::thread::spawn(move || {
        message(format_args!(
            "sagitta: interrupted ({signal}): ends smoothing, certifies and writes the mesh;\n  \
             interrupt again to end at once and lose it"
        ));
    });
}

/// Ends the program at once, without files half written.
fn end(signal: i32) -> ! {
    let written = formats::abandon();
    let code = exit_code(&written);
    let (sender, told) = mpsc::channel();
    std::thread::spawn(move || {
        let signal = signal_name(signal).unwrap_or("signal");
        message(format_args!("sagitta: interrupted ({signal}): {}", kept(&written)));
        let _ = sender.send(()); // nobody waits any longer
    });
    let _ = told.recv_timeout(LAST_MESSAGE);
    exit(code.into()) // handlers of libraries for the end would run beside their own threads
}

/// What the result is worth where it is written, of which not all that was to be told beside it is.
fn exit_code(written: &[PathBuf]) -> u8 {
    let result = RESULT.lock().unwrap_or_else(PoisonError::into_inner);
    match &*result {
        Some((path, code)) if written.contains(path) => {
            if *code == DONE {
                SIDE_FILE
            } else {
                *code
            }
        }
        _ => INTERRUPTED,
    }
}

/// What there is of the files that were asked for.
fn kept(written: &[PathBuf]) -> String {
    if written.is_empty() {
        return "nothing is written".into();
    }
    let names: Vec<String> = written.iter().map(|path| path.display().to_string()).collect();
    format!("written before: {}; nothing else", names.join(", "))
}

/// Signals that are ignored since before the program began, as a mask; none where the system does not tell.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
