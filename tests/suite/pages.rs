//! Pages for browsers, opened in a real one: they load without errors and ask for nothing, show something, and tell the JSON report's numbers.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::common::{fixture, json, python, root, sagitta, warn};

/// What a headless Chromium finds of a page; `None`, said aloud, where there is none.
fn browsed(page: &Path, report: &Path) -> Option<Value> {
    let python = python("pages are not opened in a browser")?;
    let script = root().join("tests/pages/browse.py");
    let output = Command::new(python).arg(script).args([page, report]).output().unwrap();
    let found: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(&output.stderr)));
    if found.get("missing").is_some() {
        warn("chromium is not installed: pages are not opened in a browser");
        return None;
    }
    Some(found)
}

/// Holds what the browser found against what every page is to be.
#[track_caller]
fn is_good(found: &Value) {
    assert_eq!(found["errors"], serde_json::json!([]), "{found:#}");
    assert_eq!(found["wrong"], serde_json::json!([]), "numbers that are not the report's: {found:#}");
    assert!(found["numbers"].as_u64() > Some(100), "{found:#}");
    for view in ["whole", "worst", "cut"] {
        let (drawn, colours) = (found[view]["drawn"].as_f64().unwrap(), found[view]["colours"].as_u64().unwrap());
        assert!(drawn > 0.02 && colours > 20, "{view}: nothing is drawn: {found:#}");
    }
    let [before, after] = [&found["camera"], &found["camera_at_worst"]];
    assert_ne!(before["eye"], after["eye"], "the button of the worst element moves the camera");
    let reached = after["target"].as_array().unwrap().iter().zip(after["first"].as_array().unwrap());
    for (at, wanted) in reached {
        assert!((at.as_f64().unwrap() - wanted.as_f64().unwrap()).abs() < 1e-9, "{after}");
    }
    assert_ne!(found["whole"]["sum"], found["worst"]["sum"], "the picture changes");
}

#[test]
fn the_page_of_a_curved_mesh_tells_what_the_report_tells() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let [mesh, report, page] = ["out.msh", "out.json", "out.html"].map(at);
    let (linear, cad) = (fixture("weeble", "msh"), fixture("weeble", "step"));
    let arguments =
        args!["curve", linear, "--cad", cad, "--order", "2", "-o", mesh, "--report", report, "--html", page];
    sagitta(arguments).expect(0);
    let document = json(&report);
    assert_eq!(document["lowest"].as_array().unwrap().len(), 50);
    let least = document.pointer("/measures/0/percentiles/0/value");
    assert_eq!(least, document.pointer("/certificate/j_over_jc/lower"), "one proven minimum");
    assert!(std::fs::metadata(&page).unwrap().len() < 20_000_000);
    if let Some(found) = browsed(&page, &report) {
        is_good(&found);
        let verdict = found["verdict"].as_str().unwrap();
        assert!(verdict.starts_with("Every element is proven valid"), "{verdict}");
        assert!(found["cut_triangles"].as_f64() > Some(100.0), "{found:#}");
    }
}

/// Afterwards, of a report and its mesh; a plane mesh has no volume to cut, and the report's numbers all the same.
#[test]
fn a_page_is_made_of_a_report_afterwards() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let [report, page] = ["check.json", "check.html"].map(at);
    let mesh = root().join("fixtures/samples/hexpyrtet_p3_msh41a.msh");
    sagitta(args!["check", mesh, "--report", report]).expect(0);
    sagitta(args!["report", report, mesh, "-o", page]).expect(0);
    if let Some(found) = browsed(&page, &report) {
        is_good(&found);
    }
}

/// Pages of `check` and `report` tell how far the boundary is from the CAD, where that is given.
#[test]
fn pages_made_with_cad_have_distances_to_it() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let [curved, report, page] = ["out.msh", "out.json", "out.html"].map(at);
    let (linear, cad) = (fixture("cylinder_bl", "msh"), fixture("cylinder_bl", "step"));
    sagitta(args!["curve", linear, "--cad", cad, "--order", "2", "-o", curved, "--report", report]).expect(0);
    let has = |page: &Path| std::fs::read_to_string(page).unwrap().contains("\"distance to CAD\":\"");
    for (command, with_cad) in [
        (args!["report", report, curved, "-o", page].to_vec(), false),
        (args!["report", report, curved, "-o", page, "--cad", cad].to_vec(), true),
        (args!["check", linear, "--html", page].to_vec(), false),
        (args!["check", linear, "--html", page, "--cad", cad].to_vec(), true),
    ] {
        sagitta(command).expect(0);
        assert_eq!(has(&page), with_cad);
    }
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let [report, page, no_json] = ["check.json", "page.html", "no.json"].map(at);
    let (mesh, other) = (root().join("fixtures/samples/hexpyrtet_p3_msh41a.msh"), fixture("weeble", "msh"));
    sagitta(args!["check", mesh, "--report", report]).expect(0);
    let refused = sagitta(args!["report", report, other, "-o", page]).expect(2);
    assert!(refused.stderr.contains("not the report of") && refused.stderr.contains("order 3"), "{}", refused.stderr);
    std::fs::write(&no_json, "{\"schema\": 1").unwrap();
    let refused = sagitta(args!["report", no_json, mesh, "-o", page]).expect(2);
    assert!(refused.stderr.contains("no JSON"), "{}", refused.stderr);
    let refused = sagitta(args!["report", report, mesh, "-o", report]).expect(2);
    assert!(refused.stderr.contains(".html"), "{}", refused.stderr);
    assert!(!page.exists());
}

/// The library that pages draw with is the one that its list of checksums says.
#[test]
fn the_vendored_library_is_whole() {
    let folder = root().join("src/html/vendor");
    let output = Command::new("sha256sum").args(["--check", "--strict", "SHA256SUMS"]).current_dir(&folder).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}
