//! Every kind of face and edge, against analysis, OCCT's own distance to the face, and dense sampling.

use std::collections::BTreeMap;

use crate::common::{Random, fixture, options, shape};
use cad::{EdgeId, End, EntityId, Evaluation, FaceId, Group, Hint, Kind, Model, ReferenceError};
use glam::DVec3;
use opencascade_sys as sys;

/// Points in a box around a face.
fn around(model: &Model, face: FaceId, count: usize, random: &mut Random) -> Vec<DVec3> {
    let bounds = model.face(face).unwrap().bounds;
    let margin = 0.3 * (bounds.max - bounds.min);
    (0..count).map(|_| random.in_box(bounds.min - margin, bounds.max + margin)).collect()
}

#[test]
fn kinds_are_read_as_they_are() {
    let model = shape("kinds.brep");
    let kinds: Vec<Kind> = model.faces().iter().map(|face| face.kind).collect();
    use Kind::{Bezier, Bspline, Cone, Cylinder, Extrusion, Offset, Revolution, Sphere, Torus};
    let expected = [Sphere, Sphere, Cylinder, Cone, Torus, Extrusion, Revolution, Offset, Bspline, Bezier];
    assert_eq!(kinds[..10], expected);
    assert_eq!(kinds[10..], [Bspline, Bspline, Cylinder, Offset, Bspline]);
}

