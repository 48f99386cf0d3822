//! How the smoothing went over time, as CSV: one row a sweep, and one for the end.

use std::path::Path;
use std::time::Instant;

use super::checkpoint::Work;
use super::observer::{Observer, Step};
use crate::element::Order;
use crate::formats;
use crate::smooth::{Checkpoint, Progress, Smoothed};

/// The columns that are written.
const COLUMNS: [&str; 8] = ["seconds", "order", "sweep", "stage", "active_nodes", "c_wcn_min", "c_jac_min", "inverted"];

/// A sweep, or the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Seconds since the smoothing began at the first order.
    pub seconds: f64,
    /// The order that is smoothed.
    pub order: usize,
    /// Sweeps at this order before.
    pub sweep: usize,
    /// The stage that it belongs to.
    pub stage: usize,
    /// Nodes that it moves; 0 at the end.
    pub active_nodes: usize,
    /// Smallest `C_WCN` and `C_JAC` of the last survey before it, at the end those of the mesh.
    pub costs: [f64; 2],
    /// Elements with a cost of 0 or less then.
    pub inverted: usize,
}

/// Notes every sweep, and passes everything on to another observer.
pub struct Trace<'a> {
    observer: &'a mut dyn Observer,
    start: Option<Instant>,
    end: Option<f64>,
    order: Option<Order>,
    rows: Vec<Sweep>,
}

impl<'a> Trace<'a> {
    /// Passes on to `observer`.
    pub fn new(observer: &'a mut dyn Observer) -> Trace<'a> {
        Trace { observer, start: None, end: None, order: None, rows: Vec::new() }
    }

    /// All sweeps, and behind them the end.
    #[must_use]
    pub fn sweeps(&self, smoothed: &Smoothed) -> Vec<Sweep> {
        let end = smoothed.end;
        let last = Sweep {
            seconds: self.end.unwrap_or(0.0),
            order: self.order.map_or(0, Order::get),
            sweep: smoothed.sweeps,
            stage: self.rows.last().map_or(0, |row| row.stage),
            active_nodes: 0,
            costs: [end.c_wcn, end.c_jac],
            inverted: end.inverted,
        };
        self.rows.iter().copied().chain([last]).collect()
    }

    /// Writes the rows. Seconds count from the beginning of the smoothing at the first order; costs are those of the last survey before the
    /// sweep, in the last row those of the mesh.
    ///
    /// # Errors
    /// [`formats::Error`] of the file.
    pub fn write(&self, path: &Path, smoothed: &Smoothed) -> Result<(), formats::Error> {
        formats::write_file(path, |out| {
            let mut out = csv::Writer::from_writer(out);
            out.write_record(COLUMNS)?;
            for row in self.sweeps(smoothed) {
                let [wcn, jac] = row.costs.map(|cost| cost.to_string());
                let counts = [row.order, row.sweep, row.stage, row.active_nodes, row.inverted];
                let [order, sweep, stage, active, inverted] = counts.map(|count| count.to_string());
                out.write_record([format!("{:.3}", row.seconds), order, sweep, stage, active, wcn, jac, inverted])?;
            }
            out.flush()
        })
    }

    fn seconds(&self) -> f64 {
        self.start.map_or(0.0, |start| start.elapsed().as_secs_f64())
    }
}

impl Observer for Trace<'_> {
    fn order(&mut self, order: Order) {
        self.order = Some(order);
        self.observer.order(order);
    }

    fn step(&mut self, step: Step) {
        match step {
            Step::Smooth if self.start.is_none() => self.start = Some(Instant::now()),
            Step::Certify => self.end = Some(self.seconds()),
            _ => {}
        }
        self.observer.step(step);
    }

    fn may_recover(&mut self) -> bool {
        self.observer.may_recover()
    }

    fn progress(&mut self, progress: &Progress) -> bool {
        self.rows.push(Sweep {
            seconds: self.seconds(),
            order: self.order.map_or(0, Order::get),
            sweep: progress.sweep,
            stage: progress.stage,
            active_nodes: progress.active_nodes,
            costs: progress.costs,
            inverted: progress.inverted,
        });
        self.end = self.end.map(|_| self.seconds()); // recovery smooths again
        self.observer.progress(progress)
    }

    fn checkpoint(&mut self, work: &Work, checkpoint: &Checkpoint) {
        self.observer.checkpoint(work, checkpoint);
    }
}
