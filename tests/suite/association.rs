//! Which boundary faces lie on which CAD faces, where no single source knows it of all.

use std::path::{Path, PathBuf};

use crate::common::{fixture, json, sagitta};
use glam::DVec3;
use sagitta::element::Cell;
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{Block, EntityKey, Mesh, NodeId, Parts};

/// A fixture's mesh, changed and written to `folder`.
fn changed(case: &str, folder: &Path, change: impl FnOnce(&mut Parts)) -> PathBuf {
    let mut parts = formats::read(&fixture(case, "msh")).unwrap().into_parts();
    change(&mut parts);
    let path = folder.join("mesh.msh");
    formats::write(&path, &Mesh::new(parts).unwrap(), &WriteOptions::default()).unwrap();
    path
}

/// Gives surfaces other numbers.
fn renumber(parts: &mut Parts, new: impl Fn(i32) -> i32) {
    let surface = |key: &mut EntityKey| {
        if key.dimension == 2 {
            key.tag = new(key.tag);
        }
    };
    parts.blocks.iter_mut().for_each(|block| surface(&mut block.entity));
    parts.node_entities.iter_mut().flatten().for_each(surface);
    for entity in &mut parts.entities {
        surface(&mut entity.key);
        if entity.key.dimension == 3 {
            entity.boundary.iter_mut().for_each(|tag| *tag = new(tag.abs()));
        }
    }
}

/// What `sagitta link` says of a mesh: faces and undecided faces of all patches together, those off the CAD, and the source.
fn linked(mesh: &Path, cad: &Path, folder: &Path) -> (u64, u64, u64, String) {
    let [out, report] = ["link.xml", "link.json"].map(|name| folder.join(name));
    sagitta(args!["link", mesh, "--cad", cad, "-o", out, "--report", report]).expect(0);
    let report = json(&report);
    let sum = |key: &str| report["patches"].as_array().unwrap().iter().map(|patch| patch[key].as_u64().unwrap()).sum();
    (sum("faces"), sum("undecided"), sum("off_cad"), report["source"].as_str().unwrap().to_owned())
}

