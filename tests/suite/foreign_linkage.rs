//! Linkage as other programs and people write it: the ONERA M6 by names and groups, right and wrong; and files that are no linkage at all.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{fixture, root, sagitta};
use sagitta::associate::{Classification, Linkage, Sources, classify};
use sagitta::mesh::Boundary;

fn m6(extension: &str) -> PathBuf {
    root().join("fixtures/onera_m6/onera_m6").with_extension(extension)
}

/// What `validate` finds in the M6's linkage file, changed: exit code, codes with lines, and the changed text.
fn m6_with(change: impl FnOnce(String) -> String) -> (Option<i32>, Vec<(String, u64)>, String) {
    let text = change(std::fs::read_to_string(m6("meshlink.xml")).unwrap());
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("m6.xml");
    std::fs::write(&path, &text).unwrap();
    let outcome = sagitta(args!["validate", path, "--mesh", m6("msh"), "--cad", m6("egads"), "--json"]);
    let json: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
    let found = json["findings"].as_array().unwrap().iter();
    let found = found.map(|f| (f["code"].as_str().unwrap().to_owned(), f["line"].as_u64().unwrap())).collect();
    (outcome.code, found, text)
}

fn line_of(text: &str, needle: &str) -> u64 {
    1 + text[..text.find(needle).unwrap()].matches('\n').count() as u64
}

/// Strings of the M6 run along several CAD edges; the nodes where these meet are held there, also without a point that says so.
#[test]
fn nodes_where_the_edges_of_a_string_meet_are_held() {
    let linear = sagitta::formats::read(&m6("msh")).unwrap();
    let boundary = Boundary::new(&linear);
    let model = cad::Model::read(&m6("egads"), &cad::ReadOptions::default()).unwrap();
    let [linkage, mesh] = [m6("meshlink.xml"), m6("msh")];
    let linkage = Linkage::read(&linkage, &mesh).unwrap();
    let association =
        classify(&Sources::new(Some(&linkage), &BTreeSet::new()), &linear, &boundary, &model).unwrap().association;
    let mut held = 0;
    for (node, place) in linear.points().iter().enumerate() {
        let around = (0..boundary.edges.len()).filter(|&e| boundary.edges[e].iter().any(|n| n.index() == node));
        let around: Vec<Classification> = around
            .map(|e| association.edges[e])
            .filter(|classification| matches!(classification, Classification::Curve(_)))
            .collect();
        let one = around.windows(2).all(|pair| pair[0] == pair[1]);
        let at_vertex = model.vertices().iter().any(|vertex| vertex.point.distance(*place) < 1e-6);
        if let (Some(Classification::Curve(curve)), true, true) = (around.first(), one, at_vertex)
            && association.curves[*curve].group.entities().len() > 1
        {
            assert!(
                matches!(association.nodes[node], Classification::Vertex(_)),
                "node {node}: {:?}",
                association.nodes[node]
            );
            held += 1;
        }
    }
    assert!(held > 0, "no string of several edges has a node where two of them meet");
}

#[test]
fn the_m6_by_hand_is_clean() {
    let (code, found, _) = m6_with(|text| text);
    assert_eq!((code, found), (Some(0), vec![]));
}

#[test]
fn the_m6_by_hand_and_wrong() {
    let group = |name: &str| format!("name=\"{name}\">");
    let sheet = |name: &str| format!("<MeshSheet name=\"{name}\"");
    // A string of the wrong curve, a group without one of its faces, the sides changed over.
    let (code, found, text) = m6_with(|text| text.replacen("ref=\"edge-16\"", "ref=\"edge-10\"", 1));
    let line = line_of(&text, "<MeshString name=\"trailing edge\"");
    assert_eq!((code, found), (Some(1), vec![("ML503".to_owned(), line)]));

    let (_, found, text) = m6_with(|text| {
        text.replacen(&format!("{}4 5<", group("wing upper")), &format!("{}4<", group("wing upper")), 1)
    });
    assert!(found.contains(&("ML503".to_owned(), line_of(&text, &sheet("wing upper")))), "{found:?}");

    let (_, found, text) = m6_with(|text| {
        let [lower, upper] = [format!("{}3 6<", group("wing lower")), format!("{}4 5<", group("wing upper"))];
        let swapped = text.replacen(&lower, "LOWER", 1).replacen(&upper, &format!("{}3 6<", group("wing upper")), 1);
        swapped.replacen("LOWER", &format!("{}4 5<", group("wing lower")), 1)
    });
    for name in ["wing lower", "wing upper"] {
        assert!(found.contains(&("ML503".to_owned(), line_of(&text, &sheet(name)))), "{name}: {found:?}");
    }
    assert!(found.iter().all(|(code, _)| code == "ML503"), "{found:?}");

    // Without the string on it, nothing holds the mesh edges on the sharp rim of the tip's wedge.
    let (code, found, text) = m6_with(|text| {
        let from = text.find("<MeshString name=\"tip wedge\"").unwrap();
        let to = from + text[from..].find("</MeshString>").unwrap() + "</MeshString>".len();
        format!("{}{}", &text[..from], &text[to..])
    });
    assert_eq!((code, found), (Some(1), vec![("ML508".to_owned(), line_of(&text, &sheet("tip")))]));

    // The tip is left out: most of its strings bound the wing's sheets too.
    let (_, found, text) = m6_with(|text| {
        let from = text.find(&sheet("tip")).unwrap();
        let to = from + text[from..].find("</MeshSheet>").unwrap() + "</MeshSheet>".len();
        format!("{}{}", &text[..from], &text[to..])
    });
    let bare = ["trailing edge", "tip wedge"]
        .map(|name| ("ML409".to_owned(), line_of(&text, &format!("<MeshString name=\"{name}\""))));
    assert_eq!(found, bare);
}

