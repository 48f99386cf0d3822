//! How the smoothing went over time, as CSV: one row a sweep, and one for the end.

use std::path::Path;
use std::time::Instant;

use super::progress::Teller;
use crate::cli::output::Failure;
use crate::curve::{Observer, Step};
use crate::element::Order;
use crate::formats;
use crate::smooth::{Progress, Smoothed};

/// Notes every sweep, and hands it on.
pub(super) struct Trace<'a> {
    teller: &'a mut Teller,
    start: Option<Instant>,
    end: Option<f64>,
    order: Option<Order>,
    rows: Vec<(f64, usize, Progress)>,
}

impl<'a> Trace<'a> {
    pub(super) fn new(teller: &'a mut Teller) -> Trace<'a> {
        Trace { teller, start: None, end: None, order: None, rows: Vec::new() }
    }

    /// Writes the rows. Seconds count from the beginning of the smoothing at the first order; costs are those of the last survey before the
    /// sweep, in the last row those of the mesh.
    pub(super) fn write(&self, path: &Path, smoothed: &Smoothed) -> Result<(), Failure> {
        let mut text = "seconds,order,sweep,stage,active_nodes,c_wcn_min,c_jac_min,inverted\n".to_owned();
        for (seconds, order, p) in &self.rows {
            let [wcn, jac] = p.costs;
            let row =
                format!("{seconds:.3},{order},{},{},{},{wcn},{jac},{}\n", p.sweep, p.stage, p.active_nodes, p.inverted);
            text.push_str(&row);
        }
        let (end, seconds) = (smoothed.end, self.end.unwrap_or(0.0));
        let stage = self.rows.last().map_or(0, |(.., p)| p.stage);
        let order = self.order.map_or(0, Order::get);
        let last = format!("{order},{},{stage},0,{},{},{}", smoothed.sweeps, end.c_wcn, end.c_jac, end.inverted);
        formats::write_bytes(path, format!("{text}{seconds:.3},{last}\n").as_bytes())?;
        Ok(())
    }

    fn seconds(&self) -> f64 {
        self.start.map_or(0.0, |start| start.elapsed().as_secs_f64())
    }
}

impl Observer for Trace<'_> {
    fn order(&mut self, order: Order) {
        self.order = Some(order);
        self.teller.order(order);
    }

    fn step(&mut self, step: Step) {
        match step {
            Step::Smooth if self.start.is_none() => self.start = Some(Instant::now()),
            Step::Certify => self.end = Some(self.seconds()),
            _ => {}
        }
        self.teller.step(step);
    }

    fn progress(&mut self, progress: &Progress) -> bool {
        self.rows.push((self.seconds(), self.order.map_or(0, Order::get), *progress));
        self.end = self.end.map(|_| self.seconds()); // the ladder smooths again
        self.teller.progress(progress)
    }
}