fn curved(mesh: &Path, cad: &Path, out: &Path) -> Mesh {
    sagitta(args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", out]).expect(0);
    formats::read(out).unwrap()
}

/// One patch has a number that the CAD lacks; what its tag leaves open geometry decides, and the mesh is as if the tag were right.
#[test]
fn a_number_that_the_cad_lacks_is_made_good_by_geometry() {
    let folder = tempfile::tempdir().unwrap();
    let cad = fixture("weeble", "step");
    let mesh = changed("weeble", folder.path(), |parts| renumber(parts, |tag| if tag == 3 { 30 } else { tag }));
    let (faces, undecided, off, source) = linked(&mesh, &cad, folder.path());
    assert_eq!((faces, undecided, off, &source[..]), (674, 0, 0, "geometry and the mesh's entity tags"));
    let curved = curved(&mesh, &cad, &folder.path().join("out.msh"));
    let linear = formats::read(&mesh).unwrap();
    let waist = curved.side_blocks().find(|block| block.entity.tag == 30).unwrap();
    let moved = |n: &NodeId| n.index() >= linear.points().len();
    assert!(waist.nodes.iter().any(moved), "the patch has new nodes");
}

/// Coordinates that are farther from the CAD than a tenth of the first cell is high, as those of files in single precision are.
#[test]
fn coordinates_less_exact_than_the_first_cell_are_associated_within_a_wider_tolerance() {
    let folder = tempfile::tempdir().unwrap();
    let cad = fixture("weeble", "step");
    let mut random = crate::common::random::Random(crate::common::random::seed(7));
    let mesh = changed("weeble", folder.path(), |parts| {
        renumber(parts, |tag| tag + 100);
        let noise = 3e-5; // the first cell is 1e-4 high
        for x in &mut parts.points {
            *x += DVec3::from_array([0; 3].map(|_| random.between(-noise, noise)));
        }
    });
    let (faces, undecided, off, source) = linked(&mesh, &cad, folder.path());
    assert_eq!((faces, undecided, off, &source[..]), (674, 0, 0, "geometry"));
}

/// A mesh over a part of a CAD face is not of another size.
#[test]
fn a_mesh_may_cover_a_part_of_its_cad() {
    let folder = tempfile::tempdir().unwrap();
    let whole = formats::read(&fixture("plate", "msh")).unwrap();
    let corners = whole.points().iter().copied();
    let (low, high) = corners.fold((DVec3::MAX, DVec3::MIN), |(low, high), x| (low.min(x), high.max(x)));
    // A hex on the plate's low corner, a tenth of its size.
    let points: Vec<DVec3> =
        Cell::Hex.corners().iter().map(|c| low + 0.1 * (high - low) * DVec3::from(c.map(f64::from))).collect();
    let node = |n: u8| NodeId::new(usize::from(n)).unwrap();
    let mut blocks: Vec<Block> = Cell::Hex
        .faces()
        .iter()
        .zip(100..)
        .map(|(face, tag)| Block {
            cell: face.cell,
            entity: EntityKey::new(2, tag),
            physical_tags: vec![],
            tags: vec![tag as u64],
            nodes: face.corners.iter().map(|&c| node(c)).collect(),
        })
        .collect();
    let nodes = (0..8).map(node).collect();
    blocks.push(Block { cell: Cell::Hex, entity: EntityKey::new(3, 1), physical_tags: vec![], tags: vec![1], nodes });
    let parts =
        Parts { points, node_tags: (1..=8).collect(), node_entities: vec![None; 8], blocks, ..Parts::default() };
    let mesh = folder.path().join("part.msh");
    formats::write(&mesh, &Mesh::new(parts).unwrap(), &WriteOptions::default()).unwrap();
    let (faces, undecided, off, _) = linked(&mesh, &fixture("plate", "step"), folder.path());
    assert_eq!((faces, undecided + off), (6, 3), "three faces lie on the plate, three inside it");
    curved(&mesh, &fixture("plate", "step"), &folder.path().join("out.msh"));
}

/// What a linkage file leaves out geometry makes good: the mesh is as with the whole file.
#[test]
fn what_a_linkage_file_leaves_out_is_made_good_by_geometry() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(fixture("weeble", "meshlink.xml")).unwrap();
    let from = text.find("<MeshSheet name=").unwrap();
    let end = "</MeshSheet>";
    let to = from + text[from..].find(end).unwrap() + end.len();
    let [part, out, whole] = ["part.xml", "out.vtu", "whole.vtu"].map(|name| folder.path().join(name));
    std::fs::write(&part, format!("{}{}", &text[..from], &text[to..])).unwrap();
    let [mesh, cad] = ["msh", "step"].map(|extension| fixture("weeble", extension));
    let options = args!["curve", mesh, "--cad", cad, "-q", "--order", "2"];
    let told = sagitta(options.iter().chain(&args!["--linkage", part, "-o", out])).expect(0).stdout;
    assert!(told.contains("boundary faces that lie on the CAD; geometry says where"), "{told}");
    let full = fixture("weeble", "meshlink.xml");
    sagitta(options.iter().chain(&args!["--linkage", full, "-o", whole])).expect(0);
    assert!(std::fs::read(&out).unwrap() == std::fs::read(&whole).unwrap(), "not the same mesh");
}

/// One surface for the whole boundary, with a number that a CAD face has: geometry decides, face by face, as it does without tags.
#[test]
fn one_surface_for_all_is_taken_apart_by_geometry() {
    let folder = tempfile::tempdir().unwrap();
    let cad = fixture("weeble", "step");
    let mesh = changed("weeble", folder.path(), |parts| {
        renumber(parts, |_| 1);
        parts.entities.clear();
    });
    let [by_tags, by_geometry] = ["out.vtu", "geometry.vtu"].map(|name| folder.path().join(name));
    let one = curved(&mesh, &cad, &by_tags);
    let options = args!["curve", fixture("weeble", "msh"), "--cad", cad, "--order", "2", "-q", "--ignore-tags"];
    let told = sagitta(options.iter().chain(&args!["-o", by_geometry])).expect(0).stdout;
    assert!(told.contains("associated by geometry, with 0 faces and 0 edges undecided"), "{told}");
    let own = formats::read(&by_geometry).unwrap();
    let apart = one.points().iter().zip(own.points()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart < 1e-12, "{apart}");
}

