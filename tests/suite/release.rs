//! Elements that no curving makes valid while the wall follows the CAD: the walls beside them leave it, and no others.

use crate::common::{fixture, json, number, sagitta};
use glam::DVec3;
use sagitta::element::{Cell, Order};
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
                    if let Some(c) = other.iter().find(|n| **n != b && **n != d) {
                        if other.contains(&b) && other.contains(&d) {
                            return ([i, j], [a, b, *c, d]);
                        }
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

#[test]
fn only_the_faces_of_the_impossible_element_leave_the_cad() {
    let folder = tempfile::tempdir().unwrap();
    let linear = folder.path().join("linear.msh");
    let mesh = with_a_cornered_tet();
    assert_eq!(mesh.order(), Order::LINEAR);
    formats::write(&linear, &mesh, &WriteOptions::default()).unwrap();
    for order in ["2", "3"] {
        let [out, report] = ["curved.msh", "report.json"].map(|name| folder.path().join(name));
        let options = args!["curve", linear, "--cad", fixture("sphere_shell", "step"), "-q", "--order", order];
        let told = sagitta(options.iter().chain(&args!["-o", out, "--report", report])).expect(3).stdout;
        let report = json(&report);
        let off = report["off_cad"].as_array().unwrap();
        println!("P{order}: {told}");
        assert_eq!(off.len(), 2, "P{order}: {told}");
        assert!(off.iter().all(|face| face["released"] == true), "P{order}: {told}");
        let bulge = 0.06; // of the edges of the straight wall
        assert!(off.iter().all(|face| face["cad_distance"].as_f64().unwrap() < bulge), "P{order}: {told}");
        for cost in ["c_wcn", "c_jac"] {
            assert!(number(&report, &format!("/smoothing/end/{cost}")) >= 0.1, "P{order}: {told}");
        }
        sagitta(args!["check", out].iter()).expect(0);
    }
}
