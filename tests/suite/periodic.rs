//! Periodic patches come out congruent, whether the mesh file or the linkage file tells of them.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use crate::common::{json, number, root, sagitta};
use cad::Aabb;
use glam::{DMat4, DVec3};
use sagitta::formats;
use sagitta::mesh::{Mesh, NodeId};

/// Share of the box within which partners are images of one another.
const CONGRUENT: f64 = 1e-12;

fn file(name: &str) -> PathBuf {
    root().join("fixtures/periodic").join(name)
}

fn curve(case: &str, order: u8, more: &[OsString], output: &Path) {
    let (mesh, cad) = (file(&format!("{case}.msh")), file(&format!("{case}.step")));
    let arguments = args!["curve", mesh, "--cad", cad, "--order", order.to_string(), "-q", "-o", output];
    sagitta(arguments.into_iter().chain(more.iter().cloned())).expect(0);
}

/// Nodes of the surfaces with a physical name.
fn nodes_of(mesh: &Mesh, name: &str) -> BTreeSet<NodeId> {
    let blocks = mesh.side_blocks().filter(|block| mesh.names_of(block.entity).contains(&name.to_owned()));
    blocks.flat_map(|block| block.nodes.iter().copied()).collect()
}

/// The farthest of any node of `right` from the nearest image of a node of `left`, share of the box.
fn apart(mesh: &Mesh, map: impl Fn(DVec3) -> DVec3) -> f64 {
    let size = Aabb::of_points(mesh.points().iter().copied()).diagonal();
    let images: Vec<DVec3> = nodes_of(mesh, "left").iter().map(|n| map(mesh.points()[n.index()])).collect();
    let right = nodes_of(mesh, "right");
    assert_eq!(images.len(), right.len());
    let nearest =
        |n: &NodeId| images.iter().map(|x| x.distance(mesh.points()[n.index()])).fold(f64::INFINITY, f64::min);
    right.iter().map(nearest).fold(0.0, f64::max) / size
}

/// The pairs of the file are images of one another, and all nodes of the patch `right` are in them.
fn assert_pairs(mesh: &Mesh) {
    let size = Aabb::of_points(mesh.points().iter().copied()).diagonal();
    let surfaces: Vec<_> = mesh.periodic().iter().filter(|pair| pair.slave.dimension == 2).collect();
    assert_eq!(surfaces.len(), 1);
    for pair in mesh.periodic() {
        let map = DMat4::from_cols_slice(&pair.affine).transpose();
        for &(slave, master) in &pair.pairs {
            let image = map.transform_point3(mesh.points()[master.index()]);
            assert!(image.distance(mesh.points()[slave.index()]) <= CONGRUENT * size, "{slave:?} {master:?}");
        }
    }
    let slaves: BTreeSet<NodeId> = surfaces[0].pairs.iter().map(|(slave, _)| *slave).collect();
    assert_eq!(slaves, nodes_of(mesh, "right"));
}

fn turned(x: DVec3) -> DVec3 {
    let (s, c) = (std::f64::consts::PI / 3.0).sin_cos();
    DVec3::new(c * x.x - s * x.y, s * x.x + c * x.y, x.z)
}

#[test]
fn plane_sides_of_a_sector_by_the_mesh_file() {
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out.msh");
    for (order, more) in [(2, vec![]), (3, vec![]), (4, vec![]), (3, args!["--msh-version", "2.2"].to_vec())] {
        curve("sector", order, &more, &output);
        let mesh = formats::read(&output).unwrap();
        let apart = apart(&mesh, turned);
        assert!(apart <= CONGRUENT, "P{order}: {apart:e}");
        assert_pairs(&mesh);
    }
    // The sides' curved edges really are curved, and nodes inside the sides follow them.
    let linear = formats::read(&file("sector.msh")).unwrap();
    let largest = largest_bend(dir.path(), "sector");
    assert!(largest > 1e-3, "the wall stays straight: {largest}");
    assert!(apart(&linear, turned) < 1e-6);
}

/// With the nodes of both sides held, C_JAC ended at 0.52 and 0.58.
#[test]
fn the_elements_at_the_sides_are_smoothed() {
    let dir = tempfile::tempdir().unwrap();
    let [output, report] = ["out.msh", "report.json"].map(|name| dir.path().join(name));
    for order in [2, 3] {
        curve("sector", order, &args!["--report", report], &output);
        let c_jac = number(&json(&report), "/smoothing/end/c_jac");
        assert!(c_jac >= 0.75, "P{order}: {c_jac}");
    }
}