/// A wall that is off its CAD by more than any default tolerance is no straight wall in silence: exit code 3, with the distance and the
/// tolerance that takes it; which then curves it.
#[test]
fn a_wall_beside_its_cad_is_told_with_its_distance() {
    let folder = tempfile::tempdir().unwrap();
    let cad = fixture("sphere_shell", "step");
    let mut off = 0.0;
    let mesh = changed("sphere_shell", folder.path(), |parts| {
        renumber(parts, |tag| tag + 100);
        let on_sphere = |x: &DVec3| x.length() < 1.0 + 1e-9;
        let wall: Vec<usize> = (0..parts.points.len()).filter(|&n| on_sphere(&parts.points[n])).collect();
        off = 4e-4; // the mesh is 3.5 across, the first cell 1e-3 high
        wall.into_iter().for_each(|n| parts.points[n] *= 1.0 + off);
    });
    let [out, report, picture] = ["out.msh", "report.json", "open.msh"].map(|name| folder.path().join(name));
    let options = args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", out, "--report", report];
    let told = sagitta(options.iter().chain(&args!["--open-faces", picture])).expect(3).stdout;
    let open = json(&report)["open_faces"].as_array().unwrap().clone();
    assert!(
        !open.is_empty() && open.iter().all(|face| face["cause"].as_str().unwrap().contains("beyond the tolerance"))
    );
    let far = open.iter().map(|face| face["cad_distance"].as_f64().unwrap()).fold(0.0, f64::max);
    assert!((far / off - 1.0).abs() < 0.01, "{far}");
    assert!(told.contains("remedy: --tolerance 8.0e-4"), "{told}");
    // They can be looked at: the mesh of them has them all, each in the group of its cause.
    let drawn = formats::read(&picture).unwrap();
    let groups: Vec<&str> = drawn.physical_names().iter().map(|name| name.name.as_str()).collect();
    assert_eq!((drawn.counts().values().sum::<usize>(), groups), (open.len(), vec!["beside the CAD"]));
    assert!(drawn.points().iter().all(|x| (x.length() - 1.0 - off).abs() < 1e-9));
    let shown = folder.path().join("open.vtu");
    sagitta(args!["curve", mesh, "--cad", cad, "--order", "2", "--dry-run", "--open-faces", shown]).expect(0);
    let array = b"\"cad_distance\"";
    assert!(std::fs::read(&shown).unwrap().windows(array.len()).any(|bytes| bytes == array));
    let told = sagitta(options.iter().chain(&args!["--tolerance", "8.0e-4"])).expect(0).stdout;
    assert!(told.contains("with 0 faces and 0 edges undecided"), "{told}");
}

/// The outer boundary of a mesh so thin that it lies within the wider tolerance of the wall's CAD is not the wall.
#[test]
fn the_outer_boundary_of_a_thin_mesh_is_not_its_wall() {
    let folder = tempfile::tempdir().unwrap();
    let cad = fixture("sphere_shell", "step");
    let height = 1e-4;
    let mesh = changed("sphere_shell", folder.path(), |parts| {
        renumber(parts, |tag| tag + 100);
        // The shell from radius 1 to 2 pressed to its height, and its wall off the sphere by a quarter of the first cell.
        let first = 1e-3 * height;
        for x in &mut parts.points {
            let radius = x.length();
            let noise = if radius < 1.0 + 1e-9 { 0.25 * first } else { 0.0 };
            *x *= (1.0 + height * (radius - 1.0) + noise) / radius;
        }
    });
    let report = folder.path().join("report.json");
    let options = args!["curve", mesh, "--cad", cad, "--order", "2", "--dry-run", "--report", report];
    let told = sagitta(options.iter()).expect(0).stdout;
    let report = json(&report);
    let on_sphere = |patch: &&serde_json::Value| patch["cad_faces"].as_object().unwrap().len() == 1;
    let patches = report["patches"].as_array().unwrap();
    let off: Vec<_> = patches.iter().filter(|patch| patch["off_cad"] == patch["faces"]).collect();
    assert_eq!((off.len(), patches.iter().filter(on_sphere).count()), (1, 4), "only the outer sphere is off: {told}");
}

/// Where faces have the CAD's numbers and edges and corners have no elements, geometry says on which CAD edges and vertices these lie.
#[test]
fn linkage_by_tags_has_edges_and_points() {
    let folder = tempfile::tempdir().unwrap();
    let bare = changed("weeble", folder.path(), |parts| parts.blocks.retain(|block| block.cell.dimension() >= 2));
    let counts = |more: &[&str], source: &str| {
        let [out, report] = ["link.xml", "link.json"].map(|name| folder.path().join(name));
        let options = args!["link", bare, "--cad", fixture("weeble", "step"), "-o", out, "--report", report];
        sagitta(options.into_iter().chain(more.iter().map(Into::into))).expect(0);
        let report = json(&report);
        assert_eq!(report["source"], source);
        ["edges", "points"].map(|key| report[key].as_u64().unwrap())
    };
    let by_tags = counts(&[], "the mesh's entity tags");
    assert_eq!((by_tags, by_tags), ([32, 2], counts(&["--ignore-tags"], "geometry")));
}
