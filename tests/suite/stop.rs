//! Smoothing that is ended early leaves a valid mesh, and says why.

use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::impatient::Impatient;
use crate::common::{fixture, is_sweep};
use sagitta::certify::{self, Settings};
use sagitta::curve::{Job, Observer};
use sagitta::element::Order;
use sagitta::formats;
use sagitta::smooth::Progress;

fn curve(out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sagitta"));
    command.args(["curve", "fixtures/weeble/weeble.msh", "--cad", "fixtures/weeble/weeble.step", "--order", "4"]);
    command.args(["--threshold", "1", "-o"]).arg(out).args(more);
    command
}

fn assert_valid(out: &Path) {
    let mesh = formats::read(out).unwrap();
    assert_eq!(mesh.order().get(), 4);
    assert!(certify::mesh(&mesh, mesh.points(), None, &Settings::default()).holds());
}

#[test]
fn the_time_limit_ends_smoothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("weeble.msh");
    let done = curve(&out, &["--time-limit", "0.01", "--quiet"]).output().unwrap();
    let told = String::from_utf8(done.stdout).unwrap();
    assert_eq!(done.status.code(), Some(5), "{told}");
    assert!(told.contains("stopped early: the time limit of 0.01 s is over"), "{told}");
    assert_valid(&out);
}

#[test]
fn an_interrupt_ends_smoothing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("weeble.msh");
    let mut child = curve(&out, &[]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    assert!(lines.any(|line| is_sweep(&line.unwrap(), "P2")), "a sweep is told before it ends");
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    lines.for_each(drop);
    let mut told = String::new();
    child.stdout.take().unwrap().read_to_string(&mut told).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(5), "{told}");
    assert!(told.contains("stopped early: interrupted"), "{told}");
    assert_valid(&out);
}

#[test]
fn a_run_that_was_ended_at_a_lower_order_counts_as_ended() {
    let file = |end: &str| Path::new("fixtures/sphere_shell").join(format!("sphere_shell.{end}"));
    let job = Job::new(file("msh"), file("step"), None, Order::new(3).unwrap());
    let curved = job.run(&mut Impatient::new(2, 1)).unwrap();
    assert!(curved.lower_orders[0].stopped, "{:?}", curved.lower_orders);
    assert!(curved.smoothed.stopped && curved.certificate.holds());
}

/// Ends the smoothing at P2 at once, as that order's share of a time limit does, while there is time for the rest.
struct ShareIsOver(Order);

impl Observer for ShareIsOver {
    fn order(&mut self, order: Order) {
        self.0 = order;
    }

    fn progress(&mut self, _: &Progress) -> bool {
        self.0.get() > 2
    }

    fn may_recover(&mut self) -> bool {
        true
    }
}

/// The order asked for is smoothed all the same, and the mesh is told to be stopped early.
#[test]
fn an_order_below_that_has_had_its_share_leaves_the_rest_to_the_next() {
    let job = Job::new(fixture("weeble", "msh"), fixture("weeble", "step"), None, Order::new(3).unwrap());
    let curved = job.run(&mut ShareIsOver(Order::LINEAR)).unwrap();
    assert!(curved.is_certified() && curved.smoothed.stopped && curved.smoothed.sweeps > 1);
    assert!(curved.lower_orders.len() == 1 && curved.lower_orders[0].stopped && curved.lower_orders[0].sweeps == 1);
    assert!(curved.smoothed.end.c_jac > 0.75, "{:?}", curved.smoothed.end);
}
