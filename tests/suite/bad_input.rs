//! Wrong use and bad input: one line on stderr that names the file and the cause, exit code 2, and no file left behind.

use std::ffi::OsString;
use std::path::Path;

use crate::common::input::{CASE, Input, Place};
use crate::common::{fixture, names_in, sagitta};
use sagitta::formats::msh::{Encoding, Version};
use sagitta::formats::{self, WriteOptions};

/// One edge, no face.
const EDGE: &str = "DBRep_DrawableShape\n\nCASCADE Topology V3, (c) Open Cascade\nLocations 0\nCurve2ds 0\nCurves 1\n\
    1 0 0 0 1 0 0 \nPolygon3D 0\nPolygonOnTriangulations 0\nSurfaces 0\nTriangulations 0\n\nTShapes 3\nVe\n1e-07\n0 0 0\n\
    0 0\n\n0101101\n*\nVe\n1e-07\n1 0 0\n0 0\n\n0101101\n*\nEd\n 1e-07 1 1 0\n1  1 0 0 1\n0\n\n1101000\n+3 0 -2 0 *\n\n+1 0 ";

#[test]
fn the_input_that_is_spoilt_here_is_good_before() {
    let place = Place::new();
    let outcome = sagitta(Input::linkage(fixture(CASE, "meshlink.xml")).arguments(&place.output())).expect(0);
    assert_eq!(outcome.stderr, "", "-q is quiet");
    assert_eq!(names_in(&place.dir.path().join("out")), ["curved.msh"]);
    sagitta(Input::mesh(place.mesh("same.msh", |_| ())).arguments(&place.output())).expect(0);
}

#[test]
fn files_that_cannot_be_read() {
    let place = Place::new();
    let missing = |name: &str| place.dir.path().join("in").join(name);
    for (input, name) in [
        (Input::mesh(missing("no.msh")), "no.msh"),
        (Input::cad(missing("no.step")), "no.step"),
        (Input::linkage(missing("no.xml")), "no.xml"),
    ] {
        place.refuses(input, &[name, "No such file"]);
    }
    let folder = place.dir.path().join("in");
    place.refuses(Input::mesh(&folder), &["/in", "not a regular file"]);
    place.refuses(Input::cad(&folder), &["/in"]);
    place.refuses(Input::linkage(&folder), &["/in"]);
}

#[test]
fn files_of_the_wrong_kind() {
    let place = Place::new();
    let (mesh, step, xml) = (fixture(CASE, "msh"), fixture(CASE, "step"), fixture(CASE, "meshlink.xml"));
    place.refuses(Input::mesh(&step), &["cylinder_bl.step", "CAD, not a mesh"]);
    place.refuses(Input::mesh(fixture(CASE, "igs")), &["cylinder_bl.igs", "not a mesh file"]);
    place.refuses(Input::mesh(&xml), &["cylinder_bl.meshlink.xml", "XML"]);
    place.refuses(Input::cad(&mesh), &["cylinder_bl.msh", "not a CAD file"]);
    place.refuses(Input::cad(&xml), &["cylinder_bl.meshlink.xml", "not a CAD file"]);
    place.refuses(Input::linkage(&step), &["cylinder_bl.step", "not an XML file"]);
    place.refuses(Input::linkage(place.write("other.xml", "<a><b/></a>")), &["other.xml:1", "not MeshLink"]);
    place.refuses(Input::mesh(place.write("empty.msh", "")), &["empty.msh", "empty"]);
    place.refuses(Input::cad(place.write("empty.step", "")), &["empty.step"]);
    place.refuses(Input::linkage(place.write("empty.xml", "")), &["empty.xml"]);
    place.refuses(Input::mesh(place.write("noise.msh", [0xfe; 999])), &["noise.msh", "not a mesh file"]);
    place.refuses(Input::cad(place.write("noise.step", [0xfe; 999])), &["noise.step", "not a CAD file"]);
}

