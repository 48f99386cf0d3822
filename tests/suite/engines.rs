//! The paper's engine, beside the default one: it makes the mesh better, and the same bytes on any number of threads.

use crate::common::{fixture, json, number, sagitta};

/// Curves the wing at P2 by the paper's engine; the bytes of its mesh, min C_JAC before and after, rows of the trace.
fn climb(threads: &str) -> (Vec<u8>, [f64; 2], usize) {
    let dir = tempfile::tempdir().unwrap();
    let [output, report, trace] = ["out.msh", "report.json", "trace.csv"].map(|name| dir.path().join(name));
    let (linear, cad) = (fixture("wing_sharp", "msh"), fixture("wing_sharp", "step"));
    let mesh = args!["curve", linear, "--cad", cad, "--order", "2", "-o", output, "--report", report, "-q"];
    let how = args!["--engine", "gradient", "--threshold", "0.95", "--max-sweeps", "40", "--trace", trace];
    sagitta(mesh.into_iter().chain(how).chain(args!["--threads", threads])).expect(0);
    let report = json(&report);
    let smallest = ["start", "end"].map(|when| number(&report, &format!("/smoothing/{when}/c_jac")));
    let rows = std::fs::read_to_string(&trace).unwrap().lines().count();
    (std::fs::read(&output).unwrap(), smallest, rows)
}

#[test]
fn the_papers_engine_climbs_alike_on_any_number_of_threads() {
    let (mesh, [start, end], rows) = climb("1");
    // From .659 to .745 within 40 sweeps; .60 to .75 before the walls were fitted, which begins better.
    assert!(end > start + 0.05, "min C_JAC {start} -> {end}");
    assert_eq!(rows, 1 + 40 + 1, "head, sweeps, end");
    for threads in ["2", "7"] {
        assert!(climb(threads).0 == mesh, "{threads} threads");
    }
}

#[test]
fn an_unknown_engine_is_refused_by_name() {
    let (linear, cad) = (fixture("wing_sharp", "msh"), fixture("wing_sharp", "step"));
    let wrong = args!["curve", linear, "--cad", cad, "--order", "2", "-o", "never.msh", "--engine", "steam"];
    let outcome = sagitta(wrong).expect(2);
    let words = ["'steam'", "--engine", "quasi-newton", "gradient"];
    assert!(words.iter().all(|word| outcome.stderr.contains(word)), "{}", outcome.stderr);
}
