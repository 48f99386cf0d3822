//! A mesh that no smoothing saved comes out valid, with the list of what was given up.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use cad::{FaceId, Group, Model, ReadOptions};
use glam::DVec3;
use sagitta::associate::{Association, Classification, Surface};
use sagitta::certify::{self, Settings};
use sagitta::curve::periodic::PeriodicConstraint;
use sagitta::curve::proof::Proof;
use sagitta::curve::recover::backtrack::{Fallback, given_up, retreat};
use sagitta::element::{Cell, Order, lattice};
use sagitta::formats;
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{Block, Boundary, EntityKey, Mesh, NodeId};

/// A face of a fixture's CAD, by its index.
fn surface(case: &str, face: usize) -> Surface {
    let reading = ReadOptions { reader: env!("CARGO_BIN_EXE_sagitta").into(), ..ReadOptions::default() };
    let model = Model::read(Path::new(&format!("fixtures/{case}/{case}.step")), &reading).unwrap();
    let group = Group::of_faces(&model, &[FaceId::new(face)]).unwrap();
    Surface { group, label: format!("face {face}"), plane: None }
}

#[test]
fn displacements_are_taken_back_until_every_element_is_valid() {
    let linear = formats::read(Path::new("fixtures/sphere_shell/sphere_shell.msh")).unwrap();
    let boundary = Boundary::new(&linear);
    let association =
        Association { faces: vec![Classification::Surface(0); boundary.faces.len()], ..Association::default() };
    let elevated = elevate(&linear, Order::new(3).unwrap()).unwrap();
    let (straight, linear_nodes) = (elevated.mesh.points.clone(), elevated.linear_nodes);
    let mut mesh = elevated.mesh;
    // A wall node pushed through several layers, and another just a little.
    let wall_node = mesh.blocks_of(2).find_map(|(_, b)| b.nodes.iter().find(|n| n.index() >= linear_nodes));
    let wall_node = *wall_node.unwrap();
    mesh.points[wall_node.index()] += DVec3::splat(0.2);
    mesh.points[linear_nodes] += DVec3::splat(1e-6);

    let first = Proof::of(&mesh, &straight[..linear_nodes], &boundary, &association);
    assert!(!first.certificate.holds(), "the case must be broken to begin with");
    let fallback = Fallback { order: Order::LINEAR, places: straight.clone() };
    let (shares, proof) = retreat(
        &mut mesh,
        &fallback,
        &straight[..linear_nodes],
        &boundary,
        &association,
        &PeriodicConstraint::default(),
        first,
    );

    let given_up = given_up(&mesh, &boundary, &association, &shares, Order::LINEAR);
    assert!(proof.holds());
    assert!(
        certify::mesh(&mesh, &mesh.points, None, &Settings::default()).holds(),
        "the mesh that is handed back is the valid one"
    );
    assert!(!given_up.is_empty() && given_up.iter().all(|g| g.share < 1.0));
    assert!(given_up.len() < boundary.faces.len() / 2, "{} faces given up for one node", given_up.len());
    let moved = mesh.points[wall_node.index()].distance(straight[wall_node.index()]);
    assert!(moved < 0.2 * 3.0_f64.sqrt(), "taken back: {moved}");
}

#[test]
fn a_valid_mesh_is_left_alone() {
    let linear = formats::read(Path::new("fixtures/cylinder_bl/cylinder_bl.msh")).unwrap();
    let elevated = elevate(&linear, Order::new(2).unwrap()).unwrap();
    let straight = elevated.mesh.points.clone();
    let mut mesh = elevated.mesh;
    let boundary = Boundary::new(&linear);
    let association =
        Association { faces: vec![Classification::Surface(0); boundary.faces.len()], ..Association::default() };
    let proof = Proof::of(&mesh, &straight[..elevated.linear_nodes], &boundary, &association);
    let (shares, _) = retreat(
        &mut mesh,
        &Fallback { order: Order::LINEAR, places: straight.clone() },
        &straight[..elevated.linear_nodes],
        &boundary,
        &association,
        &PeriodicConstraint::default(),
        proof,
    );
    assert!(shares.iter().all(|&share| share == 1.0) && mesh.points == straight);
}

#[test]
fn both_sides_of_a_periodic_pair_retreat_alike() {
    let linear = formats::read(Path::new("fixtures/periodic/sector.msh")).unwrap();
    let boundary = Boundary::new(&linear);
    let association =
        Association { faces: vec![Classification::Surface(0); boundary.faces.len()], ..Association::default() };
    let mut elevated = elevate(&linear, Order::new(2).unwrap()).unwrap();
    let (periodic, notes) = PeriodicConstraint::new(&mut elevated, &boundary, false);
    assert!(notes.is_empty(), "{notes:?}");
    periodic.apply(&mut elevated.mesh.points);
    let (straight, linear_nodes) = (elevated.mesh.points.clone(), elevated.linear_nodes);
    let mut mesh = elevated.mesh;
    // A new node of the side that leads, pushed far into the volume, and its image with it.
    let &(_, master) = mesh.periodic.iter().flat_map(|p| &p.pairs).find(|(_, m)| m.index() >= linear_nodes).unwrap();
    mesh.points[master.index()] += DVec3::splat(0.4);
    periodic.apply(&mut mesh.points);
    let linear = &straight[..linear_nodes];
    let first = Proof::of(&mesh, linear, &boundary, &association);
    assert!(!first.certificate.holds(), "the case must be broken to begin with");
    let fallback = Fallback { order: Order::LINEAR, places: straight.clone() };
    let (_, proof) = retreat(&mut mesh, &fallback, linear, &boundary, &association, &periodic, first);
    assert!(proof.holds());
    assert!(mesh.points[master.index()] != straight[master.index()] + DVec3::splat(0.4));
    assert!(periodic.farthest(&mesh.points) < 1e-14, "{:e}", periodic.farthest(&mesh.points));
}

