//! Mesh and CAD in different units, at different places, and slightly apart.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::common::input::{Input, Place};
use crate::common::{fixture, json, number, sagitta};
use glam::DVec3;
use sagitta::formats;
use sagitta::mesh::Mesh;
use serde_json::Value;

/// The outer cylinder of the case, radius 5, and its number.
const OUTER: (f64, i32) = (5.0, 2);

fn scaled(place: &Place, factor: f64) -> PathBuf {
    place.mesh(&format!("scaled_{factor}.msh"), |parts| parts.points.iter_mut().for_each(|x| *x *= factor))
}

/// Curves; the report and the mesh.
#[track_caller]
fn curved(place: &Place, input: Input) -> (Value, Mesh) {
    let report = place.dir.path().join("out/report.json");
    let mut arguments = input.arguments(&place.output());
    arguments.extend(args!["--report", report]);
    sagitta(arguments).expect(0);
    let told = json(&report);
    assert_eq!(told["certified"], true);
    assert_eq!(told["faces_without_cad"], 0, "{:#}", told["notes"]);
    (told, formats::read(&place.output()).unwrap())
}

/// The farthest point of the walls from the CAD.
fn farthest(report: &Value) -> f64 {
    report["patches"].as_array().unwrap().iter().map(|patch| number(patch, "/cad_distance_max")).fold(0.0, f64::max)
}

#[test]
fn the_factor_between_units_is_named_and_works() {
    let plain = farthest(&curved(&Place::new(), Input::default()).0);
    for (factor, text) in [(1000.0, "1000"), (25.4, "25.4"), (0.001, "0.001"), (1.0 / 25.4, "0.0393700787401574")] {
        let place = Place::new();
        let mesh = scaled(&place, factor);
        let name = mesh.file_name().unwrap().to_str().unwrap().to_owned();
        let told = place.refuses(Input::mesh(&mesh), &[&name, "cylinder_bl.step", &format!("--cad-scale {text}")]);
        let named: f64 = told.split("--cad-scale ").nth(1).unwrap().split([' ', ')']).next().unwrap().parse().unwrap();
        assert!((named / factor - 1.0).abs() < 1e-12, "{told}");
        for scale in ["auto".to_owned(), named.to_string()] {
            let (report, _) = curved(&place, Input::mesh(&mesh).with(&["--cad-scale", &scale]));
            let used = number(&report, "/input/cad_scale");
            assert!((used / factor - 1.0).abs() < 1e-12, "--cad-scale {scale}: used {used}");
            let far = farthest(&report) / factor;
            assert!((far / plain - 1.0).abs() < 1e-2, "--cad-scale {scale}: {far:.3e} off, unscaled {plain:.3e}");
        }
    }
}

#[test]
fn auto_is_one_where_the_unit_is_right() {
    let (report, _) = curved(&Place::new(), Input::default().with(&["--cad-scale", "auto"]));
    assert_eq!(report["input"]["cad_scale"], 1.0);
}

#[test]
fn link_and_validate_take_the_factor_too() {
    let place = Place::new();
    let mesh = scaled(&place, 1000.0);
    let (cad, output) = (fixture("cylinder_bl", "step"), place.dir.path().join("out/link.xml"));
    for tags in [&[][..], &args!["--ignore-tags"]] {
        let link = |more: &[OsString]| {
            let arguments = args!["link", mesh, "--cad", cad, "-o", output];
            sagitta(arguments.into_iter().chain(tags.iter().chain(more).cloned()))
        };
        let told = link(&[]).expect(2).stderr;
        assert!(told.contains("--cad-scale 1000 ") && told.lines().count() == 1, "{told}");
        for scale in ["auto", "1000"] {
            let told = link(&args!["--cad-scale", scale]).expect(0).stdout;
            let source = if tags.is_empty() { "the mesh's entity tags" } else { "geometry" };
            assert!(told.contains(source), "{told}");
            let validate = |more: &[OsString]| {
                let arguments = args!["validate", output, "--mesh", mesh, "--cad", cad, "--json"];
                sagitta(arguments.into_iter().chain(more.iter().cloned()))
            };
            let told: Value = serde_json::from_str(&validate(&args!["--cad-scale", scale]).expect(0).stdout).unwrap();
            assert_eq!((number(&told, "/cad_scale"), number(&told, "/errors")), (1000.0, 0.0));
            let unscaled: Value = serde_json::from_str(&validate(&[]).expect(1).stdout).unwrap();
            assert_eq!(unscaled["findings"][0]["code"], "ML511", "{unscaled:#}");
        }
    }
    // The unit is right already.
    let told = sagitta(args!["link", fixture("cylinder_bl", "msh"), "--cad", cad, "-o", output, "--cad-scale", "auto"]);
    assert!(told.expect(0).stdout.contains("entity tags"));
}

