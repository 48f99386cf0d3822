//! Mesh files of several zones, and linkage files that count the points of each apart.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::common::measure::measure;
use crate::common::sample::sample;
use crate::common::{fixture, json, number, root, sagitta};
use tempfile::TempDir;

/// Points of a block of the ring: around, outward, along.
const SIZE: [usize; 3] = [9, 5, 3];

/// The half ring of `cylinder_bl` as a PLOT3D file of two blocks, a quarter each.
fn two_quarters(path: &Path) {
    let mut text = format!("2\n{0} {1} {2}\n{0} {1} {2}\n", SIZE[0], SIZE[1], SIZE[2]);
    for block in 0..2 {
        let place = |i: usize, j: usize, k: usize| {
            let angle = (block * (SIZE[0] - 1) + i) as f64 / (2 * (SIZE[0] - 1)) as f64 * std::f64::consts::PI;
            let radius = 0.5 * 10_f64.powf(j as f64 / (SIZE[1] - 1) as f64);
            [radius * angle.cos(), radius * angle.sin(), k as f64 / (SIZE[2] - 1) as f64]
        };
        for axis in 0..3 {
            for k in 0..SIZE[2] {
                for j in 0..SIZE[1] {
                    (0..SIZE[0]).for_each(|i| writeln!(text, "{:.17e}", place(i, j, k)[axis]).unwrap());
                }
            }
        }
    }
    std::fs::write(path, text).unwrap();
}

struct Ring {
    dir: TempDir,
    mesh: PathBuf,
    cad: PathBuf,
    linkage: PathBuf,
}

impl Ring {
    /// The ring, linked by geometry.
    fn new() -> Ring {
        let dir = tempfile::tempdir().unwrap();
        let [mesh, linkage] = ["ring.x", "ring.xml"].map(|name| dir.path().join(name));
        two_quarters(&mesh);
        let cad = fixture("cylinder_bl", "step");
        let report = dir.path().join("link.json");
        sagitta(args!["link", mesh, "--cad", cad, "-o", linkage, "--report", report]).expect(0);
        assert_eq!(json(&report)["undecided"].as_array().unwrap().len(), 0);
        Ring { dir, mesh, cad, linkage }
    }

    fn text(&self) -> String {
        std::fs::read_to_string(&self.linkage).unwrap()
    }

    /// The linkage file, changed.
    fn spoilt(&self, change: impl FnOnce(String) -> String) -> (PathBuf, String) {
        let text = change(self.text());
        assert_ne!(text, self.text());
        let path = self.dir.path().join("spoilt.xml");
        std::fs::write(&path, &text).unwrap();
        (path, text)
    }

    fn curve(&self, linkage: &Path, more: &[OsString]) -> crate::common::Outcome {
        let output = self.dir.path().join("curved.msh");
        let arguments = args!["curve", self.mesh, "--cad", self.cad, "--linkage", linkage, "--order", "2", "-q"];
        sagitta(arguments.into_iter().chain(args!["-o", output]).chain(more.iter().cloned()))
    }

    /// Codes and lines of what `validate` finds.
    fn found(&self, linkage: &Path) -> Vec<(String, u64)> {
        let outcome = sagitta(args!["validate", linkage, "--mesh", self.mesh, "--cad", self.cad, "--json"]);
        let told: serde_json::Value = serde_json::from_str(&outcome.stdout).unwrap();
        let findings = told["findings"].as_array().unwrap().iter();
        findings.map(|f| (f["code"].as_str().unwrap().to_owned(), f["line"].as_u64().unwrap())).collect()
    }
}

fn line_of(text: &str, needle: &str) -> u64 {
    1 + text[..text.find(needle).unwrap()].matches('\n').count() as u64
}

