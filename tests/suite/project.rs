//! `sagitta project` and `sagitta groups`: what they write, and what bad input gets.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::{fixture, json, names_in, number, root, sagitta};
use serde_json::json;

const COLUMNS: &str = "foot_x,foot_y,foot_z,entity,u,v,distance,state";

/// Some points about the cylinder of `cylinder_bl`: half an annulus around z, radius 0.5 to 5.
const POINTS: &str = "x,y,z\n1,2,0.25\n-0.1,0.2,0.1\n0,0.3,0.2\n4,4,0.3\n";

fn rows(csv: &str) -> Vec<Vec<&str>> {
    csv.lines().map(|line| line.split(',').collect()).collect()
}

/// Feet and distances by formula: the wall of `cylinder_bl` is the half cylinder of radius 0.5 around z.
#[test]
fn feet_are_written_and_counted() {
    let dir = tempfile::tempdir().unwrap();
    let [points, feet, report] = ["points.csv", "feet.csv", "report.json"].map(|name| dir.path().join(name));
    std::fs::write(&points, POINTS).unwrap();
    let cad = fixture("cylinder_bl", "step");
    let listing = sagitta(args!["groups", cad, "--json"]).expect(0).stdout;
    let listing: serde_json::Value = serde_json::from_str(&listing).unwrap();
    let wall = listing["faces"]
        .as_array()
        .unwrap()
        .iter()
        .find(|face| face["kind"] == json!("cylinder") && face["bounds"][1][0].as_f64().unwrap() < 0.6);
    let wall = wall.unwrap()["id"].as_str().unwrap();
    let arguments = args!["project", cad, points, "--group", wall, "-o", feet, "--report", report];
    let outcome = sagitta(arguments).expect(0);
    assert!(outcome.stdout.contains("proven to be the closest: 4, not proven: 0"), "{}", outcome.stdout);
    let text = std::fs::read_to_string(&feet).unwrap();
    assert_eq!(text.lines().next(), Some(COLUMNS));
    let rows = rows(&text);
    assert_eq!(rows.len(), 5);
    for (row, point) in rows[1..].iter().zip(POINTS.lines().skip(1)) {
        let x: Vec<f64> = point.split(',').map(|t| t.parse().unwrap()).collect();
        let radius = x[0].hypot(x[1]);
        let foot: Vec<f64> = row[..3].iter().map(|t| t.parse().unwrap()).collect();
        let distance: f64 = row[6].parse().unwrap();
        assert_eq!((row[3], row[7]), (wall, "interior"));
        assert!((distance - (radius - 0.5).abs()).abs() < 1e-12, "{row:?}");
        assert!((foot[0] - 0.5 * x[0] / radius).abs() < 1e-12 && (foot[2] - x[2]).abs() < 1e-12, "{row:?}");
    }
    let report = json(&report);
    assert_eq!(report["schema"], "sagitta-feet-2");
    assert_eq!([number(&report, "/points"), number(&report, "/proven"), number(&report, "/unproven")], [4.0, 4.0, 0.0]);
    assert_eq!(report["feet_by_end"], json!({"interior": 4}));
    assert_eq!(report["feet_by_entity"], json!({wall: 4}));
    assert_eq!(names_in(dir.path()), ["feet.csv", "points.csv", "report.json"]);
}

