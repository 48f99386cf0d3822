//! A mesh so coarse that it begins with elements turned inside out by more than their size: it must come out whole.
#![allow(clippy::unwrap_used)]

use std::process::Command;

/// Capping the regularisation of determinants once cost this case its walls (exit code 3); nothing else showed it.
#[test]
fn a_coarse_cylinder_comes_out_of_inversion_at_every_order() {
    let folder = tempfile::tempdir().unwrap();
    let case = |end: &str| format!("fixtures/cylinder_bl_coarse/cylinder_bl.{end}");
    for order in ["2", "3", "4"] {
        let report = folder.path().join("report.json");
        let mut command = Command::new(env!("CARGO_BIN_EXE_sagitta"));
        command.args(["curve", &case("msh"), "--cad", &case("step"), "--linkage", &case("meshlink.xml"), "--quiet"]);
        command.args(["--order", order, "-o"]).arg(folder.path().join("curved.msh")).arg("--report").arg(&report);
        let done = command.output().unwrap();
        assert_eq!(done.status.code(), Some(0), "P{order}: {}", String::from_utf8_lossy(&done.stdout));
        let report: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(report).unwrap()).unwrap();
        let end = &report["smoothing"]["end"];
        let [wcn, jac] = ["c_wcn", "c_jac"].map(|cost| end[cost].as_f64().unwrap());
        assert!(wcn >= 0.8 && jac >= 0.5, "P{order}: C_WCN {wcn}, C_JAC {jac}");
    }
}