#[test]
fn the_m6_is_inferred() {
    let dir = tempfile::tempdir().unwrap();
    let [output, report] = ["m6.xml", "m6.json"].map(|name| dir.path().join(name));
    sagitta(args!["link", m6("msh"), "--cad", m6("egads"), "-o", output, "--ignore-tags", "--report", report])
        .expect(0);
    let told = crate::common::json(&report);
    assert_eq!(told["undecided"].as_array().unwrap().len(), 0, "{told:#}");
    for patch in told["patches"].as_array().unwrap() {
        // Gmsh numbers the faces of a BREP file as this program does.
        let face = patch["entity"].as_str().unwrap().replace("surface ", "face:");
        assert_eq!(patch["cad_faces"][&face], patch["faces"], "{patch:#}");
    }
    sagitta(args!["validate", output, "--mesh", m6("msh"), "--cad", m6("egads"), "--strict"]).expect(0);
}

/// Runs the program with at most 1.5 GB of address space and 60 seconds of computing, however busy the machine is; beyond that the
/// system ends it.
fn limited(arguments: &[std::ffi::OsString]) -> (Option<i32>, String, String) {
    let mut shell = Command::new("sh");
    shell.args(["-c", "ulimit -v 1500000; ulimit -t 60; exec \"$@\"", "sh", env!("CARGO_BIN_EXE_sagitta")]);
    let output = shell.args(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code(), text(output.stdout), text(output.stderr))
}

#[test]
fn bad_files_are_reported_within_bounds() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| -> PathBuf {
        let path = dir.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let good = std::fs::read_to_string(fixture("cylinder_bl", "meshlink.xml")).unwrap();
    let bomb: String = (1..10).map(|n| format!("<!ENTITY l{n} \"{}\">", format!("&l{};", n - 1).repeat(10))).collect();
    let bomb = format!("<!DOCTYPE MeshLink [<!ENTITY l0 \"lol\">{bomb}]>");
    let with_bomb = good.replacen("<MeshLink ", &format!("{bomb}\n<MeshLink "), 1);
    let external = "<!DOCTYPE MeshLink [<!ENTITY secret SYSTEM \"file:///etc/passwd\">]>";
    let first_count = good.find("<MeshFace").map(|at| at + good[at..].find("count=\"").unwrap()).unwrap();
    let billion = format!("{}count=\"1000000000\" was=\"{}", &good[..first_count], &good[first_count + 7..]);
    let nested = format!("<MeshLink version=\"1.0\">{}", "<MeshFile filename=\"a\">".repeat(100_000));
    // Name, text, whether `curve` may use it, and what `validate` must say.
    let cases = [
        ("vtk.xml", "<?xml version=\"1.0\"?><VTKFile/>".to_owned(), false, "ML001"),
        ("html.xml", "<html><body>404</body></html>".to_owned(), false, "ML001"),
        ("cut.xml", good[..good.len() * 2 / 3].to_owned(), false, "ML001"),
        ("bomb.xml", with_bomb.replacen("name=\"wall\"", "name=\"&l9;\"", 1), false, "ML001"),
        (
            "external.xml",
            good.replacen("<MeshLink ", &format!("{external}\n<MeshLink "), 1).replacen("\"wall\"", "\"&secret;\"", 1),
            false,
            "ML001",
        ),
        ("doctype.xml", with_bomb, true, "ML109"),
        ("billion.xml", billion, false, "ML204"),
        (
            "attribute.xml",
            good.replacen("name=\"wall\"", &format!("name=\"{}\"", "w".repeat(4 << 20)), 1),
            false,
            "ML001",
        ),
        ("nested.xml", nested, false, "ML001"),
        ("namespace.xml", good.replace("https://cadence.com", "http://www.pointwise.com"), true, "ML101"),
        ("numbers.xml", good.replacen("1 98 318 9\n", "1 98 99999999999999999999 9\n", 1), false, "ML203"),
        ("negative.xml", good.replacen("1 98 318 9\n", "1 98 -318 9\n", 1), false, "ML203"),
        ("zero.xml", good.replacen("1 98 318 9\n", "1 98 0 9\n", 1), false, "ML203"),
        ("empty.xml", String::new(), false, "ML001"),
        ("nothing.xml", "<MeshLink version=\"1.0\" xmlns=\"https://cadence.com\"/>".to_owned(), false, "ML108"),
    ];
    let (mesh, cad, output) =
        (fixture("cylinder_bl", "msh"), fixture("cylinder_bl", "step"), dir.path().join("out.msh"));
    for (name, text, usable, code) in cases {
        assert_ne!(text, good, "{name}: nothing was spoilt");
        let path = write(name, &text);
        for more in [&args![][..], &args!["--mesh", mesh, "--cad", cad]] {
            let arguments: Vec<_> = args!["validate", path].into_iter().chain(more.iter().cloned()).collect();
            let (exit, stdout, stderr) = limited(&arguments);
            assert_eq!(exit, Some(1), "{name}: {stdout}{stderr}");
            let place = format!("{}:", path.display());
            let line = stdout.lines().find(|line| line.starts_with(&place) && line.contains(code));
            let line = line.unwrap_or_else(|| panic!("{name}: {code} is not in {stdout}"));
            assert!(
                line.len() < 1000 && line[place.len()..].starts_with(|c: char| c.is_ascii_digit()),
                "{name}: {line}"
            );
            assert!(!stdout.contains("root:"), "{name} tells of /etc/passwd");
        }
        let mut curve =
            args!["curve", mesh, "--cad", cad, "--linkage", path, "--order", "2", "-q", "-o", output].to_vec();
        curve.extend(args!["--max-sweeps", "1"]);
        let (exit, _, stderr) = limited(&curve);
        if usable {
            assert!(matches!(exit, Some(0 | 5)), "{name}: {exit:?} {stderr}");
        } else {
            assert_eq!((exit, stderr.lines().count()), (Some(2), 1), "{name}: {stderr}");
            assert!(stderr.contains(name) && stderr.len() < 1000, "{name}: {stderr}");
        }
    }
}