/// A hex over a wall that overhangs: a cubic S with control points 0, (a, h), (1 - a, -h), (1, 0), and lines normal to it of the length of
/// its tangents. The determinant is that of the tangent's square: the volume is valid while its floor folds.
fn overhang(x: DVec3) -> DVec3 {
    const HEIGHT: f64 = 0.02;
    let control = [[0.0, 0.0], [1.25, 0.5], [-0.25, -0.5], [1.0, 0.0]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let (t, s) = (x.x, 1.0 - x.x);
    let place = |c: [DVec3; 4]| c[0] * s.powi(3) + 3.0 * (c[1] * s * s * t + c[2] * s * t * t) + c[3] * t.powi(3);
    let tangent =
        (control[1] - control[0]) * s * s + 2.0 * (control[2] - control[1]) * s * t + (control[3] - control[2]) * t * t;
    place(control) + tangent.cross(DVec3::Y) * HEIGHT * x.z + DVec3::Y * x.y
}

#[test]
fn a_folded_wall_face_of_a_valid_element_is_taken_back() {
    let corners = Cell::Hex.corners();
    let nodes = |keep: &dyn Fn([u8; 3]) -> bool| -> Vec<NodeId> {
        (0..8).filter(|&n| keep(corners[n])).map(|n| NodeId::new(n).unwrap()).collect()
    };
    let block = |cell: Cell, tag, nodes| Block {
        cell,
        entity: EntityKey::new(cell.dimension() as u8, tag),
        physical_tags: vec![],
        tags: vec![tag as u64],
        nodes,
    };
    let mut floor = nodes(&|c| c[2] == 0);
    let around = |n: &NodeId| [[0, 0], [1, 0], [1, 1], [0, 1]].iter().position(|c| corners[n.index()][..2] == c[..]);
    floor.sort_by_key(around);
    let linear = Mesh {
        points: corners.iter().map(|c| overhang(DVec3::from(c.map(f64::from)))).collect(),
        node_tags: (1..=8).collect(),
        node_entities: vec![None; 8],
        blocks: vec![block(Cell::Quad, 1, floor), block(Cell::Hex, 2, nodes(&|_| true))],
        ..Mesh::default()
    };
    let order = Order::new(3).unwrap();
    let mut mesh = elevate(&linear, order).unwrap().mesh;
    let straight = mesh.points.clone();
    let unit = lattice(Cell::Hex, order).iter().map(|at| DVec3::from(at.map(|x| f64::from(x) / 3.0)));
    for (node, x) in mesh.blocks[1].nodes.iter().zip(unit) {
        mesh.points[node.index()] = overhang(x);
    }
    let boundary = Boundary::new(&linear);
    // The floor of the plate lies below it: there its normals are compared with the CAD's.
    let association = Association {
        faces: vec![Classification::Surface(0)],
        surfaces: vec![surface("plate", 4)],
        ..Association::default()
    };
    let first = Proof::of(&mesh, &linear.points, &boundary, &association);
    assert!(first.certificate.holds() && first.walls.folded() == 1, "the face alone must be broken: {first:?}");

    let fallback = Fallback { order: Order::LINEAR, places: straight.clone() };
    let (shares, proof) =
        retreat(&mut mesh, &fallback, &linear.points, &boundary, &association, &PeriodicConstraint::default(), first);
    let given_up = given_up(&mesh, &boundary, &association, &shares, Order::LINEAR);
    assert!(proof.holds(), "{proof:?}");
    assert!(given_up.len() == 1 && given_up[0].face == 0, "{given_up:?}");
    assert!((0.25..1.0).contains(&given_up[0].share), "no more than it must: {given_up:?}");
}

/// A triangle on half a cylinder from 20 to 60 degrees along one edge, its third corner at 140: there the wall, and the face with it,
/// leans by 100 degrees against the linear face. It is no fold, as the CAD leans with it.
#[test]
fn a_face_that_leans_as_far_as_its_wall_does_not_fold() {
    const RADIUS: f64 = 0.5;
    let order = Order::new(4).unwrap();
    let place = |at: DVec3| {
        let (sin, cos) = (20.0 + 40.0 * at.x + 120.0 * at.y).to_radians().sin_cos();
        DVec3::new(RADIUS * cos, RADIUS * sin, 0.1 + 0.8 * at.y)
    };
    let block = |count| Block {
        cell: Cell::Triangle,
        entity: EntityKey::new(2, 1),
        physical_tags: vec![],
        tags: vec![1],
        nodes: (0..count).map(|n| NodeId::new(n).unwrap()).collect(),
    };
    let mesh = |order: Order| {
        let unit = lattice(Cell::Triangle, order).iter().map(|at| DVec3::from(at.map(f64::from)) / order.get() as f64);
        let points: Vec<DVec3> = unit.map(place).collect();
        let (node_entities, node_tags) = (vec![None; points.len()], (1..=points.len() as u64).collect());
        Mesh { order, node_tags, node_entities, blocks: vec![block(points.len())], points, ..Mesh::default() }
    };
    let (linear, mesh) = (mesh(Order::LINEAR), mesh(order));
    let boundary = Boundary::new(&linear);
    let on = |surfaces| Association { faces: vec![Classification::Surface(0)], surfaces, ..Association::default() };
    let walls = |association: &Association| Proof::of(&mesh, &linear.points, &boundary, association).walls;
    assert_eq!(walls(&on(vec![])).folded(), 1, "it leans too little against its linear face");
    let walls = walls(&on(vec![surface("cylinder_bl", 3)]));
    assert!(walls.hold(), "{walls:?}");
}