#[test]
fn reading_the_cad_is_given_up_in_time() {
    let place = Place::new();
    let (mesh, cad, output) =
        (fixture("weeble", "msh"), fixture("weeble", "step"), place.dir.path().join("out/link.xml"));
    let linkage = fixture("weeble", "meshlink.xml");
    for arguments in [
        args!["link", mesh, "--cad", cad, "-o", output, "--cad-timeout", "0.0001"].to_vec(),
        args!["validate", linkage, "--cad", cad, "--cad-timeout", "0.0001"].to_vec(),
    ] {
        let told = sagitta(arguments).expect(2).stderr;
        assert!(told.contains("weeble.step") && told.lines().count() == 1, "{told}");
    }
}

#[test]
fn a_wrong_factor_is_refused() {
    let place = Place::new();
    place.refuses(Input::default().with(&["--cad-scale", "25.4"]), &["cylinder_bl.step", "factor of about 0.03937"]);
}

#[test]
fn a_factor_between_no_two_units_is_not_guessed() {
    let place = Place::new();
    place.refuses(
        Input::mesh(scaled(&place, 3.0)).with(&["--cad-scale", "auto"]),
        &["scaled_3.msh", "factor of about 3"],
    );
}

#[test]
fn another_place_is_told_with_its_distance() {
    let place = Place::new();
    let shifted = |by: DVec3| place.mesh("shifted.msh", |parts| parts.points.iter_mut().for_each(|x| *x += by));
    for scale in ["1", "auto"] {
        let input = Input::mesh(shifted(DVec3::new(300.0, 400.0, 0.0))).with(&["--cad-scale", scale]);
        place.refuses(input, &["shifted.msh", "cylinder_bl.step", "500.000000 apart"]);
    }
    // The boxes overlap, the points tell.
    let told = place.refuses(Input::mesh(shifted(DVec3::Z * 0.3)), &["shifted.msh", "surface ", "node "]);
    assert!(told.contains("3.000e-1 away"), "{told}");
    place.refuses(Input { cad: fixture("torus", "step"), ..Input::default() }, &["torus.step"]);
}

/// The first node inside the outer cylinder's face, and the outward direction there.
fn wall_node(mesh: &Mesh) -> (usize, DVec3) {
    let nodes_of = |own: bool| {
        let blocks = mesh.side_blocks().filter(move |b| (b.entity.tag == OUTER.1) == own);
        blocks.flat_map(|b| b.nodes.iter().map(|n| n.index())).collect::<std::collections::BTreeSet<_>>()
    };
    let node = *nodes_of(true).difference(&nodes_of(false)).next().unwrap();
    let x = mesh.points()[node];
    assert!((x.truncate().length() - OUTER.0).abs() < 1e-9, "{x}");
    (node, DVec3::new(x.x, x.y, 0.0).normalize())
}

fn moved(place: &Place, by: f64) -> (PathBuf, u64, DVec3) {
    let mut known = (0, DVec3::ZERO);
    let path = place.mesh("moved.msh", |parts| {
        let (node, outward) = wall_node(&Mesh::new(parts.clone()).unwrap());
        parts.points[node] += outward * by;
        known = (parts.node_tags[node], parts.points[node]);
    });
    (path, known.0, known.1)
}

