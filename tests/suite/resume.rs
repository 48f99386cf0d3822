//! A run that goes on from a checkpoint ends in the same bytes as one that was never interrupted.

use std::fs;
use std::path::Path;

use crate::common::impatient::Impatient;
use crate::common::{Outcome, fixture, json, root, sagitta};
use sagitta::curve::{Checkpointing, Job};
use sagitta::element::Order;

/// The weeble, with work enough for several rounds.
fn curve(out: &Path, order: &str, max_sweeps: &str, more: &[&str]) -> Outcome {
    let [mesh, cad] = ["msh", "step"].map(|extension| fixture("weeble", extension));
    let options =
        args!["curve", mesh, "--cad", cad, "--order", order, "--threshold", "0.97", "--max-sweeps", max_sweeps];
    let quiet = args!["--quiet", "-o", out];
    sagitta(options.into_iter().chain(quiet).chain(more.iter().map(Into::into)))
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn both_engines_go_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    for engine in ["quasi-newton", "gradient"] {
        let [whole, first, second, state] = ["whole.msh", "first.msh", "second.msh", "state"].map(file);
        curve(&whole, "2", "45", &["--engine", engine]).expect(0);
        // The first part gets no farther than the rounds before its last sweep: what it writes itself does not count.
        curve(&first, "2", "25", &["--engine", engine, "--checkpoint", text(&state), "--checkpoint-every", "1"]);
        curve(&second, "2", "45", &["--engine", engine, "--resume", text(&state)]).expect(0);
        let bytes = |path: &Path| fs::read(path).unwrap();
        assert!(bytes(&first) != bytes(&whole), "{engine}: the first part left nothing to do");
        assert!(bytes(&second) == bytes(&whole), "{engine}: other bytes than without interruption");
    }
}

/// A checkpoint of P3 leads on without P2; one of P2 leads through P3.
#[test]
fn order_by_order_too() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let [whole, second, report, high, low] = ["whole.msh", "second.msh", "report.json", "high", "low"].map(file);
    let keep = |out: &Path, order: &str, state: &Path| {
        curve(out, order, "25", &["--checkpoint", text(state), "--checkpoint-every", "10"]).expect(0);
    };
    keep(&second, "2", &low);
    keep(&whole, "3", &high);
    let bytes = |path: &Path| fs::read(path).unwrap();
    for (state, orders_below) in [(&high, 0), (&low, 1)] {
        curve(&second, "3", "25", &["--resume", text(state), "--report", text(&report)]).expect(0);
        assert!(bytes(&second) == bytes(&whole), "{}: other bytes than without interruption", state.display());
        let gone_through = &json(&report)["smoothing"]["lower_orders"];
        assert_eq!(gone_through.as_array().unwrap().len(), orders_below, "{gone_through}");
    }
    let direct = curve(&second, "3", "25", &["--direct", "--resume", text(&high)]);
    assert_refused(&direct, &high, "belongs to another run");
}

/// What is not valid goes back towards the mesh of the order below, also where that was not made again: on the way to P4, P3 comes out inverted
/// and goes back towards P2, which the run that goes on from P3 has not made.
#[test]
fn falls_back_as_without_interruption() {
    const SWEEPS: usize = 30;
    let folder = tempfile::tempdir().unwrap();
    let state = folder.path().join("state");
    let case = |end: &str| root().join(format!("fixtures/torus_coarse/torus.{end}"));
    let [mesh, cad, linkage] = ["msh", "step", "meshlink.xml"].map(case);
    let job = |order: usize, resume: Option<&Path>| {
        let mut job = Job::new(mesh.clone(), cad.clone(), Some(linkage.clone()), Order::new(order).unwrap());
        job.settings.smoothing.max_sweeps = SWEEPS;
        job.settings.resume = resume.map(Into::into);
        job
    };
    let mut impatient = Impatient::new(3, SWEEPS - 5);
    let mut checkpointing = Checkpointing::new(&mut impatient, Some(state.clone()), 10);
    job(3, None).run(&mut checkpointing).unwrap();
    assert!(checkpointing.failure().is_none() && state.exists());

    let curve_p4 = |resume: Option<&Path>| job(4, resume).run(&mut Impatient::new(4, 1)).unwrap();
    let (whole, second) = (curve_p4(None), curve_p4(Some(&state)));
    for (curved, orders) in [(&whole, 2), (&second, 1)] {
        let lower = &curved.lower_orders;
        let p3 = lower.last().unwrap();
        assert!(lower.len() == orders && p3.sweeps > SWEEPS && p3.end.inverted == 0, "{lower:?}");
    }
    assert!(whole.mesh.points() == second.mesh.points(), "P4: other places than without interruption");
}

#[test]
fn what_is_no_checkpoint_of_this_work_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let [out, state, bad] = ["out.msh", "state", "bad"].map(file);
    curve(&out, "2", "45", &["--checkpoint", text(&state), "--checkpoint-every", "1"]);
    fs::remove_file(&out).unwrap();
    let good = fs::read(&state).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 1;
    let longer = [&good[..], &[0]].concat();
    let spoilt: [(&[u8], &str); 7] = [
        (&[], "is not a checkpoint"),
        (b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "is not a checkpoint"),
        (&good[..30], "is damaged"),
        (&good[..good.len() / 2], "is damaged"),
        (&good[..good.len() - 1], "is damaged"),
        (&flipped, "is damaged"),
        (&longer, "is damaged"),
    ];
    for (bytes, expected) in spoilt {
        fs::write(&bad, bytes).unwrap();
        assert_refused(&curve(&out, "2", "45", &["--resume", text(&bad)]), &bad, expected);
        assert!(!out.exists());
    }
    for more in [["--alpha", "0.5"], ["--survey-factor", "3"], ["--curve-layers", "5"]] {
        let resumed = curve(&out, "2", "45", &[&["--resume", text(&state)][..], &more].concat());
        assert_refused(&resumed, &state, "belongs to another run");
    }
    assert_refused(&curve(&out, "2", "45", &["--resume", text(&file("none"))]), &file("none"), "cannot be read");
}

fn assert_refused(outcome: &Outcome, file: &Path, expected: &str) {
    let told = &outcome.stderr;
    assert_eq!(outcome.code, Some(2), "{told}");
    assert!(told.contains(expected) && told.contains(text(file)), "{expected}: {told}");
}