#[test]
fn a_file_of_two_blocks_is_linked_block_by_block_and_curved() {
    let ring = Ring::new();
    let text = ring.text();
    assert!(["/Base/blk-1", "/Base/blk-2"].iter().all(|name| text.contains(&format!("ref=\"{name}\""))), "{text}");
    let document = linkage_schema::read_path(&ring.linkage).unwrap().accept().unwrap();
    let count = (SIZE[0] * SIZE[1] * SIZE[2]) as u32;
    for model in &document.mesh_files[0].models {
        let runs = model.sheets.iter().flat_map(|sheet| match &sheet.body {
            linkage_schema::SheetBody::Faces(runs) => &runs[..],
            _ => &[],
        });
        let indices: Vec<u32> = runs.flat_map(|run| run.indices.iter().copied()).collect();
        assert_eq!(indices.iter().max(), Some(&count), "indices count from 1 in each block");
    }
    sagitta(args!["validate", ring.linkage, "--mesh", ring.mesh, "--cad", ring.cad, "--strict"]).expect(0);
    let report = ring.dir.path().join("report.json");
    ring.curve(&ring.linkage, &args!["--report", report]).expect(0);
    let report = json(&report);
    assert_eq!((&report["certified"], &report["faces_without_cad"]), (&true.into(), &0.into()), "{report:#}");
    for patch in report["patches"].as_array().unwrap() {
        assert!(number(patch, "/cad_distance_max") < 1e-2, "{patch:#}");
    }
    // A zone by its name alone is the same zone.
    let (short, _) = ring.spoilt(|text| text.replace("/Base/blk-", "blk-"));
    assert_eq!(ring.found(&short), []);
    ring.curve(&short, &[]).expect(0);
}

#[test]
fn numbers_mean_those_of_the_named_block() {
    let ring = Ring::new();
    // Both blocks have the same numbers; changed over, they are at the other end of the ring.
    let (swapped, _) = ring.spoilt(|text| {
        text.replace("ref=\"/Base/blk-1\"", "ref=\"?\"")
            .replace("ref=\"/Base/blk-2\"", "ref=\"/Base/blk-1\"")
            .replace("ref=\"?\"", "ref=\"/Base/blk-2\"")
    });
    let found = ring.found(&swapped);
    assert!(found.iter().any(|(code, _)| code == "ML503"), "{found:?}");
    ring.curve(&swapped, &[]).expect(2);
    // A number that the other block's points have among all, but no block has.
    let last = SIZE[0] * SIZE[1] * SIZE[2];
    let (beyond, text) = ring.spoilt(|text| text.replacen(&format!(" {last} "), &format!(" {} ", last + 1), 1));
    let found = ring.found(&beyond);
    let line = line_of(&text, &format!(" {} ", last + 1));
    assert!(found.contains(&("ML401".to_owned(), line)), "{found:?} {line}");
    let told = ring.curve(&beyond, &[]).expect(2).stderr;
    assert!(told.contains(&format!("node {}", last + 1)) && told.contains(&format!("up to {last}")), "{told}");
}

#[test]
fn a_block_that_the_mesh_does_not_have_is_named() {
    let ring = Ring::new();
    let (unknown, text) = ring.spoilt(|text| text.replace("/Base/blk-2", "/Base/inlet"));
    let line = line_of(&text, "/Base/inlet");
    let found = ring.found(&unknown);
    assert!(found.contains(&("ML415".to_owned(), line)), "{found:?}");
    let told = ring.curve(&unknown, &[]).expect(2).stderr;
    for word in [&format!("spoilt.xml:{line}:"), "/Base/inlet", "/Base/blk-1, /Base/blk-2"] {
        assert!(told.contains(word), "{word}: {told}");
    }
}

