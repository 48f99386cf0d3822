//! What cannot be valid at P3 goes back to the curved mesh of P2, not to the straight one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[macro_use]
mod common;

use common::{json, number, root, sagitta};
use sagitta::certify::{self, Settings};
use sagitta::formats;

/// On this torus the straight prisms lean by up to 88 degrees off their own faces, which turn by 50 degrees at P3.
#[test]
fn faces_that_cannot_follow_at_p3_keep_their_curve_of_p2() {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
    let case = |end: &str| root().join(format!("fixtures/torus_coarse/torus.{end}"));
    let [mesh, cad, linkage] = ["msh", "step", "meshlink.xml"].map(case);
    let files = args!["curve", mesh, "--cad", cad, "--linkage", linkage, "-o", out, "--report", report];
    let told = sagitta(files.iter().chain(&args!["--order", "3", "--max-sweeps", "60", "--quiet"])).expect(3).stdout;
    assert!(told.contains("its curve of P2, and "), "{told}");
    let report = json(&report);
    let given_up = report["given_up"].as_array().unwrap();
    assert!(!given_up.is_empty() && given_up.iter().all(|face| face["order"] == 2));
    assert!(certify::mesh(&formats::read(&out).unwrap(), None, &Settings::default()).holds());
    // Of the straight mesh too little is left between elements that went back and their neighbours: it ended at 0.02.
    let c_jac = number(&report, "/smoothing/end/c_jac");
    assert!(c_jac > 0.2, "C_JAC {c_jac}");
}