/// Distances to whole elementary surfaces by their formulas, in their own tilted frames.
#[test]
fn elementary_surfaces_by_analysis() {
    let model = shape("kinds.brep");
    let frame = |x: f64| {
        let z = DVec3::new(0.2, -0.3, 1.0).normalize();
        (DVec3::new(x, 0.3 * x, 1.0), z)
    };
    let polar = |(o, z): (DVec3, DVec3), p: DVec3| {
        let height = (p - o).dot(z);
        ((p - o - height * z).length(), height)
    };
    let cylinder = |p| {
        let (r, h) = polar(frame(0.0), p);
        (r - 1.3).abs().hypot(h - h.clamp(-2.0, 3.0))
    };
    let torus = |p| {
        let (r, h) = polar(frame(5.0), p);
        ((r - 3.0).hypot(h) - 0.8).abs()
    };
    let cone = |p| {
        // in the meridian plane: from the apex to the rim, a straight line
        let (r, h) = polar(frame(-3.0), p);
        let (apex, rim) = ([0.0, -0.5 / 0.4_f64.tan()], [0.5 + 2.0 * 0.4_f64.sin(), 2.0 * 0.4_f64.cos()]);
        let (d, q) = ([rim[0] - apex[0], rim[1] - apex[1]], [r - apex[0], h - apex[1]]);
        let t = ((q[0] * d[0] + q[1] * d[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
        (q[0] - t * d[0]).hypot(q[1] - t * d[1])
    };
    let sphere = |p: DVec3| (p.distance(frame(2.0).0) - 1.7).abs();
    let formulas: [(usize, &dyn Fn(DVec3) -> f64); 4] = [(0, &sphere), (2, &cylinder), (3, &cone), (4, &torus)];
    let mut random = Random(31);
    for (index, distance) in formulas {
        let id = FaceId::new(index);
        let group = Group::of_faces(&model, &[id]).unwrap();
        for x in around(&model, id, 400, &mut random) {
            let foot = group.closest(x, None).unwrap();
            let excess = (foot.distance - distance(x)).abs();
            assert!(excess < 1e-11 * model.diagonal(), "{id} at {x}: {foot:?}, expected {}", distance(x));
            assert!(foot.is_proven() && !matches!(foot.end, End::Stalled { .. }), "{foot:?}");
        }
    }
}

/// A box around the face, its far surroundings, and points on it: never farther than OCCT's distance to the trimmed face.
#[test]
fn all_kinds_against_occt_and_samples() {
    for name in ["kinds.brep", "plate.brep"] {
        let model = shape(name);
        let path = crate::common::shape_path(name);
        let import = sys::read_file(path.to_str().unwrap(), sys::Format::Brep, 1.0, false).unwrap();
        let mut random = Random(41);
        for face in model.faces() {
            let group = Group::of_faces(&model, &[face.id]).unwrap();
            let oracle = sys::oracle(import.shape(), face.id.index()).unwrap();
            if name == "kinds.brep" && face.id.index() == 12 {
                continue; // OCCT 7.6 does not see a hole that is written a period away
            }
            for x in around(&model, face.id, 25, &mut random) {
                let foot = group.closest(x, None).unwrap();
                let theirs = oracle.extrema(x.x, x.y, x.z, &mut [0.0; 3]).unwrap();
                let excess = foot.distance - theirs;
                assert!(excess < 1e-9 * model.diagonal(), "{name} {} at {x}: {foot:?}, OCCT {theirs}", face.id);
                assert!(!matches!(foot.end, End::Stalled { .. }), "{name} {}: {foot:?}", face.id);
                // the foot lies on the trimmed face
                let off = oracle.extrema(foot.point.x, foot.point.y, foot.point.z, &mut [0.0; 3]).unwrap();
                assert!(off < 1e-6, "{name} {}: the foot is {off} off the face", face.id);
            }
        }
    }
}

/// Far from the surface, where distances to its parts differ little, hulls that do not shrink with the part would leave feet unproven.
#[test]
fn feet_on_offset_surfaces_are_proven_from_afar() {
    let model = shape("kinds.brep");
    let mut random = Random(59);
    for face in model.faces().iter().filter(|face| face.kind == Kind::Offset) {
        let group = Group::of_faces(&model, &[face.id]).unwrap();
        let reach = DVec3::splat(face.bounds.diagonal());
        for _ in 0..200 {
            let x = random.in_box(face.bounds.min - reach, face.bounds.max + reach);
            let foot = group.closest(x, None).unwrap();
            assert!(foot.is_proven(), "{} at {x}: {foot:?}", face.id);
        }
    }
}

/// The hole of face 13 is a circle of radius 0.9 in parameters, around (1.5, 0.5), written a period away.
#[test]
fn a_hole_a_period_away_is_a_hole() {
    let model = shape("kinds.brep");
    let face = model.face(FaceId::new(12)).unwrap();
    let group = Group::of_faces(&model, &[face.id]).unwrap();
    let middle = model.evaluate(face.id.into(), [1.5, 0.5]).unwrap().point();
    let foot = group.closest(middle, None).unwrap();
    assert!(matches!(foot.end, End::OnTrim(_)) && foot.distance > 0.5, "{foot:?}");
    let beside = model.evaluate(face.id.into(), [4.0, 0.5]).unwrap().point();
    assert!(group.distance(beside) < 1e-12);
}

#[test]
fn instances_of_an_assembly_are_entities_of_their_own() {
    let model = shape("assembly.step");
    assert_eq!(model.faces().len(), 4 * 7, "{:?}", model.faces().iter().map(|f| &f.label).collect::<Vec<_>>());
    let references: std::collections::BTreeSet<&str> =
        model.faces().iter().map(|face| face.label.reference.as_str()).collect();
    assert_eq!(references.len(), model.faces().len(), "{references:?}");
    for face in model.faces() {
        assert_eq!(model.resolve(&face.label.reference).unwrap(), [EntityId::Face(face.id)]);
    }
    let (plain, path) = model.face(FaceId::new(0)).unwrap().label.reference.split_once('@').unwrap();
    assert_eq!(path.split('/').count(), 3, "{path}");
    match model.resolve(plain) {
        Err(ReferenceError::Ambiguous { candidates, .. }) => assert_eq!(candidates.len(), 4),
        other => panic!("{other:?}"),
    }
    assert!(model.bounds().max.x > 20.0);
}

#[test]
fn free_curves_are_edges() {
    ["curves.step", "curves.igs"].iter().for_each(|name| free_curves(&shape(name)));
}

fn free_curves(model: &Model) {
    assert_eq!((model.faces().len(), model.edges().len()), (0, 3));
    let mut random = Random(43);
    for edge in model.edges() {
        let group = Group::of_edges(model, &[edge.id]).unwrap();
        assert!(edge.faces.is_empty() && !edge.label.reference.is_empty(), "{edge:?}");
        for _ in 0..50 {
            let x = random.in_box(model.bounds().min, model.bounds().max);
            let foot = group.closest(x, None).unwrap();
            let best = sampled_edge(model, edge.id, x);
            assert!(foot.distance <= best + 1e-12 && foot.is_proven(), "{} at {x}: {foot:?} against {best}", edge.id);
        }
    }
}

fn sampled_edge(model: &Model, id: EdgeId, x: DVec3) -> f64 {
    let [a, b] = model.edge(id).unwrap().parameters;
    let at = |k: u32| [a + (b - a) * f64::from(k) / 2000.0, 0.0];
    let distances = (0..=2000).map(|k| model.evaluate(id.into(), at(k)).unwrap().point().distance(x));
    distances.fold(f64::INFINITY, f64::min)
}

/// Weingarten's equations: the normal moves by `−κ` times the move along a principal direction, so the trace and determinant of the map from
/// moves to its differences are `−(κ₁ + κ₂)` and `κ₁ κ₂`.
#[test]
fn principal_curvatures_are_those_of_the_moving_normal() {
    let model = shape("kinds.brep");
    let mut random = Random(53);
    let mut seen = 0;
    for face in model.faces() {
        let [u, v] = face.parameters;
        let inside = |[a, b]: [f64; 2], t: f64| a + (b - a) * (0.1 + 0.8 * t);
        for _ in 0..20 {
            let p = [inside(u, random.unit()), inside(v, random.unit())];
            let at = |du: f64, dv: f64| match model.evaluate(face.id.into(), [p[0] + du, p[1] + dv]) {
                Some(Evaluation::Surface(point)) => point,
                other => panic!("{}: {other:?}", face.id),
            };
            let normal = |du: f64, dv: f64| at(du, dv).normal.unwrap();
            let here = at(0.0, 0.0);
            let [k1, k2] = here.curvatures.unwrap();
            let [hu, hv] = [1e-5 * (u[1] - u[0]), 1e-5 * (v[1] - v[0])];
            let a = here.parameters_of((normal(hu, 0.0) - normal(-hu, 0.0)) / (2.0 * hu));
            let b = here.parameters_of((normal(0.0, hv) - normal(0.0, -hv)) / (2.0 * hv));
            let (trace, determinant) = (a.x + b.y, a.x * b.y - a.y * b.x);
            let size = k1.abs().max(k2.abs()).max(1e-3 / model.diagonal());
            // second derivatives jump at knots, which a difference may straddle
            let smooth = at(hu, 0.0).second[0].distance(at(-hu, 0.0).second[0]) < 0.1 * here.second[0].length() + 1e-3
                && at(0.0, hv).second[2].distance(at(0.0, -hv).second[2]) < 0.1 * here.second[2].length() + 1e-3;
            if smooth {
                assert!((trace + k1 + k2).abs() < 1e-3 * size, "{} at {p:?}: {trace} {k1} {k2}", face.id);
                assert!((determinant - k1 * k2).abs() < 1e-3 * size * size, "{} at {p:?}: {k1} {k2}", face.id);
                seen += 1;
            }
            assert!(k1 >= k2);
        }
    }
    assert!(seen > 15 * model.faces().len(), "{seen} of {} faces", model.faces().len());
}

/// Where a foot is proven, a hint of any other query must not change the distance.
#[test]
fn hints_are_never_wrong_on_any_kind() {
    let model = cad::Model::read(&crate::common::shape_path("kinds.brep"), &options()).unwrap();
    let all: Vec<FaceId> = model.faces().iter().map(|face| face.id).collect();
    let group = Group::of_faces(&model, &all).unwrap();
    let mut random = Random(47);
    let xs: Vec<DVec3> = (0..500).map(|_| random.in_box(model.bounds().min, model.bounds().max)).collect();
    let mut hint = Hint::default();
    for (i, &x) in xs.iter().enumerate() {
        let plain = group.closest(x, None).unwrap();
        let hinted = group.closest(x, Some(&mut hint)).unwrap();
        assert!((plain.distance - hinted.distance).abs() < 1e-11 * model.diagonal(), "{i} {x}: {plain:?} {hinted:?}");
        // a walk of small moves: the chain of hints carries its clearance on
        let mut at = x;
        for _ in 0..4 {
            at += 1e-3 * model.diagonal() * (random.in_box(DVec3::ZERO, DVec3::ONE) - DVec3::splat(0.5));
            let hinted = group.closest(at, Some(&mut hint)).unwrap();
            let plain = group.distance(at);
            assert!((plain - hinted.distance).abs() < 1e-11 * model.diagonal(), "{i} {at}: {plain} {hinted:?}");
        }
    }
}

/// Flat is what points of it say: no face or edge is called so that is not, and none by kind alone.
#[test]
fn flat_faces_and_straight_edges_are_told_whatever_they_are_written_as() {
    let mut flat = BTreeMap::new();
    for (name, model) in [
        ("kinds", shape("kinds.brep")),
        ("gap", fixture("gap/gap.step")),
        ("wing_sharp", fixture("wing_sharp/wing_sharp.step")),
    ] {
        for face in model.faces() {
            let [u, v] = face.parameters.map(stations);
            let places = u.iter().flat_map(|&u| v.iter().map(move |&v| [u, v]));
            let seen = is_flat_by_points(&model, face.id.into(), places, 2);
            assert_eq!(model.is_flat(face.id.into()), seen, "{name}: {} {:?}", face.id, face.kind);
            *flat.entry((format!("{:?}", face.kind), seen)).or_insert(0) += 1;
        }
        for edge in model.edges().iter().filter(|edge| !edge.degenerate) {
            let places = stations(edge.parameters).into_iter().map(|t| [t, 0.0]);
            let seen = is_flat_by_points(&model, edge.id.into(), places, 1);
            assert_eq!(model.is_flat(edge.id.into()), seen, "{name}: {} {:?}", edge.id, edge.kind);
        }
    }
    println!("{flat:?}");
    assert!(flat.contains_key(&("Bspline".to_owned(), true)) && flat.contains_key(&("Bspline".to_owned(), false)));
}

fn stations([from, to]: [f64; 2]) -> Vec<f64> {
    (0..=12).map(|k| from + (to - from) * (0.02 + 0.08 * f64::from(k))).collect()
}

/// Whether OCCT's points of an entity lie in one line (1 dimension) or plane (2), to 1e-8 of their extent.
fn is_flat_by_points(model: &Model, id: EntityId, at: impl Iterator<Item = [f64; 2]>, dimensions: usize) -> bool {
    let place = |at| match model.evaluate(id, at) {
        Some(Evaluation::Surface(point)) => Some(point.point),
        Some(Evaluation::Curve(point)) => Some(point.point),
        _ => None,
    };
    let points: Vec<DVec3> = at.filter_map(place).collect();
    let middle = points.iter().sum::<DVec3>() / points.len() as f64;
    let mut rest: Vec<DVec3> = points.iter().map(|&p| p - middle).collect();
    let longest = |rest: &[DVec3]| rest.iter().copied().max_by(|a, b| a.length().total_cmp(&b.length())).unwrap();
    let extent = longest(&rest).length();
    for _ in 0..dimensions {
        let along = longest(&rest).normalize_or_zero();
        rest.iter_mut().for_each(|r| *r -= r.dot(along) * along);
    }
    longest(&rest).length() <= 1e-8 * extent
}
