//! `sagitta validate`: every defect is found, with its line, and nothing else; good files are clean.

mod defects;

use std::ffi::OsString;
use std::path::Path;

use crate::common::linkage::renumbered;
use crate::common::{fixture, sagitta};
use defects::{DEFECTS, Defect, FIRST_RUN};
use linkage_schema::Code;
use serde_json::Value;

/// What `sagitta validate --json` said.
struct Validation {
    code: i32,
    json: Value,
}

impl Validation {
    #[track_caller]
    fn of(linkage: &Path, more: &[OsString]) -> Validation {
        let arguments = args!["validate", linkage, "--json"];
        let outcome = sagitta(arguments.into_iter().chain(more.iter().cloned()));
        let json = serde_json::from_str(&outcome.stdout);
        let json = json.unwrap_or_else(|e| panic!("{e}\n{}\n{}", outcome.stdout, outcome.stderr));
        Validation { code: outcome.code.unwrap(), json }
    }

    /// With a case's mesh and STEP file.
    #[track_caller]
    fn full(case: &str, linkage: &Path) -> Validation {
        Validation::of(linkage, &args!["--mesh", fixture(case, "msh"), "--cad", fixture(case, "step")])
    }

    fn found(&self) -> Vec<(String, u32)> {
        let found = self.json["findings"].as_array().unwrap().iter();
        found.map(|f| (f["code"].as_str().unwrap().into(), f["line"].as_u64().unwrap_or(0) as u32)).collect()
    }

    fn codes(&self) -> Vec<String> {
        let mut codes: Vec<String> = self.found().into_iter().map(|(code, _)| code).collect();
        codes.sort();
        codes.dedup();
        codes
    }
}

/// The line, from 1, on which `needle` first stands.
#[track_caller]
fn line_of(text: &str, needle: &str) -> u32 {
    let at = text.find(needle).unwrap_or_else(|| panic!("{needle:?} is not in the file"));
    1 + text[..at].matches('\n').count() as u32
}

#[test]
fn good_files_are_clean() {
    for case in ["weeble", "weeble_hybrid", "wing_sharp", "sphere_shell", "cylinder_bl", "torus"] {
        for extension in ["meshlink.xml", "grouped.meshlink.xml"] {
            let file = fixture(case, extension);
            if !file.exists() {
                continue;
            }
            let validation = Validation::full(case, &file);
            assert_eq!(validation.found(), [], "{case}.{extension}");
            assert_eq!(validation.code, 0);
            let sum = |key: &str| -> u64 {
                validation.json["coverage"].as_array().unwrap().iter().map(|patch| patch[key].as_u64().unwrap()).sum()
            };
            assert!(sum("faces") > 0 && sum("faces") == sum("linked"), "{case}: {:#}", validation.json["coverage"]);
            let sheets = validation.json["sheets"].as_array().unwrap();
            assert!(
                !sheets.is_empty() && sheets.iter().all(|sheet| sheet["cad_distance_max"].as_f64().unwrap() < 1e-9),
                "{case}"
            );
        }
    }
}

