//! The threads of the program.

use std::num::NonZeroUsize;

use super::output::{Failure, message};

/// The most threads that are started, where there are no more cores: as many again make a small mesh take several times as long.
const MOST: usize = 256;

/// The most threads that are started on this machine.
fn most() -> usize {
    std::thread::available_parallelism().map_or(MOST, |cores| cores.get().max(MOST))
}

/// Variable that tells the number where no option does.
const VARIABLE: &str = "RAYON_NUM_THREADS";

/// The number of `--threads`.
#[cfg(feature = "cad")]
pub(super) fn number(text: &str) -> Result<NonZeroUsize, String> {
    let most = most();
    let number = text.parse::<NonZeroUsize>().ok().filter(|number| number.get() <= most);
    number.ok_or_else(|| format!("{text:?} is not a number from 1 to {most}"))
}

/// Starts so many threads, or as many as the environment says, or one a core.
///
/// # Errors
/// The system refuses them.
pub(super) fn start(wanted: Option<NonZeroUsize>) -> Result<(), Failure> {
    let named = || std::env::var(VARIABLE).ok()?.parse().ok();
    let number = wanted.map_or_else(|| named().unwrap_or(0), NonZeroUsize::get);
    let most = most();
    if number > most {
        message(format_args!("sagitta: {VARIABLE} is {number}: {most} threads are started, the most there can be"));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(number.min(most));
    pool.build_global().map_err(|error| format!("threads cannot be started: {error}; try --threads 1").into())
}