#[test]
fn damaged_meshes() {
    let place = Place::new();
    let bytes = std::fs::read(fixture(CASE, "msh")).unwrap();
    for share in [0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.999] {
        let cut = place.write("cut.msh", &bytes[..(bytes.len() as f64 * share) as usize]);
        place.refuses(Input::mesh(&cut), &["cut.msh", "cut"]);
        let checked = sagitta(args!["check", cut]).expect(2);
        assert_eq!(checked.stderr.lines().count(), 1, "{}", checked.stderr);
        assert!(checked.stderr.contains("cut.msh") && checked.stdout.is_empty(), "{}", checked.stderr);
    }
    let text = place.dir.path().join("in/text.msh");
    let options = WriteOptions { msh_version: Version::V2_2, msh_encoding: Encoding::Ascii, ..WriteOptions::default() };
    formats::write(&text, &formats::read(&fixture(CASE, "msh")).unwrap(), &options).unwrap();
    let text = std::fs::read_to_string(&text).unwrap();
    let (head, elements) = text.split_at(text.find("$Elements").unwrap());
    // "number type tags ...": a hexahedron is 5, a quadrilateral 3.
    let unknown = format!("{head}{}", elements.replacen(" 5 2 ", " 777 2 ", 1));
    assert_ne!(unknown, text);
    place.refuses(Input::mesh(place.write("unknown.msh", unknown)), &["unknown.msh, line ", "element type 777"]);
    let flat = place.mesh("flat.msh", |parts| parts.blocks.retain(|block| block.cell.dimension() < 3));
    place.refuses(Input::mesh(flat), &["flat.msh", "no volume elements", "in one plane"]);
    let curved = place.dir.path().join("in/p2.msh");
    sagitta(Input::default().arguments(&curved)).expect(0);
    place.refuses(Input::mesh(curved), &["p2.msh", "P2", "linear mesh"]);
}

#[test]
fn options_out_of_range() {
    let place = Place::new();
    let (mesh, cad) = (fixture(CASE, "msh"), fixture(CASE, "step"));
    let tried = |options: &[&str], needles: &[&str]| {
        let all = args!["curve", mesh, "--cad", cad].into_iter().chain(options.iter().map(OsString::from));
        let outcome = sagitta(all).expect(2);
        let first = outcome.stderr.lines().next().unwrap_or_default().to_owned();
        let errors = outcome.stderr.lines().filter(|line| line.starts_with("error")).count();
        assert!(errors <= 1 && outcome.stdout.is_empty(), "{options:?}: {}", outcome.stderr);
        for needle in needles {
            assert!(first.contains(needle), "{needle:?} is not in: {first}");
        }
        assert_eq!(names_in(&place.dir.path().join("out")), [""; 0], "{options:?}");
    };
    let output = place.output().display().to_string();
    let out = ["-q", "-o", &output];
    for order in ["1", "5", "0", "x", "-2", "2.5", ""] {
        tried(&[&out[..], &[&format!("--order={order}")]].concat(), &["--order", &format!("'{order}'")]);
    }
    let out = [&out[..], &["--order", "2"]].concat();
    for (option, value) in [
        ("--cad-scale", "0"),
        ("--cad-scale", "nan"),
        ("--max-offset", "-1"),
        ("--threshold", "1.5"),
        ("--alpha", "x"),
        ("--threads", "0"),
        ("--survey-factor", "0"),
        ("--msh-version", "3"),
    ] {
        tried(&[&out[..], &[&format!("{option}={value}")]].concat(), &[option, value]);
    }
    tried(&[&out[..], &["--nonsense"]].concat(), &["--nonsense"]);
    tried(&["--order", "2"], &["required"]);
}

#[test]
fn output_that_cannot_be_written() {
    let place = Place::new();
    let out = place.dir.path().join("out");
    let report = out.join("none/report.json");
    let tried = |output: &Path, more: &[&str], needles: &[&str]| {
        let outcome = sagitta(Input::default().with(more).arguments(output)).expect(2);
        let told = outcome.stderr;
        assert_eq!(told.lines().count(), 1, "{told}");
        assert!(needles.iter().all(|needle| told.contains(needle)), "{needles:?} are not in: {told}");
        assert_eq!(names_in(&out), [""; 0], "{told}");
    };
    let written = sagitta::formats::REGISTRY.iter().filter(|format| format.writer.is_some());
    let endings: Vec<String> = written.flat_map(|format| format.endings).map(|ending| format!(".{ending}")).collect();
    for name in ["curved.stl", "curved"] {
        let needles: Vec<&str> = [name].into_iter().chain(endings.iter().map(String::as_str)).collect();
        tried(&out.join(name), &[], &needles);
    }
    tried(&out.join("none/curved.msh"), &[], &["none/curved.msh", "No such file"]);
    tried(&out.join("curved.msh"), &["--report", &report.display().to_string()], &["none/report.json", "No such file"]);
}

