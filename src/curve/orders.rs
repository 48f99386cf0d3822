//! Order continuation: P2 first, and each order begins where the one below ended.
//!
//! The polynomial of the order below is the same polynomial in the order above, so what is left of the walls' displacement is what
//! the lower order could not follow: a small part, that [`perturb`] carries into the volume as it carries the whole of it at P2.
//! Sweeps at low order are cheap (a tet of P2 has 10 nodes, one of P4 has 35), and few are left for the high one. Measured on 2
//! cores, min C_WCN / C_JAC and seconds of the whole run:
//!
//! | case | `--direct` | order by order |
//! |---|---|---|
//! | weeble P3 | 0.919 / 0.800, 2.8 | 0.930 / 0.785, 2.5 |
//! | weeble P4 | 0.910 / 0.804, 7.9 | 0.909 / 0.804, 5.6 |
//! | weeble_hybrid P4 | 0.893 / 0.660, 48 | 0.892 / 0.800, 7.0 |
//! | wing_sharp 0.4 P3 | 0.825 / 0.651, 3.0 | 0.859 / 0.722, 2.2 |
//! | wing_sharp 0.4 P4 | 0.771 / 0.539, 8.7 | 0.813 / 0.720, 7.6 |
//! | wing_blunt 0.4 P4 | 0.880 / 0.573, 15.6 | 0.914 / 0.719, 10.1 |
//! | nozzle 0.4 P4 | 0.959 / 0.812, 15.0 | 0.954 / 0.805, 6.1 |
//!
//! An order that comes out inverted goes through recovery ([`super::recover`]); the next one begins there if it ends on the CAD, proven,
//! and else at the last order that did. With 30 sweeps an order the torus at scale 0.5 comes out inverted at P3; P4 then ended with 56
//! faces off the CAD when it began at P2, and on it with C_JAC 0.25 when it begins at what recovery made of P3.
//!
//! The paper's engine begins at the order itself, as the paper has it, and so does `--direct`.

use super::below::Below;
use super::checkpoint::{Found, Work};
use super::error::Error;
use super::layers::leave_straight_beyond;
use super::level::{Case, Level};
use super::observer::{Clock, Observer, Relay, Step};
use super::proof::Proof;
use super::recover::{recover, release_ahead};
use super::settings::Settings;
use super::smoothing::smooth_level;
use super::start::start;
use super::wall::fit::fit;
use super::wall::{follow_rims, project};
use crate::element::Order;
use crate::mesh::Mesh;
use crate::mesh::elevate::elevate;
use crate::smooth::{self, Begin, Engine, Progress, Smoothed, Summary};

/// What smoothing did at an order below the one asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowerOrder {
    /// The order.
    pub order: Order,
    /// Sweeps over the active nodes.
    pub sweeps: usize,
    /// Whether it was ended before it was done; the orders between are left out then.
    pub stopped: bool,
    /// Smallest costs before the first sweep.
    pub start: Summary,
    /// Smallest costs at the end.
    pub end: Summary,
}

/// The mesh at the order asked for, smoothed, and how it came there.
pub(super) struct Continued<'a> {
    pub(super) level: Level<'a>,
    pub(super) smoothed: Smoothed,
    /// What there is to say of the periodic pairs.
    pub(super) notes: Vec<String>,
    /// The mesh to fall back to.
    pub(super) below: Lower<'a>,
    /// What was done at the orders below.
    pub(super) lower_orders: Vec<LowerOrder>,
}

/// The mesh at the highest order below that is valid on the CAD.
pub(super) enum Lower<'a> {
    /// As it came out.
    Known(Option<Below>),
    /// Not made again by a run that went on from a checkpoint: the way to it.
    Skipped(Box<Continuation<'a>>),
}

impl Lower<'_> {
    /// That mesh; where it was skipped, it is made now, unless the observer ends that.
    pub(super) fn mesh(self, observer: &mut dyn Observer) -> Option<Below> {
        match self {
            Lower::Known(below) => below,
            Lower::Skipped(mut continuation) => {
                let order = continuation.case.settings.order;
                continuation.made_again(order, observer).ok().flatten()
            }
        }
    }
}

/// Reports sweeps only: the steps of an order that is made a second time are not reported again.
struct Silent<'o>(&'o mut dyn Observer);

impl Observer for Silent<'_> {
    fn may_recover(&mut self) -> bool {
        self.0.may_recover()
    }

    fn progress(&mut self, progress: &Progress) -> bool {
        self.0.progress(progress)
    }
}

/// The way up to the order asked for.
pub(super) struct Continuation<'a> {
    case: Case<'a>,
    linear: Mesh,
    /// The checkpoint to go on from, until its order is reached.
    found: Option<Found>,
}

impl<'a> Continuation<'a> {
    /// Reads the head of the checkpoint, where the settings name one.
    pub(super) fn new(case: Case<'a>, linear: Mesh) -> Result<Continuation<'a>, Error> {
        let found = case.settings.resume.as_deref().map(Found::open).transpose()?;
        Ok(Continuation { case, linear, found })
    }

    /// Goes up to the order asked for.
    pub(super) fn run(mut self, clock: &mut Clock) -> Result<Continued<'a>, Error> {
        let order = self.case.settings.order;
        let (below, lower_orders) = self.lower(order, clock)?;
        let (mut level, notes) = self.projected(order, clock)?;
        let skipped = self.found.is_some() && below.is_none();
        if !skipped {
            self.linear = Mesh::default(); // it was needed for the last time
        }
        let mut smoothed = self.smoothed(&mut level, below.as_ref(), clock)?;
        smoothed.stopped |= lower_orders.iter().any(|lower| lower.stopped);
        let below = if skipped { Lower::Skipped(Box::new(self)) } else { Lower::Known(below) };
        Ok(Continued { level, smoothed, notes, below, lower_orders })
    }

