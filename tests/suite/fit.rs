//! The fit of the wall: nodes of wall edges slide along the CAD, and the wall comes nearer to it.

use std::collections::{BTreeMap, BTreeSet};

use crate::common::fixture;
use cad::{EntityId, FaceId, Model, ReadOptions};
use glam::DVec3;
use sagitta::associate::{Classification, Sources, Surface, classify};
use sagitta::curve::Settings;
use sagitta::curve::level::{Case, Level};
use sagitta::curve::wall::fit::fit;
use sagitta::curve::wall::project;
use sagitta::element::{Order, Samples, basis, interior_extension, interior_start};
use sagitta::formats;
use sagitta::mesh::Boundary;
use sagitta::mesh::elevate::elevate;

/// Points an edge, times the order, at which walls are measured; the fit itself takes 3.
const DENSITY: usize = 7;

/// Largest distance of each curved surface's faces from it.
fn levels(level: &Level) -> BTreeMap<usize, f64> {
    let Case { boundary, association, .. } = level.case;
    let order = level.mesh().order();
    let mut levels = BTreeMap::new();
    for (f, (face, classification)) in boundary.faces.iter().zip(&association.faces).enumerate() {
        let Classification::Surface(surface) = *classification else { continue };
        if association.plane_of(*classification).is_some() {
            continue; // its inner edges are carried by the perturbation
        }
        let nodes = boundary.nodes(f, level.mesh());
        let samples = Samples::survey(face.cell, Order::LINEAR, DENSITY * order.get());
        for &at in &samples.points()[..samples.count()] {
            let values = basis::values(face.cell, order, at);
            let x: DVec3 = nodes.iter().zip(values).map(|(n, v)| level.displaced(n.index()) * v).sum();
            let farthest = levels.entry(surface).or_insert(0.0_f64);
            *farthest = farthest.max(association.surfaces[surface].group.distance(x));
        }
    }
    levels
}

/// What the fit does to a fixture's wall.
struct Outcome {
    before: BTreeMap<usize, f64>,
    after: BTreeMap<usize, f64>,
    /// The longest slide, as a fraction of its edge.
    slid: f64,
}

impl Outcome {
    fn of(case: &str, order: usize) -> Outcome {
        let linear = formats::read(&fixture(case, "msh")).unwrap();
        let boundary = Boundary::new(&linear);
        let model = Model::read(&fixture(case, "step"), &ReadOptions::default()).unwrap();
        let association =
            classify(&Sources::new(None, &BTreeSet::new()), &linear, &boundary, &model).unwrap().association;
        let settings = Settings::new(Order::new(order).unwrap());
        let case_of_all = Case { settings: &settings, boundary: &boundary, association: &association };
        let (mut level, _) = Level::new(case_of_all, elevate(&linear, settings.order).unwrap());
        project(&mut level);
        let start = level.wall.displacements();
        let before = levels(&level);
        fit(&mut level);
        let after = levels(&level);
        let mut slid = 0.0_f64;
        for (n, displacement) in level.wall.displacements().iter().enumerate().filter(|(n, d)| **d != start[*n]) {
            let size = level.wall.size(n).unwrap();
            let group = association.group_of(level.wall.classification(n)).expect("a node that slides is on the CAD");
            let off = group.distance(level.straight()[n] + *displacement);
            assert!(off < 1e-7 * size, "{case} P{order}: node {n} is {off:e} off the CAD");
            assert!(n >= level.elevated.linear_nodes, "{case} P{order}: linear node {n} has slid");
            slid = slid.max(displacement.distance(start[n]) / size);
        }
        Outcome { before, after, slid }
    }
}

fn largest(levels: &BTreeMap<usize, f64>) -> f64 {
    levels.values().copied().fold(0.0, f64::max)
}

/// The weeble's walls change their curvature along the edges, the torus's across them; the last number is what is left at most.
#[test]
fn the_wall_comes_nearer_and_no_surface_farther() {
    for (case, order, share) in
        [("weeble", 2, 0.8), ("weeble", 3, 0.6), ("torus", 2, 0.85), ("torus", 3, 0.6), ("sphere_shell", 2, 0.7)]
    {
        let Outcome { before, after, slid } = Outcome::of(case, order);
        println!("{case} P{order}: {:.3e} to {:.3e}, slid {slid:.3}", largest(&before), largest(&after));
        assert!(largest(&after) <= share * largest(&before), "{case} P{order}: {before:?} {after:?}");
        for (surface, level) in &before {
            // Between the fit's own points a distance is a little larger.
            assert!(after[surface] <= 1.05 * level, "{case} P{order}, {surface}: {level:e} to {:e}", after[surface]);
        }
        assert!(slid > 0.0 && slid < 0.1, "{case} P{order}: slid by {slid}");
    }
}

/// Where curvature does not change no slide helps: nothing moves.
#[test]
fn a_cylinder_stays_as_projected() {
    let Outcome { before, after, slid } = Outcome::of("cylinder_bl", 2);
    assert_eq!(slid, 0.0);
    assert_eq!(before, after);
}

/// Faces left straight beside fitted ones: what lies inside them goes with their rims.
#[test]
fn the_inside_of_straight_faces_follows_their_rims() {
    let (linear, order) = (formats::read(&fixture("weeble", "msh")).unwrap(), Order::new(3).unwrap());
    let boundary = Boundary::new(&linear);
    let model = Model::read(&fixture("weeble", "step"), &ReadOptions::default()).unwrap();
    let mut association =
        classify(&Sources::new(None, &BTreeSet::new()), &linear, &boundary, &model).unwrap().association;
    let third = |surface: &Surface| surface.group.entities() == [EntityId::Face(FaceId::new(2))];
    let waist = association.surfaces.iter().position(third).unwrap();
    let straight: Vec<usize> =
        (0..boundary.faces.len()).filter(|&f| association.faces[f] == Classification::Surface(waist)).collect();
    straight.iter().for_each(|&f| association.faces[f] = Classification::Straight);
    let settings = Settings::new(order);
    let case = Case { settings: &settings, boundary: &boundary, association: &association };
    let (mut level, _) = Level::new(case, elevate(&linear, order).unwrap());
    project(&mut level);
    let before = level.wall.displacements();
    fit(&mut level);
    let displacement = level.wall.displacements();
    let mut beside = 0;
    for face in straight {
        let cell = boundary.faces[face].cell;
        let (rim, inner) = boundary.nodes(face, level.mesh()).split_at(interior_start(cell, order));
        beside += usize::from(rim.iter().any(|n| displacement[n.index()] != before[n.index()]));
        for (node, weights) in inner.iter().zip(interior_extension(cell, order).chunks_exact(rim.len())) {
            let wanted: DVec3 = rim.iter().zip(weights).map(|(n, w)| displacement[n.index()] * *w).sum();
            let off = displacement[node.index()].distance(wanted);
            assert!(off < 1e-12, "face {face}: its inner node is {off:e} off");
        }
    }
    assert!(beside > 0, "no straight face has an edge that slid");
}
