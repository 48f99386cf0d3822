//! The same input makes the same bytes: on 1, 2 and 7 threads, and again.

use std::collections::BTreeMap;
use std::path::Path;

use crate::common::{fixture, json, names_in, sagitta};
use serde_json::Value;

/// What a run left: the bytes of its mesh and its report without what the clock and the machine say.
struct Left {
    threads: u64,
    mesh: Vec<u8>,
    report: Value,
}

/// Keys of the report that may differ.
const MACHINE: [&str; 4] = ["seconds", "threads", "peak_memory", "run"];

fn run(dir: &Path, case: &str, order: &str, extension: &str, threads: usize) -> Left {
    // The same names in each run, as the report and the error messages name them.
    let [output, report] = [extension, "json"].map(|e| dir.join("out").with_extension(e));
    let (linear, cad) = (fixture(case, "msh"), fixture(case, "step"));
    let count = threads.to_string();
    let mesh = args!["curve", linear, "--cad", cad, "--order", order, "-o", output];
    sagitta(mesh.into_iter().chain(args!["--report", report, "--threads", count, "-q"])).expect(0);
    assert_eq!(names_in(dir), [output.file_name().unwrap(), report.file_name().unwrap()].sorted());
    let mut document = json(&report);
    let machine = MACHINE.map(|key| (key, document.as_object_mut().unwrap().remove(key)));
    let used = BTreeMap::from(machine)["threads"].clone().expect("the report names its threads");
    let left = Left { threads: used.as_u64().unwrap(), mesh: std::fs::read(&output).unwrap(), report: document };
    [output, report].iter().for_each(|file| std::fs::remove_file(file).unwrap());
    left
}

trait Sorted {
    fn sorted(self) -> Vec<String>;
}

impl<const N: usize> Sorted for [&std::ffi::OsStr; N] {
    fn sorted(self) -> Vec<String> {
        let mut names: Vec<String> = self.iter().map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// Where two files first differ.
fn difference(a: &[u8], b: &[u8]) -> Option<String> {
    let at = a.iter().zip(b).position(|(a, b)| a != b);
    match at {
        None if a.len() == b.len() => None,
        at => Some(format!("{} and {} bytes, first difference at {at:?}", a.len(), b.len())),
    }
}

#[track_caller]
fn same_on_any_threads(case: &str, order: &str, extension: &str) {
    let dir = tempfile::tempdir().unwrap();
    let first = run(dir.path(), case, order, extension, 1);
    assert_eq!(first.threads, 1);
    assert!(first.mesh.len() > 10_000, "{} bytes", first.mesh.len());
    let sweeps = crate::common::number(&first.report, "/smoothing/sweeps");
    assert!(sweeps > 0.0, "{case} P{order}: nothing is smoothed, so the case proves nothing");
    for threads in [1, 2, 7] {
        let again = run(dir.path(), case, order, extension, threads);
        assert_eq!(again.threads, threads as u64);
        let what = format!("{case} P{order} as {extension} on {threads} threads");
        if let Some(difference) = difference(&first.mesh, &again.mesh) {
            panic!("{what}: {difference}");
        }
        assert_eq!(first.report, again.report, "{what}");
    }
}

#[test]
fn differences_are_seen() {
    assert_eq!(difference(b"same", b"same"), None);
    assert_eq!(difference(b"same", b"sane").unwrap(), "4 and 4 bytes, first difference at Some(2)");
    assert_eq!(difference(b"same", b"sam").unwrap(), "4 and 3 bytes, first difference at None");
}

#[test]
fn weeble_p2_as_msh() {
    same_on_any_threads("weeble", "2", "msh");
}

#[test]
fn weeble_hybrid_p2_as_vtu() {
    same_on_any_threads("weeble_hybrid", "2", "vtu");
}

#[test]
fn torus_p3_as_msh() {
    same_on_any_threads("torus", "3", "msh");
}

#[test]
fn sphere_shell_p2_as_vtu() {
    same_on_any_threads("sphere_shell", "2", "vtu");
}