#[test]
fn zones_of_a_cgns_file() {
    let mesh = root().join("fixtures/samples/two_zones.cgns");
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("cubes.xml");
    // The inlet is the left cube's first side, the outlet the right cube's second; both cubes count from 1 to 8.
    let text = |left: &str, right: &str, outlet: &str| {
        format!(
            "<MeshLink version=\"1.0\" xmlns=\"https://cadence.com\">\n<GeometryFile filename=\"cubes.step\">\
             <GeometryReference gid=\"1\" ref=\"face-1\"/><GeometryReference gid=\"2\" ref=\"face-2\"/></GeometryFile>\n\
             <MeshFile filename=\"two_zones.cgns\">\n<MeshModelReference ref=\"{left}\">\
             <MeshSheet name=\"inlet\" gref=\"1\"><MeshFace etype=\"Quad4\">1 4 8 5</MeshFace></MeshSheet></MeshModelReference>\n\
             <MeshModelReference ref=\"{right}\">\
             <MeshSheet name=\"outlet\" gref=\"2\"><MeshFace etype=\"Quad4\">{outlet}</MeshFace></MeshSheet></MeshModelReference>\n\
             </MeshFile></MeshLink>\n"
        )
    };
    for (text, code, needle) in [
        (text("/Base/left", "/Base/right", "2 3 7 6"), 0, "clean"),
        // The right cube's first side is the joint of the two; so is the left one's second.
        (text("/Base/left", "/Base/right", "1 4 8 5"), 1, "inside the volume"),
        (text("/Base/left", "/Base/left", "2 3 7 6"), 1, "inside the volume"),
        (text("/Base/left", "/Base/right", "2 3 7 9"), 1, "ML401"),
        (text("/Base/left", "/Base/middle", "2 3 7 6"), 1, "ML415"),
    ] {
        std::fs::write(&path, &text).unwrap();
        let told = sagitta(args!["validate", path, "--mesh", mesh]).expect(code).stdout;
        assert!(told.contains(needle), "{needle}: {told}");
    }
}

#[test]
fn of_several_mesh_and_cad_files_the_given_ones_are_meant() {
    let ring = Ring::new();
    // Another mesh with other links stands before, another CAD with the same references behind.
    let (several, text) = ring.spoilt(|text| {
        let other = "<MeshFile filename=\"other.cgns\"><MeshModelReference ref=\"/Base/x\"><MeshSheet name=\"x\" gref=\"900\">\
                     <MeshFace etype=\"Tri3\">1 2 3</MeshFace></MeshSheet></MeshModelReference></MeshFile>\n";
        let cad = "<GeometryFile filename=\"other.step\"><GeometryReference gid=\"900\" ref=\"face-1000\"/></GeometryFile>\n";
        text.replacen("  <MeshFile", &format!("{other}  <MeshFile"), 1).replacen("  <GeometryFile", &format!("{cad}  <GeometryFile"), 1)
    });
    assert_eq!(ring.found(&several), [("ML509".to_owned(), line_of(&text, "other.step"))]);
    ring.curve(&several, &[]).expect(0);
    // Neither of them is the given one.
    let renamed = ring.dir.path().join("third.x");
    std::fs::copy(&ring.mesh, &renamed).unwrap();
    let output = ring.dir.path().join("curved.msh");
    let told =
        sagitta(args!["curve", renamed, "--cad", ring.cad, "--linkage", several, "--order", "2", "-q", "-o", output])
            .expect(2);
    assert!(told.stderr.contains("other.cgns, ring.x") && told.stderr.contains("third.x"), "{}", told.stderr);
}

/// Two structured zones whose axes run differently: joined by their connection, as their points are apart by rounding.
#[test]
fn structured_zones_are_hexes_joined_by_their_connections() {
    let mesh = sample("structured_zones.cgns");
    let counts: Vec<usize> = mesh.counts().values().copied().collect();
    assert_eq!((mesh.cells().len(), counts.len()), (2 * 8 * 4 * 2, 2), "quads and hexes: {:?}", mesh.counts());
    assert_eq!(mesh.points().len(), 2 * 9 * 5 * 3 - 5 * 3, "one layer is common");
    let names: Vec<&str> = mesh.zones().iter().map(|zone| zone.name.as_str()).collect();
    assert_eq!(names, ["/Base/first", "/Base/second"]);
    let (volume, areas) = measure(&mesh);
    // Chords instead of arcs: sixteen triangles in the half circle.
    let polygon = 8.0 * (std::f64::consts::PI / 16.0).sin();
    assert!((volume - polygon * (25.0 - 0.25)).abs() < 1e-10, "{volume}");
    let mut by_name: std::collections::BTreeMap<String, f64> = std::collections::BTreeMap::new();
    for (key, area) in areas {
        *by_name.entry(mesh.label(key)).or_default() += area;
    }
    let chord = 32.0 * (std::f64::consts::PI / 32.0).sin();
    let close = |name: &str, wanted: f64| assert!((by_name[name] - wanted).abs() < 1e-10, "{name}: {by_name:?}");
    close("wall", 0.5 * chord);
    close("farfield", 5.0 * chord);
    close("symmetry", 2.0 * 4.5);
    // The ends of the second zone alone: the first has periodic connections there, which are told.
    close("ends", 0.5 * polygon * (25.0 - 0.25));
    let periodic: Vec<&String> = mesh.notes().iter().filter(|note| note.contains("periodic connection")).collect();
    assert_eq!(periodic.len(), 2, "{:?}", mesh.notes());
    assert!(periodic[0].contains("moved by (0, 0, 1)") && periodic[1].contains("moved by (0, 0, -1)"), "{periodic:?}");
    assert!(
        mesh.notes().iter().all(|note| !note.contains("renumbered") && !note.contains("ignored")),
        "{:?}",
        mesh.notes()
    );
    assert!(mesh.conditions().iter().any(|own| own.kind == "BCWallViscous"));
}