#[test]
fn large_files_take_little_time_and_memory() {
    // More than 30 MB of good faces of a mesh that is not at hand.
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("large.xml");
    let mut text = String::from(
        "<MeshLink version=\"1.0\" xmlns=\"https://cadence.com\"><MeshFile filename=\"a\"><MeshModelReference ref=\"m\">\n",
    );
    text.push_str("<MeshSheet name=\"s\"><MeshFace etype=\"Tri3\" count=\"1700000\">\n");
    for face in 0..1_700_000_u32 {
        text.push_str(&format!("{} {} {}\n", face + 1, face + 2, face + 3));
    }
    text.push_str("</MeshFace></MeshSheet></MeshModelReference></MeshFile></MeshLink>\n");
    std::fs::write(&path, &text).unwrap();
    assert!(text.len() > 30 << 20);
    let (exit, stdout, stderr) = limited(&args!["validate", path]);
    assert_eq!(exit, Some(0), "{stdout}{stderr}");
}

#[test]
fn what_is_written_is_valid_by_both_schemas() {
    let dir = tempfile::tempdir().unwrap();
    if Command::new("xmllint").arg("--version").output().is_err() {
        crate::common::warn("xmllint is missing: written linkage is NOT held against the schemas");
        return;
    }
    let mut schemas = vec![root().join("linkage-schema/linkage.xsd")];
    match std::env::var_os("SAGITTA_MESHLINK").filter(|folder| !folder.is_empty()) {
        Some(folder) => schemas.push(Path::new(&folder).join("MeshLink.xsd")),
        None => crate::common::warn("SAGITTA_MESHLINK is not set: written linkage is held against our own schema only"),
    }
    let periodic = root().join("fixtures/periodic/sector");
    let mut cases: Vec<PathBuf> = ["weeble", "weeble_hybrid", "cylinder_bl", "torus", "wing_sharp"]
        .map(|case| fixture(case, "msh").with_extension(""))
        .to_vec();
    cases.push(periodic);
    for case in cases {
        let output = dir.path().join("link.xml");
        for more in [&[][..], &["--ignore-tags"]] {
            let [mesh, cad] = ["msh", "step"].map(|extension| case.with_extension(extension));
            let arguments = args!["link", mesh, "--cad", cad, "-o", output];
            sagitta(arguments.into_iter().chain(more.iter().map(std::ffi::OsString::from))).expect(0);
            for schema in &schemas {
                let verdict =
                    Command::new("xmllint").args(["--noout", "--schema"]).arg(schema).arg(&output).output().unwrap();
                assert!(verdict.status.success(), "{}: {}", case.display(), String::from_utf8_lossy(&verdict.stderr));
            }
        }
    }
}
