//! Fields in files for viewers, as VTK and Gmsh read them: they are there, finite, and tell the report's figures.

use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

use crate::common::{fixture, json, python, root, sagitta};

/// What VTK and Gmsh read; `None`, said aloud, where they are not there.
fn read_by_others(files: &[&PathBuf]) -> Option<Value> {
    let python = python("VTK and Gmsh do not read our fields")?;
    let output = Command::new(python).arg(root().join("tests/pictures/fields.py")).args(files).output().unwrap();
    let found = serde_json::from_slice(&output.stdout);
    Some(found.unwrap_or_else(|e| panic!("{e}: {}", String::from_utf8_lossy(&output.stderr))))
}

const MEASURES: [(&str, &str); 4] = [
    ("J/J_c", "certified_min_J_over_Jc"),
    ("scaled Jacobian", "scaled_Jacobian"),
    ("C_WCN", "C_WCN"),
    ("C_JAC", "C_JAC"),
];

/// Holds arrays against the report's measures.
#[track_caller]
fn are_measures(report: &Value, cells: &Value, points: &Value) {
    for (measure, array) in MEASURES {
        let own = report["measures"].as_array().unwrap().iter().find(|own| own["measure"] == measure).unwrap();
        let percentiles = own["percentiles"].as_array().unwrap();
        let [least, largest] = [percentiles.first(), percentiles.last()].map(|own| &own.unwrap()["value"]);
        assert_eq!([&cells[array][0], &cells[array][1]], [least, largest], "{array}: {cells:#}");
        let nodal = &points[format!("nodal_{array}")];
        assert_eq!((&nodal[0], &nodal[2]), (least, &Value::Bool(true)), "{array}: {points:#}");
    }
}

#[test]
fn fields_of_a_checked_mesh_are_the_reports_measures() {
    let dir = tempfile::tempdir().unwrap();
    let [vtu, hdf, report] = ["fields.vtu", "fields.vtkhdf", "check.json"].map(|name| dir.path().join(name));
    let mesh = root().join("fixtures/samples/cylprism_p2_msh41b.msh");
    for fields in [&vtu, &hdf] {
        sagitta(args!["check", mesh, "--fields", fields, "--report", report]).expect(0);
    }
    let Some(found) = read_by_others(&[&vtu, &hdf]) else { return };
    let (found, hdf, report) = (&found["fields.vtu"], &found["fields.vtkhdf"], json(&report));
    are_measures(&report, &found["cells"], &found["points"]);
    let nodes = sagitta::formats::read(&mesh).unwrap().node_tags().len();
    assert_eq!(found["points"]["node"][1].as_f64(), Some(nodes as f64), "{found:#}");
    assert!(found["cells"]["element"][0].as_f64() > Some(0.0), "{found:#}");
    assert_eq!(found, hdf, "one and the same in both files");
}

/// The curved cylinder in every file for viewers.
#[test]
fn fields_of_a_curved_mesh_tell_what_was_done_and_how_far_the_cad_is() {
    let dir = tempfile::tempdir().unwrap();
    let names = ["out.msh", "out.vtu", "out.vtm", "out.vtkhdf", "out.json"];
    let [msh, vtu, vtm, hdf, report] = names.map(|name| dir.path().join(name));
    let (mesh, cad) = (fixture("cylinder_bl", "msh"), fixture("cylinder_bl", "step"));
    let curve = args!["curve", mesh, "--cad", cad, "--order", "2", "--report", report, "--msh-views"];
    sagitta(curve.iter().chain(&args!["-o", msh, "-o", vtu, "-o", vtm, "-o", hdf])).expect(0);
    let Some(found) = read_by_others(&[&msh, &vtu, &vtm, &hdf]) else { return };
    let report = json(&report);
    assert_eq!(found["out.vtu"], found["out.vtkhdf"], "one and the same in both files");
    are_measures(&report, &found["out.vtu"]["cells"], &found["out.vtu"]["points"]);

    let blocks = found["out.vtm"].as_object().unwrap();
    let patches: Vec<&Value> = report["patches"].as_array().unwrap().iter().collect();
    let labels = patches.iter().map(|own| own["names"][0].as_str().unwrap_or_else(|| own["entity"].as_str().unwrap()));
    let mut expected: Vec<&str> = labels.chain(["cells"]).collect();
    expected.sort_unstable();
    expected.dedup();
    assert_eq!(blocks.keys().collect::<Vec<_>>(), expected, "a block a patch, and the cells");
    for (name, block) in blocks {
        for values in ["cells", "points", "cut"].iter().flat_map(|kind| block[kind].as_object().unwrap().values()) {
            assert_eq!(values[2], true, "{name}: {block:#}");
        }
    }
    let cells = &blocks["cells"];
    assert!(cells["points"]["displacement"][1].as_f64() > Some(0.0) && cells["cells"]["layer"][0] == 1.0, "{cells:#}");
    let far = |kind: &str, array: &str| {
        let own = blocks.values().filter_map(|block| block[kind][array][1].as_f64());
        own.reduce(f64::max).unwrap_or_else(|| panic!("no {array}: {blocks:#?}"))
    };
    let told = patches.iter().filter_map(|own| own["cad_distance_max"].as_f64()).reduce(f64::max).unwrap();
    assert_eq!(far("cells", "cad_distance_of_face"), told);
    assert!(far("points", "cad_distance") <= told, "nodes are no farther than faces");
    assert!(far("cells", "cad_face") >= 1.0 && far("cells", "off_cad") == 0.0);

    let views = &found["out.msh"];
    for (_, array) in MEASURES {
        let (view, own) = (&views[array], &cells["cells"][array]);
        assert_eq!((&view["kind"], &view["count"]), (&"ElementData".into(), &cells["count"]), "{views:#}");
        assert_eq!(view["spread"], *own, "{array}: {views:#}");
    }
    assert_eq!(views["displacement"]["kind"], "NodeData");
    assert_eq!(views["cad_distance_of_face"]["spread"][1].as_f64(), Some(told));
}

/// A field that is the same everywhere at the nodes is the same on a cut.
#[test]
fn a_cut_of_a_constant_field_is_constant() {
    let dir = tempfile::tempdir().unwrap();
    for mesh in ["hexpyrtet_p3_msh41a", "cylprism_p2_msh41b"] {
        let (path, file) = (root().join(format!("fixtures/samples/{mesh}.msh")), dir.path().join("constant.vtu"));
        let own = sagitta::formats::read(&path).unwrap();
        let values = sagitta::formats::Values::Real(vec![0.25; own.points().len()]);
        let support = sagitta::formats::Support::Points;
        let fields = [sagitta::formats::Field { name: "constant".to_owned(), support, values }];
        let options = sagitta::formats::WriteOptions { fields: &fields, ..Default::default() };
        sagitta::formats::write(&file, &own, &options).unwrap();
        let Some(found) = read_by_others(&[&file]) else { return };
        let cut = &found["constant.vtu"]["cut"]["constant"];
        let [least, largest] = [0, 1].map(|n| cut[n].as_f64().unwrap());
        assert!((least - 0.25).abs() < 1e-12 && (largest - 0.25).abs() < 1e-12, "{mesh}: {found:#}");
    }
}

/// A mesh that is to be written twice is written twice, from one run; and no output is another.
#[test]
fn one_run_writes_the_mesh_for_the_solver_and_the_one_to_look_at() {
    let dir = tempfile::tempdir().unwrap();
    let [msh, vtu, page] = ["out.msh", "out.vtu", "out.html"].map(|name| dir.path().join(name));
    let case = |extension: &str| fixture("cylinder_bl", extension);
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