/// A plane ring of one zone that is connected to itself.
#[test]
fn a_structured_plane_ring_closes() {
    let mesh = sample("structured_plane.cgns");
    assert_eq!((mesh.cells().len(), mesh.sides().len(), mesh.points().len()), (16 * 4, 32, 16 * 5));
    let skin = sagitta::mesh::Skin::of(&mesh);
    assert!(skin.unmarked.is_empty() && skin.strays.is_empty());
    let area: f64 = measure(&mesh).1.values().sum();
    assert!((area - 8.0 * (std::f64::consts::PI / 8.0).sin() * (25.0 - 0.25)).abs() < 1e-12, "{area}");
}

/// Sizes, ranges and transforms that are none.
#[test]
fn damaged_structured_zones_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let spoilt = |name: &str, node: &str, values: &[i32]| {
        let path = dir.path().join(name);
        std::fs::copy(root().join("fixtures/samples/structured_zones.cgns"), &path).unwrap();
        let file = hdf5_metno::File::open_rw(&path).unwrap();
        file.dataset(&format!("Base/first/{node}")).unwrap().write_raw(values).unwrap();
        drop(file);
        sagitta::formats::read(&path).map_err(|error| error.to_string())
    };
    let told = spoilt("size.cgns", " data", &[9, 5, 3, 8, 4, 1, 0, 0, 0]).unwrap_err();
    assert!(told.contains("/Base/first: 3 points and 1 cells along axis 3"), "{told}");
    let told = spoilt("more.cgns", " data", &[9, 5, 400_000, 8, 4, 399_999, 0, 0, 0]).unwrap_err();
    assert!(told.contains("the coordinate has 135 values where 18000000 are needed"), "{told}");
    let joint = "ZoneGridConnectivity/joint";
    let told = spoilt("axes.cgns", &format!("{joint}/Transform/ data"), &[1, 1, 3]).unwrap_err();
    assert!(told.contains("joint: [1, 1, 3] does not map the axes"), "{told}");
    let told = spoilt("way.cgns", &format!("{joint}/Transform/ data"), &[2, 3, 1]).unwrap_err();
    assert!(told.contains("PointRangeDonor is no range of the zone's indices"), "{told}");
    let told = spoilt("far.cgns", &format!("{joint}/PointRange/ data"), &[99, 1, 1, 99, 5, 3]).unwrap_err();
    assert!(told.contains("PointRange is no range"), "{told}");
    let told = spoilt("apart.cgns", &format!("{joint}/PointRange/ data"), &[1, 1, 1, 1, 5, 3]).unwrap_err();
    assert!(told.contains("apart"), "{told}");
    let mesh = spoilt("condition.cgns", "ZoneBC/wall/PointRange/ data", &[1, 1, 1, 9, 2, 3]).unwrap();
    assert!(mesh.notes().iter().any(|note| note.contains("wall: its PointRange is no part of one layer")));
}