/// How far the wall's curved faces bend away from the linear ones: the largest distance from a P2 edge node to its chord's middle.
fn largest_bend(dir: &Path, case: &str) -> f64 {
    let output = dir.join("p2.msh");
    curve(case, 2, &[], &output);
    let mesh = formats::read(&output).unwrap();
    let mut largest = 0.0_f64;
    for block in mesh.side_blocks().filter(|block| mesh.names_of(block.entity).contains(&"left".to_owned())) {
        for nodes in block.elements(mesh.order()) {
            let at = |n: usize| mesh.points()[nodes[n].index()];
            for (node, &[a, b]) in (block.cell.corner_count()..).zip(block.cell.edges()) {
                largest = largest.max(at(node).distance(0.5 * (at(usize::from(a)) + at(usize::from(b)))));
            }
        }
    }
    largest
}

#[test]
fn wavy_sides_of_a_block_by_the_linkage_file() {
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("out.msh");
    let report = dir.path().join("report.json");
    let linkage = file("wave.meshlink.xml");
    for order in [2, 3, 4] {
        curve("wave", order, &args!["--linkage", linkage, "--report", report], &output);
        let mesh = formats::read(&output).unwrap();
        let apart = apart(&mesh, |x| x + DVec3::X * 2.0);
        assert!(apart <= CONGRUENT, "P{order}: {apart:e}");
        assert_pairs(&mesh);
    }
    // Both sides lie on their own CAD face.
    let report = json(&report);
    for patch in report["patches"].as_array().unwrap() {
        let farthest = patch["cad_distance_max"].as_f64().unwrap();
        assert!(farthest < 1e-2, "{patch:#}");
    }
    // Without the linkage file nothing tells that the sides are a pair.
    curve("wave", 3, &[], &output);
    assert!(formats::read(&output).unwrap().periodic().is_empty());
}

/// `$Periodic` of a mesh file goes over into the linkage file, from which it works as well.
#[test]
fn pairs_of_the_mesh_file_survive_in_the_linkage_file() {
    let dir = tempfile::tempdir().unwrap();
    let [linkage, bare, output] = ["sector.xml", "sector.msh", "out.msh"].map(|name| dir.path().join(name));
    let (mesh, cad) = (file("sector.msh"), file("sector.step"));
    for more in [&[][..], &args!["--ignore-tags"]] {
        let arguments = args!["link", mesh, "--cad", cad, "-o", linkage];
        sagitta(arguments.into_iter().chain(more.iter().cloned())).expect(0);
        let text = std::fs::read_to_string(&linkage).unwrap();
        assert_eq!(text.matches("<MeshElementLinkage").count(), 1, "{text}");
        sagitta(args!["validate", linkage, "--mesh", mesh, "--cad", cad, "--strict"]).expect(0);
        let mut parts = formats::read(&mesh).unwrap().into_parts();
        assert!(!parts.periodic.is_empty());
        parts.periodic.clear();
        let unpaired = Mesh::new(parts).unwrap();
        formats::write(&bare, &unpaired, &formats::WriteOptions::default()).unwrap();
        let curve = |more: &[OsString]| {
            let arguments = args!["curve", bare, "--cad", cad, "--order", "3", "-q", "-o", output];
            sagitta(arguments.into_iter().chain(more.iter().cloned())).expect(0);
            formats::read(&output).unwrap()
        };
        assert!(curve(&[]).periodic().is_empty());
        let curved = curve(&args!["--linkage", linkage]);
        assert_pairs(&curved);
        let apart = apart(&curved, turned);
        assert!(apart <= CONGRUENT, "{apart:e}");
    }
}

#[test]
fn a_pair_that_is_none_is_refused_and_found() {
    let dir = tempfile::tempdir().unwrap();
    let linkage = dir.path().join("wave.xml");
    let good = std::fs::read_to_string(file("wave.meshlink.xml")).unwrap();
    let text = good.replacen("2.0 0 0 1", "2.1 0 0 1", 1);
    assert_ne!(text, good);
    std::fs::write(&linkage, &text).unwrap();
    let (mesh, cad, output) = (file("wave.msh"), file("wave.step"), dir.path().join("out.msh"));
    let refused = sagitta(args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", output, "--linkage", linkage]);
    assert_eq!(refused.code, Some(2), "{}", refused.stdout);
    let line = 1 + text[..text.find("<MeshElementLinkage").unwrap()].matches('\n').count();
    for word in [format!("wave.xml:{line}:"), "do not correspond".into()] {
        assert!(refused.stderr.contains(&word), "{word}: {}", refused.stderr);
    }
    let found = sagitta(args!["validate", linkage, "--mesh", mesh, "--cad", cad]).expect(1).stdout;
    assert!(
        found.contains(&format!("wave.xml:{line}:1: error ML413: ")) && found.contains("1 errors, 0 warnings"),
        "{found}"
    );
    let clean = sagitta(args!["validate", file("wave.meshlink.xml"), "--mesh", mesh, "--cad", cad, "--strict"]);
    assert_eq!(clean.code, Some(0), "{}", clean.stdout);
}
