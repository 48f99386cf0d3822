//! Some patches curved and others left straight: the layers over a straight patch follow its rim and nothing else, so that the mesh is
//! valid before any smoothing.

use crate::common::{fixture, json, number, sagitta};

/// Curves these patches of a fixture only: exit code 0, nothing off the CAD, least `C_JAC` above 0 before the first sweep and at least
/// 0.6 at the end.
fn curve_only(case: &str, patches: &[usize], order: &str) {
    let folder = tempfile::tempdir().unwrap();
    let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
    let [mesh, cad] = ["msh", "step"].map(|extension| fixture(case, extension));
    let patches = patches.iter().map(usize::to_string).collect::<Vec<_>>().join(",");
    let options = args!["curve", mesh, "--cad", cad, "-q", "--order", order, "--curve", patches, "-o", out];
    sagitta(options.iter().chain(&args!["--report", report])).expect(0);
    let report = json(&report);
    let [start, end] = ["start", "end"].map(|when| number(&report, &format!("/smoothing/{when}/c_jac")));
    println!("{case} --curve {patches} P{order}: C_JAC {start:.3} to {end:.3}");
    assert!(start > 0.0 && end >= 0.6, "{case} --curve {patches} P{order}: C_JAC {start} to {end}");
}

/// Every subset of a fixture's patches, which are numbered from 1.
fn every_subset(case: &str, patches: usize, order: &str) {
    for chosen in 1..(1_usize << patches) {
        let own: Vec<usize> = (0..patches).filter(|k| chosen >> k & 1 == 1).map(|k| k + 1).collect();
        curve_only(case, &own, order);
    }
}

#[test]
fn every_subset_of_the_sphere_shell() {
    every_subset("sphere_shell", 5, "2");
}

#[test]
fn every_subset_of_the_cylinder() {
    every_subset("cylinder_bl", 6, "3");
}

#[test]
fn every_subset_of_the_weeble() {
    every_subset("weeble", 4, "2");
}

#[test]
fn some_subsets_at_higher_orders() {
    curve_only("weeble", &[2], "3");
    curve_only("torus", &[1], "3");
    curve_only("weeble_hybrid", &[3], "3");
}