#[test]
fn cad_without_faces() {
    let place = Place::new();
    place.refuses(Input::cad(place.write("edge.brep", EDGE)), &["edge.brep", "no face"]);
    let nothing = "DBRep_DrawableShape\n\nCASCADE Topology V3, (c) Open Cascade\nLocations 0\nCurve2ds 0\nCurves 0\n\
        Polygon3D 0\nPolygonOnTriangulations 0\nSurfaces 0\nTriangulations 0\n\nTShapes 1\nCo\n\n1100000\n*\n\n+1 0 ";
    place.refuses(Input::cad(place.write("nothing.brep", nothing)), &["nothing.brep", "no face"]);
}

/// Numbers that look random and are the same in every run.
struct Noise(u64);

impl Noise {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) as usize % limit
    }
}

/// A file of the case cut off at some places, the last of them just before its end.
fn cuts(place: &Place, extension: &str) {
    let whole = std::fs::read(fixture(CASE, extension)).unwrap();
    let end = whole.len() - if extension == "igs" { 81 } else { 20 };
    for length in
        [0.1, 0.3, 0.6, 0.7, 0.8, 0.9].map(|share| (whole.len() as f64 * share) as usize).into_iter().chain([end])
    {
        let name = format!("cut_{length}.{extension}");
        place.refuses(Input::cad(place.write(&name, &whole[..length])), &[&name]);
    }
}

#[test]
fn truncated_step() {
    cuts(&Place::new(), "step");
}

#[test]
fn truncated_iges() {
    cuts(&Place::new(), "igs");
}

/// Damage may miss all that counts; but the program ends in order, and exit code 2 goes with one line and no file.
#[test]
fn spoilt_cad() {
    let place = Place::new();
    let mut noise = Noise(0x7361_6769);
    let mut refused = 0;
    for extension in ["step", "igs"] {
        let whole = std::fs::read(fixture(CASE, extension)).unwrap();
        for round in 0..6 {
            let mut bytes = whole.clone();
            for _ in 0..40 {
                let (at, by) = (noise.below(bytes.len()), noise.below(95) as u8);
                bytes[at] = b' ' + by;
            }
            let spoilt = place.write(&format!("spoilt.{extension}"), bytes);
            let outcome = sagitta(Input::cad(spoilt).with(&["--max-sweeps", "20"]).arguments(&place.output()));
            let (code, told) = (outcome.code, outcome.stderr);
            assert!(matches!(code, Some(0 | 2 | 3 | 5)), "{extension} {round}: {code:?} {told}");
            assert_eq!(place.output().exists(), code != Some(2), "{extension} {round}: {told}");
            if code == Some(2) {
                refused += 1;
                assert!(told.lines().count() == 1 && told.contains("spoilt."), "{extension} {round}: {told}");
            } else {
                std::fs::remove_file(place.output()).unwrap();
            }
        }
    }
    assert!(refused > 0, "the damage is so small that nothing is tried");
}