fn place_of(mesh: &Mesh, tag: u64) -> DVec3 {
    mesh.points()[mesh.node_tags().iter().position(|&t| t == tag).unwrap()]
}

fn patch(report: &Value, tag: i32) -> &Value {
    let mut patches = report["patches"].as_array().unwrap().iter();
    patches.find(|patch| patch["entity"] == format!("surface {tag}")).unwrap()
}

#[test]
fn a_node_too_far_from_the_cad_is_named() {
    let place = Place::new();
    // The box is 11.2 across, so that 0.0112 is the limit.
    let (mesh, tag, _) = moved(&place, 0.05);
    place.refuses(Input::mesh(&mesh), &["moved.msh", "surface 2", &format!("node {tag}"), "5.000e-2", "--max-offset"]);
    place.refuses(Input::mesh(&mesh).with(&["--freeze-linear"]), &["moved.msh", "--max-offset"]);
    let (report, curved) = curved(&place, Input::mesh(&mesh).with(&["--max-offset", "0.01"]));
    assert!((number(patch(&report, OUTER.1), "/node_move_max") - 0.05).abs() < 1e-6, "{report:#}");
    assert!((place_of(&curved, tag).truncate().length() - OUTER.0).abs() < 1e-9);
}

#[test]
fn a_node_slightly_off_is_projected_or_frozen() {
    let place = Place::new();
    let (mesh, tag, from) = moved(&place, 0.004);
    let (report, projected) = curved(&place, Input::mesh(&mesh));
    let offset = number(patch(&report, OUTER.1), "/node_move_max");
    assert!((offset - 0.004).abs() < 1e-6, "reported {offset}");
    let to = place_of(&projected, tag);
    assert!(
        (to.truncate().length() - OUTER.0).abs() < 1e-9 && (to.distance(from) - 0.004).abs() < 1e-6,
        "{from} to {to}"
    );
    let others = |p: &&Value| p["entity"] != "surface 2";
    for other in report["patches"].as_array().unwrap().iter().filter(others) {
        assert!(number(other, "/node_move_max") < 1e-9, "{other}");
    }

    let (report, frozen) = curved(&place, Input::mesh(&mesh).with(&["--freeze-linear"]));
    assert_eq!(number(patch(&report, OUTER.1), "/node_move_max"), 0.0);
    assert!(farthest(&report) > 0.0039, "the farthest point is the frozen node: {}", farthest(&report));
    let linear = formats::read(&mesh).unwrap();
    unmoved(&linear, &frozen, "--freeze-linear");
}

/// Every linear node is where it was, to the last bit.
#[track_caller]
fn unmoved(linear: &Mesh, curved: &Mesh, what: &str) {
    for (tag, x) in linear.node_tags().iter().zip(linear.points()) {
        assert_eq!(place_of(curved, *tag), *x, "{what}: node {tag}");
    }
}

#[test]
fn linear_nodes_inside_the_mesh_do_move_unless_frozen() {
    // Else the test above would pass without the option.
    let place = Place::new();
    let linear = formats::read(&fixture("torus", "msh")).unwrap();
    let torus = |more: &[&str]| {
        let input = Input { mesh: fixture("torus", "msh"), cad: fixture("torus", "step"), ..Input::default() };
        curved(&place, input.with(more)).1
    };
    let moves = |mesh: &Mesh| (0..linear.points().len()).filter(|&n| mesh.points()[n] != linear.points()[n]).count();
    assert!(moves(&torus(&[])) > 0);
    unmoved(&linear, &torus(&["--freeze-linear"]), "torus");
}

#[test]
fn check_refuses_another_linear_mesh() {
    let place = Place::new();
    let (_, _) = curved(&place, Input::default());
    let other: &Path = &fixture("torus", "msh");
    let outcome = sagitta(args!["check", place.output(), "--linear", other]).expect(2);
    assert!(outcome.stderr.contains("torus.msh: not the linear mesh of"), "{}", outcome.stderr);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
}
