//! A mesh that no smoothing saved comes out valid, with the list of faces that are off the CAD.

use std::path::Path;

use cad::{FaceId, Group, Model, ReadOptions};
use glam::DVec3;
use sagitta::associate::{Association, Classification, Surface};
use sagitta::certify::{self, Settings};
use sagitta::curve;
use sagitta::curve::level::{Case, Level};
use sagitta::curve::proof::Proof;
use sagitta::curve::recover::backtrack::{Fallback, backtrack};
use sagitta::curve::recover::off_cad_faces;
use sagitta::element::{Cell, Order, lattice};
use sagitta::formats;
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{Boundary, EntityKey, Mesh, NodeId, Parts};

/// A face of a fixture's CAD, by its index.
fn surface(case: &str, face: usize) -> Surface {
    let model = Model::read(Path::new(&format!("fixtures/{case}/{case}.step")), &ReadOptions::default()).unwrap();
    let group = Group::of_faces(&model, &[FaceId::new(face)]).unwrap();
    Surface { group, label: format!("face {face}"), plane: None }
}

/// A case all of whose boundary faces lie on the first surface.
struct Given {
    settings: curve::Settings,
    boundary: Boundary,
    association: Association,
}

impl Given {
    fn new(linear: &Mesh, order: usize, surfaces: Vec<Surface>) -> Given {
        let boundary = Boundary::new(linear);
        let faces = vec![Classification::Surface(0); boundary.faces.len()];
        let settings = curve::Settings::new(Order::new(order).unwrap());
        Given { settings, boundary, association: Association { faces, surfaces, ..Association::default() } }
    }

    fn level(&self, linear: &Mesh) -> Level<'_> {
        let Given { settings, boundary, association } = self;
        let (level, notes) =
            Level::new(Case { settings, boundary, association }, elevate(linear, settings.order).unwrap());
        assert!(notes.is_empty(), "{notes:?}");
        level
    }
}

fn straight(level: &Level) -> Fallback {
    Fallback { order: Order::LINEAR, positions: level.straight().to_vec() }
}

#[test]
fn displacements_are_taken_back_until_every_element_is_valid() {
    let linear = formats::read(Path::new("fixtures/sphere_shell/sphere_shell.msh")).unwrap();
    let given = Given::new(&linear, 3, vec![]);
    let mut level = given.level(&linear);
    let linear_nodes = level.elevated.linear_nodes;
    // A wall node pushed through several layers, and another just a little.
    let wall_node = level.mesh().side_blocks().find_map(|b| b.nodes.iter().find(|n| n.index() >= linear_nodes));
    let wall_node = *wall_node.unwrap();
    level.curved[wall_node.index()] += DVec3::splat(0.2);
    level.curved[linear_nodes] += DVec3::splat(1e-6);

    let first = Proof::of(&level);
    assert!(!first.certificate.holds(), "the case must be broken to begin with");
    let fallback = straight(&level);
    let (fractions, proof) = backtrack(&mut level, &fallback, first);

    let off_cad = off_cad_faces(&level, Order::LINEAR, |n| fractions[n]);
    assert!(proof.holds());
    let again = certify::mesh(level.mesh(), &level.curved, None, &Settings::default());
    assert!(again.holds(), "the mesh that is handed back is the valid one");
    assert!(!off_cad.is_empty() && off_cad.iter().all(|off| off.fraction().is_some_and(|fraction| fraction < 1.0)));
    assert!(off_cad.len() < given.boundary.faces.len() / 2, "{} faces off the CAD for one node", off_cad.len());
    let moved = level.curved[wall_node.index()].distance(level.straight()[wall_node.index()]);
    assert!(moved < 0.2 * 3.0_f64.sqrt(), "taken back: {moved}");
}

#[test]
fn a_valid_mesh_is_left_alone() {
    let linear = formats::read(Path::new("fixtures/cylinder_bl/cylinder_bl.msh")).unwrap();
    let given = Given::new(&linear, 2, vec![]);
    let mut level = given.level(&linear);
    let (proof, fallback) = (Proof::of(&level), straight(&level));
    let (fractions, _) = backtrack(&mut level, &fallback, proof);
    assert!(fractions.iter().all(|&fraction| fraction == 1.0) && level.curved == level.straight());
}