#[test]
fn linkage_that_refers_to_nothing() {
    let place = Place::new();
    let cases = [
        ("group.xml", r#"name="wall/face-4" gref="4""#, r#"name="wall/face-4" gref="404""#, "404"),
        ("face.xml", r#"ref="face-4""#, r#"ref="face-99""#, "face-99"),
        ("edge.xml", r#"ref="edge-3""#, r#"ref="edge-77""#, "edge-77"),
        ("node.xml", "1 98 318 9\n", "1 98 318 90000\n", "node 90000"),
        ("no_face.xml", "1 98 318 9\n", "1 98 318 2\n", "[1, 98, 318, 2], which is no boundary face"),
        ("string.xml", "1 9 9 10 10 11", "1 9 9 10 10 70000", "node 70000"),
        ("broken.xml", "</MeshSheet>", "</MeshSheets>", "MeshSheet"),
    ];
    for (name, from, to, needle) in cases {
        let told = place.refuses(Input::linkage(place.linkage(name, from, to)), &[name, needle]);
        // File, line, column.
        let at: Vec<&str> = told.split(name).nth(1).unwrap().splitn(4, ':').collect();
        assert!(at.len() == 4 && at[1..3].iter().all(|n| n.trim().parse::<u64>().is_ok()), "{told}");
    }
    // What is not where the file says is the file's fault, whatever the mesh and the CAD are called.
    let elsewhere = place.linkage("elsewhere.xml", r#"ref="edge-3""#, r#"ref="edge-9""#);
    place.refuses(Input::linkage(elsewhere), &["elsewhere.xml for ", "is associated with edge:9"]);
    let other = fixture("torus", "meshlink.xml");
    place.refuses(Input::linkage(&other), &["torus.meshlink.xml:", "no boundary face"]);
    let text = std::fs::read_to_string(fixture(CASE, "meshlink.xml")).unwrap();
    let cut = place.write("cut.xml", &text[..text.len() / 2]);
    place.refuses(Input::linkage(cut), &["cut.xml:"]);
}

#[test]
fn tags_that_do_not_hold() {
    let place = Place::new();
    // Far field (a cylinder) and a side wall change their numbers.
    let swapped = place.mesh("swapped.msh", |parts| {
        for block in parts.blocks.iter_mut().filter(|block| block.entity.dimension == 2) {
            block.entity.tag = match block.entity.tag {
                2 => 5,
                5 => 2,
                tag => tag,
            };
        }
    });
    let strange = place.mesh("strange.msh", |parts| {
        parts.blocks.iter_mut().filter(|block| block.entity.dimension == 2).for_each(|b| b.entity.tag += 100);
    });
    // The association is found by geometry then, all of it, and the report says so.
    for (mesh, patch) in [(swapped, "farfield surface 2 "), (strange, "surface 105 ")] {
        let arguments = Input::mesh(&mesh).with(&["--dry-run"]).arguments(&place.output());
        let told = sagitta(arguments).expect(0).stdout;
        assert!(told.starts_with("association by geometry"), "{told}");
        let of_patch = told.lines().find(|line| line.starts_with(patch)).unwrap_or_else(|| panic!("{told}"));
        assert!(of_patch.ends_with("  face:5 (45)"), "{told}");
        let outcome = sagitta(Input::mesh(&mesh).with(&["--max-sweeps", "5"]).arguments(&place.output()));
        let note = "associated by geometry, with 0 faces and 0 edges undecided";
        assert!(outcome.stdout.contains(note), "{:?} {}{}", outcome.code, outcome.stdout, outcome.stderr);
        std::fs::remove_file(place.output()).unwrap();
    }
    // Where geometry does not tell either, what is wrong with the tags is told.
    let lost = place.mesh("lost.msh", |parts| {
        parts.blocks.iter_mut().filter(|block| block.entity.dimension == 2).for_each(|b| b.entity.tag += 100);
        parts.points.iter_mut().for_each(|x| *x += glam::DVec3::splat(0.05));
    });
    place.refuses(Input::mesh(lost), &["lost.msh", "cylinder_bl.step", "no part of the mesh is associated"]);
}

#[test]
fn inverted_linear_elements() {
    let place = Place::new();
    let mut turned = Vec::new();
    let mesh = place.mesh("turned.msh", |parts| {
        let (order, blocks) = (parts.order, &mut parts.blocks);
        let block = blocks.iter_mut().find(|block| block.cell.dimension() == 3).unwrap();
        let stride = block.stride(order);
        assert_eq!(stride, 8, "hexahedra");
        for element in [3, 57] {
            turned.push(block.tags[element]);
            let nodes = &mut block.nodes[element * stride..][..stride];
            let (bottom, top) = nodes.split_at_mut(4);
            bottom.swap_with_slice(top);
        }
    });
    let [first, second] = [0, 1].map(|n| format!("hex {}", turned[n]));
    place.refuses(Input::mesh(&mesh), &["turned.msh", "inverted in 2 elements", &first, &second]);
    // `check` runs on it and tells that it is invalid.
    let checked = sagitta(args!["check", mesh]).expect(4);
    assert!(checked.stdout.contains("NOT certified: 2 elements"), "{}", checked.stdout);
    for element in [first, second] {
        assert!(checked.stdout.contains(&format!("invalid {element} ")), "{element}: {}", checked.stdout);
    }
}
