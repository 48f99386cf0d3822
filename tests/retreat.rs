//! A mesh that no smoothing saved comes out valid, with the list of what was given up.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use glam::DVec3;
use sagitta::associate::{Association, Boundary, Host};
use sagitta::certify::{self, Settings};
use sagitta::element::Order;
use sagitta::elevate::elevate;
use sagitta::formats;
use sagitta::periodic::Ties;
use sagitta::retreat::{Fallback, retreat};

#[test]
fn displacements_are_taken_back_until_every_element_is_valid() {
    let linear = formats::read(Path::new("fixtures/sphere_shell/sphere_shell.msh")).unwrap();
    let boundary = Boundary::new(&linear);
    let association = Association { faces: vec![Host::Surface(0); boundary.faces.len()], ..Association::default() };
    let elevated = elevate(&linear, Order::new(3).unwrap()).unwrap();
    let (straight, linear_nodes) = (elevated.mesh.points.clone(), elevated.linear_nodes);
    let mut mesh = elevated.mesh;
    // A wall node pushed through several layers, and another just a little.
    let wall_node = mesh.blocks_of(2).find_map(|(_, b)| b.nodes.iter().find(|n| n.index() >= linear_nodes));
    let wall_node = *wall_node.unwrap();
    mesh.points[wall_node.index()] += DVec3::splat(0.2);
    mesh.points[linear_nodes] += DVec3::splat(1e-6);

    let first = certify::mesh(&mesh, Some(&straight[..linear_nodes]), &Settings::default());
    assert!(!first.holds(), "the case must be broken to begin with");
    let fallback = Fallback { order: Order::LINEAR, places: straight.clone() };
    let (given_up, certificate) =
        retreat(&mut mesh, &fallback, &straight[..linear_nodes], &boundary, &association, &Ties::default(), first);

    assert!(certificate.holds());
    assert!(certify::mesh(&mesh, None, &Settings::default()).holds(), "the mesh that is handed back is the valid one");
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
    let certificate = certify::mesh(&mesh, None, &Settings::default());
    let boundary = Boundary::new(&linear);
    let (given_up, _) = retreat(
        &mut mesh,
        &Fallback { order: Order::LINEAR, places: straight.clone() },
        &straight[..elevated.linear_nodes],
        &boundary,
        &Association::default(),
        &Ties::default(),
        certificate,
    );
    assert!(given_up.is_empty() && mesh.points == straight);
}

#[test]
fn both_sides_of_a_periodic_pair_retreat_alike() {
    let linear = formats::read(Path::new("fixtures/periodic/sector.msh")).unwrap();
    let boundary = Boundary::new(&linear);
    let association = Association { faces: vec![Host::Surface(0); boundary.faces.len()], ..Association::default() };
    let mut elevated = elevate(&linear, Order::new(2).unwrap()).unwrap();
    let (ties, notes) = Ties::new(&mut elevated, &boundary, false);
    assert!(notes.is_empty(), "{notes:?}");
    ties.apply(&mut elevated.mesh.points);
    let (straight, linear_nodes) = (elevated.mesh.points.clone(), elevated.linear_nodes);
    let mut mesh = elevated.mesh;
    // A new node of the side that leads, pushed far into the volume, and its image with it.
    let &(_, master) = mesh.periodic.iter().flat_map(|p| &p.pairs).find(|(_, m)| m.index() >= linear_nodes).unwrap();
    mesh.points[master.index()] += DVec3::splat(0.4);
    ties.apply(&mut mesh.points);
    let first = certify::mesh(&mesh, Some(&straight[..linear_nodes]), &Settings::default());
    assert!(!first.holds(), "the case must be broken to begin with");
    let fallback = Fallback { order: Order::LINEAR, places: straight.clone() };
    let linear = &straight[..linear_nodes];
    let (_, certificate) = retreat(&mut mesh, &fallback, linear, &boundary, &association, &ties, first);
    assert!(certificate.holds());
    assert!(mesh.points[master.index()] != straight[master.index()] + DVec3::splat(0.4));
    assert!(ties.farthest(&mesh.points) < 1e-14, "{:e}", ties.farthest(&mesh.points));
}