/// Runs the program with text on stdin.
fn piped(arguments: &[&str], input: &str) -> (Option<i32>, String, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_sagitta"))
        .args(arguments)
        .current_dir(root())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn streams_carry_the_same_as_files() {
    let dir = tempfile::tempdir().unwrap();
    let (points, feet) = (dir.path().join("points.csv"), dir.path().join("feet.csv"));
    std::fs::write(&points, POINTS).unwrap();
    let cad = "fixtures/cylinder_bl/cylinder_bl.step";
    sagitta(args!["project", cad, points, "-o", feet, "-q"]).expect(0);
    let (code, stdout, stderr) = piped(&["project", cad, "-", "-o", "-", "-q", "--threads", "1"], POINTS);
    assert_eq!((code, stderr.as_str()), (Some(0), ""));
    assert_eq!(stdout, std::fs::read_to_string(&feet).unwrap());
    let (code, loud, stderr) = piped(&["project", cad, "-"], POINTS);
    assert!(code == Some(0) && loud == stdout && stderr.contains("not proven: 0"), "{stderr}");
}

#[test]
fn groups_are_resolved_and_mixed() {
    let cad = "cad/tests/shapes/unsewn.igs";
    let listing = sagitta(args!["groups", cad]).expect(0).stdout;
    assert!(listing.contains("iges:D1: face:1 face:2"), "{listing}");
    let feet = |group: &[&str]| {
        let arguments = [&["project", cad, "fixtures/samples/points.csv", "-q"], group].concat();
        sagitta(arguments).expect(0).stdout
    };
    // the file's own group holds all faces
    assert_eq!(feet(&["--group", "iges:D1"]), feet(&[]));
    assert_eq!(feet(&["--group", "face:1,face-2", "--group", "edge:30"]), feet(&["--group", "edge:30,face:2,face:1"]));
    let distances = |text: &str| -> Vec<f64> { rows(text)[1..].iter().map(|row| row[6].parse().unwrap()).collect() };
    let (face, edge, both) =
        (feet(&["--group", "face:1"]), feet(&["--group", "edge:30"]), feet(&["--group", "face:1,edge:30"]));
    let [face, edge, both] = [face, edge, both].map(|text| distances(&text));
    for ((face, edge), both) in face.iter().zip(&edge).zip(&both) {
        assert!((face.min(*edge) - both).abs() < 1e-12, "{face} {edge} {both}");
    }
    assert!(face != both && edge != both);
}

#[test]
fn another_unit_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let points = dir.path().join("points.csv");
    std::fs::write(&points, "x,y,z\n5000,0,0\n-5000,0,250\n0,5000,500\n").unwrap();
    let project = |more: &[&str]| {
        let mut arguments = args!["project", fixture("cylinder_bl", "step"), points].to_vec();
        arguments.extend(more.iter().map(Into::into));
        sagitta(arguments).expect(0).stderr
    };
    let told = project(&[]);
    assert!(told.contains("--cad-scale 1000"), "{told}");
    let told = project(&["--cad-scale", "1000"]);
    assert!(!told.contains("note:") && told.contains("scale 1000"), "{told}");
}

/// One line on stderr with all the words, nothing on stdout, exit code 2, no file.
#[track_caller]
fn refuses(cad: &str, points: &Path, more: &[&str], words: &[&str]) {
    let dir = tempfile::tempdir().unwrap();
    let feet = dir.path().join("feet.csv");
    let mut arguments = args!["project", cad, points, "-q", "-o", feet].to_vec();
    arguments.extend(more.iter().map(Into::into));
    let outcome = sagitta(arguments).expect(2);
    assert!(outcome.stdout.is_empty() && outcome.stderr.lines().count() == 1, "{}", outcome.stderr);
    for word in words {
        assert!(outcome.stderr.contains(word), "{word:?} is not in {}", outcome.stderr);
    }
    assert_eq!(names_in(dir.path()), [""; 0]);
}

#[test]
fn bad_input_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let cad = "fixtures/cylinder_bl/cylinder_bl.step";
    let points = dir.path().join("points.csv");
    for (text, words) in [
        ("", ["points.csv", "empty"]),
        ("x,y,z\n", ["line 2", "no points"]),
        ("x;y;z\n1;2;3\n", ["line 1", "no column is named x"]),
        ("x,y\n1,2\n", ["line 1", "no column is named z"]),
        ("x,y,z\n1,2,3\n1,NaN,3\n", ["points.csv, line 3", "y is \"NaN\""]),
        ("x,y,z\n1,2,1e400\n", ["line 2", "z is \"1e400\""]),
        ("x,y,z\n1,2\n", ["line 2", "2 columns"]),
        ("x,y,z\n1,2,three\n", ["line 2", "not a finite number"]),
    ] {
        std::fs::write(&points, text).unwrap();
        refuses(cad, &points, &[], &words);
    }
    std::fs::write(&points, [0xff, 0xfe, b'x', b'\n']).unwrap();
    refuses(cad, &points, &[], &["points.csv", "UTF-8"]);
    refuses(cad, &dir.path().join("none.csv"), &[], &["none.csv", "No such file"]);
    refuses(cad, dir.path(), &[], &["directory"]);
    std::fs::write(&points, POINTS).unwrap();
    refuses("fixtures/README.md", &points, &[], &["README.md", "not a CAD file"]);
    refuses(cad, &points, &["--group", "face:99"], &["face:99", "cylinder_bl.step"]);
    refuses(cad, &points, &["--group", "face:1,"], &["not a reference"]);
    refuses(cad, &points, &["--group", "name:wing"], &["name:wing", "no entity has that name"]);
    refuses(cad, &points, &["--report", "/no/such/folder/r.json"], &["/no/such/folder"]);
    refuses("cad/tests/shapes/assembly.step", &points, &["--group", "step:#89"], &["ambiguous", "face:1"]);
    assert_eq!(sagitta(args!["groups", "fixtures/README.md"]).expect(2).stderr.lines().count(), 1);
}
