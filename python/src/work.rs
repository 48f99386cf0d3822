//! Long work: in a thread of its own, while Python's thread waits without its lock, hears Ctrl-C, and tells who follows the work.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use sagitta::curve::{Deadline, Observer, Step};
use sagitta::element::Order;
use sagitta::smooth;

use crate::failure::Failure;

/// Time between two looks for signals.
const LOOK: Duration = Duration::from_millis(50);

/// Least time between two calls of the callback during smoothing.
const INTERVAL: Duration = Duration::from_millis(100);

/// How long interrupted work is waited for; then it is left to end by itself, at its next look.
const PATIENCE: Duration = Duration::from_secs(1);

/// Where a curving stands.
#[pyclass(frozen, get_all)]
#[derive(Clone, Debug)]
pub(crate) struct Progress {
    step: &'static str,
    order: Option<usize>,
    seconds: f64,
    sweep: usize,
    max_sweeps: usize,
    active_nodes: usize,
    worst_cost: Option<f64>,
    inverted: usize,
}

/// What the worker tells.
enum Event<T> {
    Progress(Progress),
    Done(T),
}

/// Runs `work` to its end. A callback that returns `False` ends the smoothing; where it raises, or on Ctrl-C, the work is given up.
///
/// # Errors
/// What the callback or a signal handler raised; that no thread can be started; that the work broke off.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<usize>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Link<T>) -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = mpsc::channel();
    let stop = Arc::new(AtomicBool::new(false));
    let link = Link { sender: sender.clone(), stop: stop.clone() };
    let pool = threads.map(rayon_pool).transpose()?;
    let body = move || {
        let result = match &pool {
            Some(pool) => pool.install(|| work(link)),
            None => work(link),
        };
        let _ = sender.send(Event::Done(result)); // whoever gave up does not listen any more
    };
    let started = std::thread::Builder::new().name("sagitta".into()).spawn(body);
    started.map_err(|error| Failure::told(format!("no thread can be started: {error}")).raise(py))?;
    loop {
        let event;
        (receiver, event) = wait(py, receiver, LOOK);
        let told = match event {
            Ok(Event::Done(result)) => return Ok(result),
            Ok(Event::Progress(at)) => progress.map_or(Ok(()), |call| tell(call, at, &stop)),
            Err(RecvTimeoutError::Timeout) => Ok(()),
            Err(RecvTimeoutError::Disconnected) => {
                Err(Failure::told("the work broke off, which is a fault of sagitta; what it said is on stderr")
                    .raise(py))
            }
        };
        if let Err(error) = told.and_then(|()| py.check_signals()) {
            stop.store(true, Ordering::Relaxed);
            give_up(py, receiver);
            return Err(error);
        }
    }
}

fn wait<T: Send>(
    py: Python<'_>,
    receiver: Receiver<Event<T>>,
    limit: Duration,
) -> (Receiver<Event<T>>, Result<Event<T>, RecvTimeoutError>) {
    py.detach(move || {
        let event = receiver.recv_timeout(limit);
        (receiver, event)
    })
}

/// Waits for work that was told to stop, but not for ever.
fn give_up<T: Send>(py: Python<'_>, receiver: Receiver<Event<T>>) {
    py.detach(move || {
        let start = Instant::now();
        while let Ok(Event::Progress(_)) = receiver.recv_timeout(PATIENCE.saturating_sub(start.elapsed())) {}
    });
}

fn tell(callback: &Bound<'_, PyAny>, at: Progress, stop: &AtomicBool) -> PyResult<()> {
    let answer = callback.call1((at,))?;
    if answer.is_exact_instance_of::<pyo3::types::PyBool>() && !answer.is_truthy()? {
        stop.store(true, Ordering::Relaxed);
    }
    Ok(())
}

fn rayon_pool(number: usize) -> PyResult<rayon::ThreadPool> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(number).build();
    pool.map_err(|error| pyo3::exceptions::PyValueError::new_err(format!("threads={number}: {error}")))
}

/// The worker's end of the line to whoever waits.
pub(crate) struct Link<T> {
    sender: Sender<Event<T>>,
    stop: Arc<AtomicBool>,
}

/// Follows a curving for whoever waits.
pub(crate) struct Follower<T> {
    link: Link<T>,
    deadline: Deadline,
    start: Instant,
    last: Instant,
    at: Progress,
}

impl<T> Follower<T> {
    /// Begins to follow a curving to an order that may take so long.
    pub(crate) fn new(link: Link<T>, limit: Option<Duration>, order: Order) -> Follower<T> {
        let at = Progress {
            step: Step::Read.name(),
            order: None,
            seconds: 0.0,
            sweep: 0,
            max_sweeps: 0,
            active_nodes: 0,
            worst_cost: None,
            inverted: 0,
        };
        let start = Instant::now();
        Follower { link, deadline: Deadline::new(limit, order), start, last: start, at }
    }

    fn send(&mut self) {
        self.at.seconds = self.start.elapsed().as_secs_f64();
        self.last = Instant::now();
        let _ = self.link.sender.send(Event::Progress(self.at.clone())); // nobody listens after an interrupt
    }

    fn is_stopped(&self) -> bool {
        self.link.stop.load(Ordering::Relaxed)
    }
}

impl<T> Observer for Follower<T> {
    fn order(&mut self, order: Order) {
        self.deadline.order(order);
        self.at.order = Some(order.get());
    }

    fn step(&mut self, step: Step) {
        self.deadline.step(step);
        self.at.step = step.name();
        self.send();
    }

    fn progress(&mut self, progress: &smooth::Progress) -> bool {
        self.at.sweep = progress.sweep;
        self.at.max_sweeps = progress.max_sweeps;
        self.at.active_nodes = progress.active_nodes;
        self.at.worst_cost = Some(progress.worst);
        self.at.inverted = progress.inverted;
        if self.last.elapsed() >= INTERVAL {
            self.send();
        }
        !self.is_stopped() && !self.deadline.is_over(progress.inverted)
    }

    fn may_recover(&mut self) -> bool {
        !self.is_stopped() && self.deadline.leaves_time()
    }
}
