//! Elements that no curving makes good while the wall follows the CAD: the walls beside them leave it, and no others.

use crate::common::{fixture, json, number, sagitta};
use glam::DVec3;
use sagitta::element::Cell;
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{Block, EntityKey, Mesh, NodeId};

/// The shell around a sphere with a tet on two of the wall's triangles, which are turned about their common edge: both its other faces
/// lie on the wall, which is smooth there, so that three of its edges at one corner are tangent to it.
fn with_a_cornered_tet() -> Mesh {
    let mut parts = formats::read(&fixture("sphere_shell", "msh")).unwrap().into_parts();
    let radius = |nodes: &[NodeId]| nodes.iter().map(|n| parts.points[n.index()].length()).fold(0.0, f64::max);
    let on_sphere = |block: &Block| block.cell == Cell::Triangle && radius(&block.nodes) < 1.0 + 1e-9;
    let wall = parts.blocks.iter().position(on_sphere).unwrap();
    let faces: Vec<[NodeId; 3]> = parts.blocks[wall].nodes.chunks(3).map(|face| [face[0], face[1], face[2]]).collect();
    let rims: Vec<NodeId> =
        parts.blocks.iter().filter(|b| b.cell == Cell::Line).flat_map(|b| b.nodes.iter().copied()).collect();
    let inside = |face: &[NodeId; 3]| face.iter().all(|n| !rims.contains(n));
    // Two triangles (b, d, a) and (d, b, c) inside the wall.
    let find = || {
        for (i, one) in faces.iter().enumerate().filter(|(_, face)| inside(face)) {
            for (j, other) in faces.iter().enumerate().filter(|(j, face)| *j > i && inside(face)) {
                for turn in 0..3 {
                    let [b, d, a] = [one[turn], one[(turn + 1) % 3], one[(turn + 2) % 3]];
                    let apex = other.iter().find(|n| **n != b && **n != d);
                    if let Some(c) = apex.filter(|_| other.contains(&b) && other.contains(&d)) {
                        return ([i, j], [a, b, *c, d]);
                    }
                }
            }
        }
        panic!("no two triangles inside the wall");
    };
    let ([i, j], [a, b, c, d]) = find();
    let x = |n: NodeId| parts.points[n.index()];
    let sixfold = |[p, q, r, s]: [NodeId; 4]| (x(q) - x(p)).cross(x(r) - x(p)).dot(x(s) - x(p));
    let mut tet = [a, b, c, d];
    if sixfold(tet) < 0.0 {
        tet.swap(2, 3);
    }
    // The faces keep their side: towards where they faced before.
    let before = (x(d) - x(b)).cross(x(a) - x(b));
    let facing = |[p, q, r]: [NodeId; 3]| {
        let normal: DVec3 = (x(q) - x(p)).cross(x(r) - x(p));
        if normal.dot(before) > 0.0 { [p, q, r] } else { [p, r, q] }
    };
    let turned = [facing([a, b, c]), facing([a, c, d])];
    for (face, nodes) in [i, j].into_iter().zip(turned) {
        parts.blocks[wall].nodes[3 * face..][..3].copy_from_slice(&nodes);
    }
    let entity =
        parts.blocks.iter().find(|block| block.cell.dimension() == 3).map_or(EntityKey::new(3, 1), |b| b.entity);
    let tag = parts.blocks.iter().flat_map(|block| block.tags.iter().copied()).max().unwrap() + 1;
    parts.blocks.push(Block { tags: vec![tag], nodes: tet.to_vec(), ..Block::new(Cell::Tet, entity) });
    Mesh::new(parts).unwrap()
}

/// At a floor that sliding reaches nothing leaves the CAD; above it the tet's two faces do, and at most the four around them.
#[test]
fn only_faces_at_the_cornered_element_leave_the_cad() {
    let folder = tempfile::tempdir().unwrap();
    let linear = folder.path().join("linear.msh");
    formats::write(&linear, &with_a_cornered_tet(), &WriteOptions::default()).unwrap();
    let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
    for (order, floor, code, faces) in [("2", "0.1", 0, 0..=0), ("2", "0.3", 3, 2..=6), ("3", "0.3", 3, 2..=6)] {
        let options = args!["curve", linear, "--cad", fixture("sphere_shell", "step"), "-q", "--order", order];
        let more = args!["--floor", floor, "-o", out, "--report", report];
        let told = sagitta(options.iter().chain(&more)).expect(code).stdout;
        let report = json(&report);
        let off = report["off_cad"].as_array().unwrap();
        println!("P{order}: {told}");
        assert!(faces.contains(&off.len()), "P{order}: {told}");
        assert!(off.iter().all(|face| face["released"] == true), "P{order}: {told}");
        let bulge = 0.06; // of the edges of the straight wall
        assert!(off.iter().all(|face| face["cad_distance"].as_f64().unwrap() < bulge), "P{order}: {told}");
        let least = number(&report, "/smoothing/end/c_jac").min(number(&report, "/smoothing/end/c_wcn"));
        assert!(least >= floor.parse().unwrap(), "P{order}: {told}");
        sagitta(args!["check", out].iter()).expect(0);
        std::fs::remove_file(&out).unwrap();
        let required = sagitta(options.iter().chain(&more).chain(&args!["--require-all"]));
        required.expect(if code == 0 { 0 } else { 4 });
        assert_eq!(out.exists(), code == 0, "P{order}");
    }
}

/// The dry run names the tet before anything is curved: three of its edges lie on the wall where they meet, and there is no other such place.
#[test]
fn the_dry_run_names_the_cornered_element() {
    let folder = tempfile::tempdir().unwrap();
    let [linear, report, own] = ["linear.msh", "report.json", "check.json"].map(|name| folder.path().join(name));
    let mesh = with_a_cornered_tet();
    let tet = mesh.elements_of(Cell::Tet).iter().map(|own| own.tag).max().unwrap();
    formats::write(&linear, &mesh, &WriteOptions::default()).unwrap();
    let options = args!["curve", linear, "--cad", fixture("sphere_shell", "step"), "--order", "2", "--dry-run"];
    let told = sagitta(options.iter().chain(&args!["--report", report])).expect(0).stdout;
    let report = json(&report);
    let spots = report["spots"].as_array().unwrap();
    let named = |spot: &serde_json::Value| spot["kind"] == "element corner" && spot["element"] == format!("tet {tet}");
    assert!(!spots.is_empty() && spots.iter().all(named), "{told}");
    assert!(spots.iter().all(|spot| spot["q"].as_f64().unwrap() < 0.3), "{told}");
    assert!(told.contains("little room"), "{told}");
    // `check` says the same of the same mesh, beside its certificate.
    let checked = args!["check", linear, "--cad", fixture("sphere_shell", "step"), "--report", own];
    let told = sagitta(checked).expect(0).stdout;
    assert!(told.contains("little room") && json(&own)["association"]["spots"] == report["spots"], "{told}");
    // The mesh without it has room everywhere.
    let whole =
        args!["curve", fixture("sphere_shell", "msh"), "--cad", fixture("sphere_shell", "step"), "--order", "4"];
    let told = sagitta(whole.iter().chain(&args!["--dry-run"])).expect(0).stdout;
    assert!(!told.contains("little room"), "{told}");
}
