//! Seconds a step for the weeble at P2, P3 and P4, beside the time of elevation alone in the same run.
//!
//! `cargo bench --bench curve`, from the repository's root; prints a table.

use std::path::PathBuf;
use std::process::ExitCode;

use sagitta::curve::{Job, JobError, Step};
use sagitta::element::Order;

fn main() -> ExitCode {
    println!("| weeble | seconds | of elevation alone | sweeps | us a node and sweep | min J/Jc |");
    println!("|---|---|---|---|---|---|");
    for order in Order::all().skip(1) {
        if let Err(error) = row(order) {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn row(order: Order) -> Result<(), JobError> {
    let case = |ending: &str| PathBuf::from(format!("{}/fixtures/weeble/weeble.{ending}", env!("CARGO_MANIFEST_DIR")));
    let job = Job::new(case("msh"), case("step"), Some(case("meshlink.xml")), order);
    let curved = job.run(&mut ())?;
    let total: f64 = curved.seconds.iter().map(|(_, s)| s).sum();
    let of = |step: Step| curved.seconds.iter().filter(|(s, _)| *s == step).map(|(_, t)| t).sum::<f64>();
    let (nodes, sweeps) = (curved.mesh.points().len(), curved.smoothed.sweeps);
    println!(
        "| {order} | {total:.2} | {:.0} x | {sweeps} | {:.2} | {:.3} |",
        total / of(Step::Elevate),
        1e6 * of(Step::Smooth) / (nodes * sweeps.max(1)) as f64,
        curved.certificate.relative.lower
    );
    Ok(())
}