#[test]
fn both_sides_of_a_periodic_pair_go_back_alike() {
    let linear = formats::read(Path::new("fixtures/periodic/sector.msh")).unwrap();
    let given = Given::new(&linear, 2, vec![]);
    let mut level = given.level(&linear);
    let linear_nodes = level.elevated.linear_nodes;
    level.periodic.apply(&mut level.curved);
    let fallback = Fallback { order: Order::LINEAR, positions: level.curved.clone() };
    // A new node of the side that leads, pushed far into the volume, and its image with it.
    let pairs = &level.mesh().periodic();
    let &(_, master) = pairs.iter().flat_map(|p| &p.pairs).find(|(_, m)| m.index() >= linear_nodes).unwrap();
    let pushed = level.curved[master.index()] + DVec3::splat(0.4);
    level.curved[master.index()] = pushed;
    level.periodic.apply(&mut level.curved);
    let first = Proof::of(&level);
    assert!(!first.certificate.holds(), "the case must be broken to begin with");
    let (_, proof) = backtrack(&mut level, &fallback, first);
    assert!(proof.holds());
    assert!(level.curved[master.index()] != pushed);
    let farthest = level.periodic.farthest(&level.curved);
    assert!(farthest < 1e-14, "{farthest:e}");
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
    let mut floor = nodes(&|c| c[2] == 0);
    let around = |n: &NodeId| [[0, 0], [1, 0], [1, 1], [0, 1]].iter().position(|c| corners[n.index()][..2] == c[..]);
    floor.sort_by_key(around);
    let points = corners.iter().map(|c| overhang(DVec3::from(c.map(f64::from)))).collect();
    let mut parts = Parts { points, ..Parts::default() };
    parts.push(Cell::Quad, EntityKey::new(2, 1), &floor);
    parts.push(Cell::Hex, EntityKey::new(3, 2), &nodes(&|_| true));
    let linear = Mesh::new(parts).unwrap();
    // The floor of the plate lies below it: there its normals are compared with the CAD's.
    let given = Given::new(&linear, 3, vec![surface("plate", 4)]);
    let mut level = given.level(&linear);
    let unit = lattice(Cell::Hex, given.settings.order).iter().map(|at| DVec3::from(at.map(|x| f64::from(x) / 3.0)));
    for (node, x) in level.elevated.mesh.blocks()[1].nodes.iter().zip(unit) {
        level.curved[node.index()] = overhang(x);
    }
    let first = Proof::of(&level);
    assert!(first.certificate.holds() && first.walls.folded() == 1, "the face alone must be broken: {first:?}");

    let fallback = straight(&level);
    let (fractions, proof) = backtrack(&mut level, &fallback, first);
    let off_cad = off_cad_faces(&level, Order::LINEAR, |n| fractions[n]);
    assert!(proof.holds(), "{proof:?}");
    assert!(off_cad.len() == 1 && off_cad[0].face == 0, "{off_cad:?}");
    assert!((0.25..1.0).contains(&off_cad[0].fraction().unwrap()), "no more than it must: {off_cad:?}");
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
    let unit = |order: Order| {
        lattice(Cell::Triangle, order).iter().map(move |at| DVec3::from(at.map(f64::from)) / order.get() as f64)
    };
    let mut points: Vec<DVec3> = unit(Order::LINEAR).map(place).collect();
    points.push(DVec3::new(0.0, 0.0, 0.3)); // a cell behind it: a triangle alone is a plane mesh
    let mut parts = Parts { points, ..Parts::default() };
    parts.push(Cell::Triangle, EntityKey::new(2, 1), &[0, 1, 2].map(|n| NodeId::new(n).unwrap()));
    parts.push(Cell::Tet, EntityKey::new(3, 1), &[0, 1, 2, 3].map(|n| NodeId::new(n).unwrap()));
    let linear = Mesh::new(parts).unwrap();
    let walls = |surfaces| {
        let given = Given::new(&linear, order.get(), surfaces);
        let mut level = given.level(&linear);
        for (node, x) in level.elevated.mesh.blocks()[0].nodes.iter().zip(unit(order)) {
            level.curved[node.index()] = place(x);
        }
        Proof::of(&level).walls
    };
    assert_eq!(walls(vec![]).folded(), 1, "it leans too little against its linear face");
    let walls = walls(vec![surface("cylinder_bl", 3)]);
    assert!(walls.hold(), "{walls:?}");
}