#[test]
fn every_defect_is_found_at_its_line_and_nothing_else() {
    let good = std::fs::read_to_string(fixture("weeble", "meshlink.xml")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let mut problems: Vec<String> = Vec::new();
    for Defect { name, from, to, found: wanted } in DEFECTS {
        assert!(good.contains(from), "{name}: {from:?} is not in the file");
        let text = good.replacen(from, to, 1);
        let path = dir.path().join("defect.xml");
        std::fs::write(&path, &text).unwrap();
        let validation = Validation::full("weeble", &path);
        let wanted: Vec<(String, u32)> =
            wanted.iter().map(|(code, needle)| (code.id().to_owned(), line_of(&text, needle))).collect();
        let got = validation.found();
        let missing = wanted.iter().filter(|one| !got.contains(one));
        problems.extend(missing.map(|(code, line)| format!("{name}: {code} is not found at line {line}")));
        // Where a whole run or id is lost there is one finding for each thing that is left without it: the first is named in the table.
        let unwanted = got.iter().filter(|(code, _)| !wanted.iter().any(|(own, _)| own == code));
        problems.extend(unwanted.map(|(code, line)| format!("{name}: {code} at line {line} is a false alarm")));
        let clean =
            wanted.iter().all(|(code, _)| Code::from_id(code).unwrap().severity() == linkage_schema::Severity::Note);
        assert_eq!(validation.code, i32::from(!clean), "{name}");
    }
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

/// A file of a case, changed, and what is found in it with the case's mesh and CAD.
struct Spoilt {
    dir: tempfile::TempDir,
    text: String,
}

impl Spoilt {
    fn new(case: &str, extension: &str, change: impl FnOnce(String) -> String) -> Spoilt {
        let good = std::fs::read_to_string(fixture(case, extension)).unwrap();
        let spoilt = Spoilt { dir: tempfile::tempdir().unwrap(), text: change(good.clone()) };
        assert_ne!(spoilt.text, good, "nothing was spoilt");
        std::fs::write(spoilt.path(), &spoilt.text).unwrap();
        spoilt
    }

    fn path(&self) -> std::path::PathBuf {
        self.dir.path().join("spoilt.xml")
    }

    /// The findings are these, at the lines of these needles, and no others.
    #[track_caller]
    fn has(&self, validation: &Validation, wanted: &[(Code, &str)]) {
        let wanted: Vec<(String, u32)> =
            wanted.iter().map(|(code, needle)| (code.id().into(), line_of(&self.text, needle))).collect();
        assert_eq!(validation.found(), wanted, "{:#}", validation.json["findings"]);
    }
}

#[test]
fn a_file_that_is_off_by_one_is_named_as_such_and_else_as_good_as_before() {
    for (case, by) in [("weeble", 1), ("cylinder_bl", 1)] {
        let spoilt = Spoilt::new(case, "meshlink.xml", |text| renumbered(&text, by));
        let validation = Validation::full(case, &spoilt.path());
        spoilt.has(&validation, &[(Code::IndexBase, "<MeshModelReference")]);
        assert!(validation.json["findings"][0]["message"].as_str().unwrap().contains("counts points from 2"));
    }
    for case in ["weeble", "cylinder_bl"] {
        let spoilt = Spoilt::new(case, "meshlink.xml", |text| renumbered(&text, -1));
        let validation = Validation::full(case, &spoilt.path());
        // Zeros are found where they stand; everything else follows from the base.
        assert_eq!(validation.codes(), [Code::BadIndex.id(), Code::IndexBase.id()], "{case}");
        let base = (Code::IndexBase.id().to_owned(), line_of(&spoilt.text, "<MeshModelReference"));
        assert!(validation.found().contains(&base));
    }
}

#[test]
fn a_mesh_of_another_case_is_recognised() {
    for (case, other) in
        [("weeble", "torus"), ("torus", "weeble"), ("cylinder_bl", "sphere_shell"), ("weeble", "weeble_hybrid")]
    {
        let linkage = fixture(case, "meshlink.xml");
        let text = std::fs::read_to_string(&linkage).unwrap();
        let validation =
            Validation::of(&linkage, &args!["--mesh", fixture(other, "msh"), "--cad", fixture(case, "step")]);
        let wanted = [(Code::OtherMeshFile, "<MeshFile"), (Code::OtherMesh, "<MeshModelReference")];
        let wanted = wanted.map(|(code, needle)| (code.id().to_owned(), line_of(&text, needle)));
        assert_eq!(validation.found(), wanted, "{case} with the mesh of {other}");
    }
}

#[test]
fn broken_files_are_one_finding_at_their_place() {
    let cut = Spoilt::new("weeble", "meshlink.xml", |text| text[..text.len() / 2].to_owned());
    let validation = Validation::full("weeble", &cut.path());
    assert_eq!(validation.found(), [(Code::Unreadable.id().to_owned(), 1 + cut.text.matches('\n').count() as u32)]);
    for (text, line) in [
        ("$MeshFormat\n", 1),
        ("<?xml version='1.0'?>\n<VTKFile/>\n", 2),
        ("<MeshLink version='1.0'>\n<GeometryFile filename='a'></MeshFile></MeshLink>", 2),
    ] {
        let spoilt = Spoilt::new("weeble", "meshlink.xml", |_| text.to_owned());
        let validation = Validation::full("weeble", &spoilt.path());
        assert_eq!(
            (validation.found(), validation.code),
            (vec![(Code::Unreadable.id().to_owned(), line)], 1),
            "{text}"
        );
    }
    for linkage in ["/nowhere/a.xml", "/"] {
        let outcome = sagitta(args!["validate", linkage]).expect(2);
        assert!(outcome.stderr.contains(linkage) && outcome.stdout.is_empty(), "{}", outcome.stderr);
    }
}

#[test]
fn faces_given_twice_left_out_or_inside() {
    let twice = Spoilt::new("weeble", "meshlink.xml", |text| {
        let at = text.find(FIRST_RUN).unwrap() + FIRST_RUN.len();
        let first = text[at..].lines().nth(1).unwrap().trim().to_owned();
        let turned = first.split(' ').collect::<Vec<_>>();
        let turned = [turned[2], turned[0], turned[1]].join(" ");
        let run = format!("<MeshFace etype=\"Tri3\">{turned}</MeshFace>\n      </MeshSheet>");
        text.replacen("</MeshSheet>", &run, 1)
    });
    twice.has(&Validation::full("weeble", &twice.path()), &[(Code::RepeatedFace, "<MeshFace etype=\"Tri3\">")]);

    let fewer = Spoilt::new("torus", "meshlink.xml", |text| {
        let (head, tail) = text.split_once("count=\"330\">\n").unwrap();
        format!("{head}count=\"329\">\n{}", tail.split_once('\n').unwrap().1)
    });
    fewer.has(&Validation::full("torus", &fewer.path()), &[(Code::PartlyCovered, "count=\"329\"")]);

    // Nodes 1 and 2 are the far field's poles; a face of theirs with a wall node is none of the mesh.
    let foreign = Spoilt::new("weeble", "meshlink.xml", |text| {
        text.replacen("</MeshSheet>", "<MeshFace etype=\"Tri3\">1 2 3</MeshFace>\n</MeshSheet>", 1)
    });
    foreign.has(&Validation::full("weeble", &foreign.path()), &[(Code::NotInMesh, ">1 2 3<")]);
}

#[test]
fn faces_inside_the_volume_say_so() {
    let mesh = sagitta::formats::read(&fixture("cylinder_bl", "msh")).unwrap();
    let boundary = sagitta::mesh::Boundary::new(&mesh);
    let block = mesh.blocks().iter().find(|block| block.cell.dimension() == 3).unwrap();
    let inner = block.elements(mesh.order()).find_map(|nodes| {
        let mut faces = block.cell.faces().iter().map(|face| face.corners.iter().map(|&c| nodes[usize::from(c)]));
        faces.find_map(|face| Some(face.collect::<Vec<_>>()).filter(|corners| boundary.face(corners).is_none()))
    });
    let tags: Vec<String> = inner.unwrap().iter().map(|n| mesh.node_tags()[n.index()].to_string()).collect();
    let spoilt = Spoilt::new("cylinder_bl", "meshlink.xml", |text| {
        let run = format!("<MeshFace etype=\"Quad4\">{}</MeshFace>\n</MeshSheet>", tags.join(" "));
        text.replacen("</MeshSheet>", &run, 1)
    });
    let validation = Validation::of(&spoilt.path(), &args!["--mesh", fixture("cylinder_bl", "msh")]);
    spoilt.has(&validation, &[(Code::InteriorFace, "<MeshFace etype=\"Quad4\">")]);
}

#[test]
fn the_other_side_of_a_thin_wing() {
    // Upper and lower sheet change places; with a tolerance thicker than the wing only the side can tell.
    let swapped = Spoilt::new("wing_sharp", "meshlink.xml", |text| {
        let text = text.replacen("name=\"wall/face-1\" gref=\"1\"", "name=\"wall/face-1\" gref=\"2\"", 1);
        text.replacen("name=\"wall/face-2\" gref=\"2\"", "name=\"wall/face-2\" gref=\"1\"", 1)
    });
    let files = args!["--mesh", fixture("wing_sharp", "msh"), "--cad", fixture("wing_sharp", "step")];
    let off = Validation::of(&swapped.path(), &files);
    assert_eq!(off.codes(), [Code::OffGeometry.id()]);
    let loose: Vec<OsString> = files.into_iter().chain(args!["--tolerance", "0.2"]).collect();
    let sides = Validation::of(&swapped.path(), &loose);
    assert_eq!(sides.codes(), [Code::WrongSide.id()], "{:#}", sides.json["findings"]);
    // Both runs, at the line of the first such face.
    let lines: Vec<&str> = swapped.text.lines().collect();
    let findings = sides.json["findings"].as_array().unwrap();
    for finding in findings {
        let line = lines[finding["line"].as_u64().unwrap() as usize - 1].trim().replace(' ', ", ");
        let message = finding["message"].as_str().unwrap();
        assert!(message.ends_with(&format!("[{line}]")), "{message}: {line}");
    }
    assert_eq!(findings.len(), 2);
}

#[test]
fn sharp_edges_inside_a_sheet() {
    // The wall is one sheet on a group; without the string its rim may leave the edge.
    let free = Spoilt::new("weeble", "grouped.meshlink.xml", |text| {
        let from = text.find("<MeshString name=\"edge-6\"").unwrap();
        let to = from + text[from..].find("</MeshString>").unwrap() + "</MeshString>".len();
        format!("{}{}", &text[..from], &text[to..])
    });
    free.has(&Validation::full("weeble", &free.path()), &[(Code::SharpEdgeFree, "count=\"354\"")]);

    // A node of the rim slides up the waist: the faces below it now reach over the edge.
    let dir = tempfile::tempdir().unwrap();
    let moved = dir.path().join("weeble.msh");
    let mut mesh = sagitta::formats::read(&fixture("weeble", "msh")).unwrap();
    let rim = mesh.node_tags().iter().position(|&tag| tag == 25).unwrap();
    let waist = mesh.node_tags().iter().position(|&tag| tag == 39).unwrap();
    let (x, up) = (mesh.points()[rim], mesh.points()[waist]);
    // The waist is a surface of revolution about z: the same height and radius, turned.
    let angle = x.y.atan2(x.x);
    let radius = up.x.hypot(up.y);
    mesh.points_mut()[rim] = glam::DVec3::new(radius * angle.cos(), radius * angle.sin(), up.z);
    sagitta::formats::write(&moved, &mesh, &sagitta::formats::WriteOptions::default()).unwrap();
    let linkage = fixture("weeble", "grouped.meshlink.xml");
    let text = std::fs::read_to_string(&linkage).unwrap();
    let validation = Validation::of(&linkage, &args!["--mesh", moved, "--cad", fixture("weeble", "step")]);
    let crossed = (Code::SharpEdgeCrossed.id().to_owned(), line_of(&text, "count=\"354\""));
    assert!(validation.found().contains(&crossed), "{:#}", validation.json["findings"]);
    let off = (Code::OffGeometry.id().to_owned(), line_of(&text, "count=\"19\""));
    assert!(validation.found().contains(&off), "{:#}", validation.json["findings"]);
}

#[test]
fn another_unit_is_one_finding() {
    let dir = tempfile::tempdir().unwrap();
    let scaled = dir.path().join("weeble.msh");
    let mut mesh = sagitta::formats::read(&fixture("weeble", "msh")).unwrap();
    mesh.points_mut().iter_mut().for_each(|x| *x *= 0.001);
    sagitta::formats::write(&scaled, &mesh, &sagitta::formats::WriteOptions::default()).unwrap();
    let linkage = fixture("weeble", "meshlink.xml");
    let validation = Validation::of(&linkage, &args!["--mesh", scaled, "--cad", fixture("weeble", "step")]);
    assert_eq!(validation.codes(), [Code::OtherScale.id()]);
}

#[test]
fn notes_count_only_when_strict_and_text_names_file_line_and_remedy() {
    let spoilt =
        Spoilt::new("weeble", "meshlink.xml", |text| text.replace("filename=\"weeble.step\"", "filename=\"w.nmb\""));
    let plain = sagitta(args!["validate", spoilt.path()]).expect(0).stdout;
    sagitta(args!["validate", spoilt.path(), "--strict"]).expect(1);
    let start = format!("{}:{}:3: note ML509: ", spoilt.path().display(), line_of(&spoilt.text, "<GeometryFile"));
    assert!(plain.starts_with(&start) && plain.contains(Code::UnreadableGeometry.remedy()), "{plain}");
}

#[test]
fn every_code_is_explained() {
    let all = sagitta(["explain"]).expect(0).stdout;
    for code in Code::ALL {
        assert!(all.lines().any(|line| line.starts_with(code.id()) && line.contains(code.meaning())), "{code}");
        let one = sagitta(["explain", &code.id().to_lowercase()]).expect(0).stdout;
        assert!([code.id(), code.meaning(), code.remedy()].iter().all(|part| one.contains(part)), "{one}");
    }
    let outcome = sagitta(["explain", "ML999"]).expect(2);
    assert!(outcome.stderr.contains("ML999"), "{}", outcome.stderr);
}
