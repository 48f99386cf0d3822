//! Fields of VTU files, as VTK reads them: they are there, finite, and tell the report's figures.

use std::process::Command;

use serde_json::Value;

use crate::common::{json, python, root, sagitta};

#[test]
fn fields_of_a_checked_mesh_are_the_reports_measures() {
    let dir = tempfile::tempdir().unwrap();
    let [fields, report] = ["fields.vtu", "check.json"].map(|name| dir.path().join(name));
    let mesh = root().join("fixtures/samples/cylprism_p2_msh41b.msh");
    sagitta(args!["check", mesh, "--fields", fields, "--report", report]).expect(0);
    let Some(python) = python("VTK does not read our fields") else { return };
    let script = root().join("tests/pictures/fields.py");
    let output = Command::new(python).arg(script).arg(&fields).output().unwrap();
    let found: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(&output.stderr)));
    let report = json(&report);
    for (measure, array) in [
        ("J/J_c", "certified_min_J_over_Jc"),
        ("scaled Jacobian", "scaled_Jacobian"),
        ("C_WCN", "C_WCN"),
        ("C_JAC", "C_JAC"),
    ] {
        let own = report["measures"].as_array().unwrap().iter().find(|own| own["measure"] == measure).unwrap();
        let percentiles = own["percentiles"].as_array().unwrap();
        let [least, largest] = [percentiles.first(), percentiles.last()].map(|own| &own.unwrap()["value"]);
        assert_eq!([&found[array][0], &found[array][1]], [least, largest], "{array}: {found:#}");
    }
    let nodes = sagitta::formats::read(&mesh).unwrap().node_tags().len();
    assert_eq!(found["node"][1].as_f64(), Some(nodes as f64), "{found:#}");
    assert!(found["element"][0].as_f64() > Some(0.0), "{found:#}");
}

/// A mesh that is to be written twice is written twice, from one run; and no output is another.
#[test]
fn one_run_writes_the_mesh_for_the_solver_and_the_one_to_look_at() {
    let dir = tempfile::tempdir().unwrap();
    let [msh, vtu, page] = ["out.msh", "out.vtu", "out.html"].map(|name| dir.path().join(name));
    let case = |extension: &str| crate::common::fixture("cylinder_bl", extension);
    let curve = args!["curve", case("msh"), "--cad", case("step"), "--order", "2"];
    let told = sagitta(curve.iter().cloned().chain(args!["-o", msh, "-o", vtu])).expect(0).stdout;
    let [first, second] = [&msh, &vtu].map(|path| sagitta::formats::read(path).unwrap());
    assert_eq!(first.points(), &second.points()[..first.points().len()]);
    for path in [&msh, &vtu] {
        assert!(told.contains(&format!("written: {}", path.display())), "{told}");
    }
    for clash in [args!["-o", msh, "-o", msh].to_vec(), args!["-o", msh, "--report", page, "--html", page].to_vec()] {
        let refused = sagitta(curve.iter().cloned().chain(clash)).expect(2);
        assert!(refused.stderr.contains("is the same file as"), "{}", refused.stderr);
    }
    let refused = sagitta(curve.iter().cloned().chain(args!["-o", msh, "-o", dir.path().join("out.xyz")])).expect(2);
    assert!(refused.stderr.contains("out.xyz"), "{}", refused.stderr);
}