    /// Goes through the orders below `end`; those that were done when the checkpoint was kept are left out.
    fn lower(&mut self, end: Order, clock: &mut Clock) -> Result<(Option<Below>, Vec<LowerOrder>), Error> {
        let mut below: Option<Below> = None;
        let mut skipped = false;
        let mut lower_orders = Vec::new();
        let settings = self.case.settings;
        let direct = settings.direct || settings.surface || settings.smoothing.engine == Engine::Gradient;
        for order in Order::all().filter(|&order| order > Order::LINEAR && order < end && !direct) {
            let (mut level, _) = self.projected(order, clock)?;
            if self.found.as_ref().is_some_and(|found| found.nodes() > level.curved.len()) {
                skipped = true;
                continue;
            }
            let mut smoothed = self.smoothed(&mut level, below.as_ref(), clock)?;
            let mut valid = smoothed.end.inverted == 0;
            // An order that only had its share of the time is mended all the same, and the next one follows.
            let ended = smoothed.stopped;
            smoothed.stopped &= !clock.observer.may_recover();
            if !valid && !smoothed.stopped {
                if std::mem::take(&mut skipped) {
                    below = self.made_again(order, clock.observer)?;
                }
                valid = recovers(&mut level, &mut smoothed, below.as_ref(), clock);
            }
            let Smoothed { sweeps, stopped, start, end, .. } = smoothed;
            lower_orders.push(LowerOrder { order, sweeps, stopped: stopped || ended, start, end });
            if valid {
                below = Some(level.into());
            }
            if stopped || (ended && !clock.observer.may_recover()) {
                break;
            }
        }
        Ok((below, lower_orders))
    }

    /// The highest order below `end` at which no element is inverted, made once more; `None` also where the observer ends that.
    fn made_again(&mut self, end: Order, observer: &mut dyn Observer) -> Result<Option<Below>, Error> {
        let (below, lower_orders) = self.lower(end, &mut Clock::new(&mut Silent(observer)))?;
        Ok(below.filter(|_| lower_orders.iter().all(|lower| !lower.stopped)))
    }

    /// Elevates, projects and fits; and what there is to say of the periodic pairs.
    fn projected(&self, order: Order, clock: &mut Clock) -> Result<(Level<'a>, Vec<String>), Error> {
        clock.observer.order(order);
        clock.step(Step::Elevate);
        let (mut level, mut notes) = Level::new(self.case, elevate(&self.linear, order)?);

        clock.step(Step::Project);
        notes.extend(put_on_cad(&mut level));
        if let Some(layers) = self.case.settings.curve_layers {
            leave_straight_beyond(layers, &mut level);
        }
        Ok((level, notes))
    }

    /// Carries the volume along and smooths, or goes on from the checkpoint.
    fn smoothed(&mut self, level: &mut Level, below: Option<&Below>, clock: &mut Clock) -> Result<Smoothed, Error> {
        let work = Work::of(level);
        if !self.case.settings.surface {
            release_ahead(level);
        }
        let resumed = self.found.take().map(|found| found.read(&work)).transpose()?;
        clock.step(Step::Perturb);
        if resumed.is_none() {
            level.curved = Vec::new(); // it is straight; not needed beside what comes
            level.curved = start(level, below);
        }
        clock.step(Step::Smooth);
        let mut relay = Relay { observer: clock.observer, work };
        let begin = resumed.map_or(Begin::Anew, Begin::From);
        let Settings { smoothing, surface, .. } = self.case.settings;
        let sweeps = if *surface { 0 } else { smoothing.max_sweeps };
        Ok(smooth_level(level, &smooth::Settings { max_sweeps: sweeps, ..smoothing.clone() }, begin, &mut relay))
    }
}

/// A level of an order on the CAD, its volume still straight.
pub(super) fn projected<'a>(case: Case<'a>, linear: &Mesh, order: Order) -> Result<Level<'a>, Error> {
    let (mut level, _) = Level::new(case, elevate(linear, order)?);
    put_on_cad(&mut level);
    Ok(level)
}

/// Projects the wall, fits it to the CAD, carries periodic images along, and lets the faces beside it follow; what there is to say of these.
fn put_on_cad(level: &mut Level) -> Vec<String> {
    project(level);
    carry(level);
    fit(level);
    carry(level);
    follow_rims(level)
}

/// Takes the nodes that follow others to their images.
fn carry(level: &mut Level) {
    let mut displacement = level.wall.displacements();
    level.periodic.carry(level.elevated.mesh.points(), &mut displacement);
    level.wall.displace_all(&displacement);
}

/// Takes a level that is inverted through recovery; whether it came out proven, and on the CAD but for released nodes.
fn recovers(level: &mut Level, smoothed: &mut Smoothed, below: Option<&Below>, clock: &mut Clock) -> bool {
    let proof = Proof::of(level);
    if proof.holds() {
        return true;
    }
    clock.step(Step::Recover);
    let mut watch = |progress: Progress| clock.observer.progress(&progress);
    let recovered = recover(level, smoothed, below, proof, &mut watch);
    recovered.proof.holds() && level.wall.is_all_the_way()
}
