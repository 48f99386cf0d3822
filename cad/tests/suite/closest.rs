//! Closest points against analysis and against dense sampling.

use crate::common::{Random, fixture};
use cad::{End, EntityId, Evaluation, FaceId, Foot, Group, Hint, Kind, Model};
use glam::DVec3;

fn all_faces(model: &Model) -> Group {
    Group::of_faces(model, &model.faces().iter().map(|face| face.id).collect::<Vec<_>>()).unwrap()
}

/// Nearest sampled point of the given faces: an upper bound of the distance that the foot must not exceed.
fn sampled(model: &Model, faces: &[FaceId], inside: &dyn Fn(FaceId, DVec3) -> bool, per_side: u32, x: DVec3) -> f64 {
    let mut best = f64::INFINITY;
    for &id in faces {
        let [u, v] = model.face(id).unwrap().parameters;
        for k in 0..per_side * per_side {
            let (a, b) = (f64::from(k / per_side), f64::from(k % per_side));
            let at = |r: [f64; 2], s: f64| r[0] + (r[1] - r[0]) * s / f64::from(per_side - 1);
            let point = model.evaluate(id.into(), [at(u, a), at(v, b)]).unwrap().point();
            if inside(id, point) {
                best = best.min(point.distance(x));
            }
        }
    }
    best
}

fn check(group: &Group, model: &Model, foot: &Foot, x: DVec3) {
    assert!((foot.point.distance(x) - foot.distance).abs() <= 1e-15 * model.diagonal());
    if !matches!(foot.end, End::OnTrim(_) | End::OnEnd(_)) {
        let again = group.evaluate_at(foot).unwrap().point();
        assert!(again == foot.point, "the foot is OCCT's own point");
    }
    assert!(!matches!(foot.end, End::Stalled { .. }), "{foot:?} from {x}");
}

#[test]
fn torus_by_analysis() {
    let model = fixture("torus/torus.step");
    for face in model.faces().iter().filter(|face| face.kind == Kind::Torus) {
        let group = Group::of_faces(&model, &[face.id]).unwrap();
        let (center, size) = (face.bounds.center(), face.bounds.max - face.bounds.min);
        // the axis is the short direction of the box
        let axis = if size.x < size.y.min(size.z) {
            0
        } else if size.y < size.z {
            1
        } else {
            2
        };
        let minor = 0.5 * size[axis];
        let major = 0.5 * size[(axis + 1) % 3] - minor;
        let mut random = Random(7);
        for _ in 0..500 {
            let x = random.in_box(face.bounds.min - size * 0.2, face.bounds.max + size * 0.2);
            let mut flat = x - center;
            let height = flat[axis];
            flat[axis] = 0.0;
            let expected = ((flat.length() - major).hypot(height) - minor).abs();
            let foot = group.closest(x, None).unwrap();
            check(&group, &model, &foot, x);
            assert!((foot.distance - expected).abs() < 1e-3 * minor, "{x}: {} against {expected}", foot.distance);
            assert!(foot.is_proven());
        }
    }
}

#[test]
fn feet_are_not_farther_than_samples() {
    for name in ["weeble/weeble.step", "wing_sharp/wing_sharp.step", "torus/torus.igs"] {
        let model = fixture(name);
        let mut random = Random(3);
        for face in model.faces() {
            let group = Group::of_faces(&model, &[face.id]).unwrap();
            let margin = 0.2 * (face.bounds.max - face.bounds.min) + 0.01 * model.diagonal();
            let on = |_: FaceId, p: DVec3| group.distance(p) < 1e-9 * model.diagonal();
            let mut unproven = 0;
            for _ in 0..40 {
                let x = random.in_box(face.bounds.min - margin, face.bounds.max + margin);
                let foot = group.closest(x, None).unwrap();
                check(&group, &model, &foot, x);
                unproven += usize::from(!foot.is_proven());
                let best = sampled(&model, &[face.id], &on, 30, x);
                assert!(
                    foot.distance <= best + 1e-12 * model.diagonal(),
                    "{name} {}: {} > {best} at {x}",
                    face.id,
                    foot.distance
                );
            }
            assert!(unproven < 4, "{name} {}: {unproven} of 40 not proven", face.id);
        }
    }
}

/// Points of the surface inside the trim are their own feet, seams and poles included.
#[test]
fn points_on_the_surface_are_their_own_feet() {
    let model = fixture("weeble/weeble.step");
    let group = all_faces(&model);
    for face in model.faces() {
        let [u, v] = face.parameters;
        for i in 0..=16 {
            for j in 0..=16 {
                let at = |r: [f64; 2], k: i32| r[0] + (r[1] - r[0]) * f64::from(k) / 16.0;
                let Evaluation::Surface(s) = model.evaluate(face.id.into(), [at(u, i), at(v, j)]).unwrap() else {
                    panic!()
                };
                let foot = group.closest(s.point, None).unwrap();
                assert!(foot.distance < 1e-11 * model.diagonal(), "{} {} {}: {foot:?}", face.id, i, j);
            }
        }
    }
}

#[test]
fn a_group_is_the_nearest_of_its_faces() {
    let model = fixture("wing_sharp/wing_sharp.step");
    let group = all_faces(&model);
    let single: Vec<Group> = model.faces().iter().map(|face| Group::of_faces(&model, &[face.id]).unwrap()).collect();
    let mut random = Random(11);
    for _ in 0..200 {
        let x = random.in_box(model.bounds().min, model.bounds().max);
        let best = single.iter().map(|g| g.distance(x)).fold(f64::INFINITY, f64::min);
        let foot = group.closest(x, None).unwrap();
        assert!((foot.distance - best).abs() < 1e-11 * model.diagonal());
    }
}

#[test]
fn edges_against_samples_and_ends() {
    let model = fixture("wing_sharp/wing_sharp.step");
    let mut random = Random(5);
    for edge in model.edges().iter().filter(|edge| !edge.degenerate) {
        let group = Group::of_edges(&model, &[edge.id]).unwrap();
        let margin = DVec3::splat(0.05 * model.diagonal());
        for _ in 0..20 {
            let x = random.in_box(edge.bounds.min - margin, edge.bounds.max + margin);
            let foot = group.closest(x, None).unwrap();
            check(&group, &model, &foot, x);
            let [a, b] = edge.parameters;
            let best = (0..=400)
                .map(|k| {
                    group
                        .evaluate(edge.id.into(), [a + (b - a) * f64::from(k) / 400.0, 0.0])
                        .unwrap()
                        .point()
                        .distance(x)
                })
                .fold(f64::INFINITY, f64::min);
            assert!(foot.distance <= best + 1e-13 * model.diagonal(), "{}: {} > {best}", edge.id, foot.distance);
            assert!(foot.is_proven(), "{}", edge.id);
        }
        let group = Group::of_vertices(&model, &edge.ends.map(Option::unwrap)).unwrap();
        let foot = group.closest(edge.bounds.center(), None).unwrap();
        assert!(matches!((foot.end, foot.entity), (End::OnEnd(_), EntityId::Vertex(_))));
    }
}

#[test]
fn step_and_iges_give_the_same_feet() {
    for case in ["weeble/weeble", "wing_sharp/wing_sharp"] {
        let (step, iges) = (fixture(&format!("{case}.step")), fixture(&format!("{case}.igs")));
        let (a, b) = (all_faces(&step), all_faces(&iges));
        let mut random = Random(17);
        for _ in 0..300 {
            let x = random.in_box(step.bounds().min, step.bounds().max);
            let (foot, other) = (a.closest(x, None).unwrap(), b.closest(x, None).unwrap());
            assert!((foot.distance - other.distance).abs() < 1e-7 * step.diagonal(), "{case} {x}: {foot:?} {other:?}");
        }
    }
}

/// Walks of steps from tiny to large, which leave a leaf, spend leeways and search anew: the hint is carried along all the way.
#[test]
fn a_hint_is_never_wrong_along_a_walk() {
    let model = fixture("wing_sharp/wing_sharp.step");
    let group = all_faces(&model);
    let mut random = Random(29);
    let mut differ = 0;
    for walk in 0..400 {
        let mut x = random.in_box(model.bounds().min, model.bounds().max);
        let mut hint = Hint::default();
        let step = model.diagonal() * 10.0_f64.powf(-1.0 - 4.0 * random.unit());
        for k in 0..25 {
            let (plain, hinted) = (group.closest(x, None).unwrap(), group.closest(x, Some(&mut hint)).unwrap());
            let off = (plain.distance - hinted.distance).abs();
            assert!(off < 1e-12 * model.diagonal(), "walk {walk}, step {k}, {x}: {plain:?} {hinted:?}");
            differ += usize::from(plain.is_proven() != hinted.is_proven());
            x += step * random.in_box(-DVec3::ONE, DVec3::ONE);
        }
    }
    assert_eq!(differ, 0, "proven without a hint but not with one, or the reverse");
}

#[test]
fn points_beyond_all_measure_have_no_foot() {
    let model = fixture("torus/torus.step");
    let group = all_faces(&model);
    for x in [DVec3::NAN, DVec3::INFINITY, DVec3::new(0.0, f64::NAN, 0.0), DVec3::splat(1e200)] {
        let mut hint = Hint::default();
        assert_eq!(group.closest(x, None), None, "{x}");
        assert_eq!(group.closest(x, Some(&mut hint)), None, "{x}");
        assert_eq!(group.distance(x), f64::INFINITY, "{x}");
        assert!(group.closest(DVec3::X, Some(&mut hint)).is_some_and(|foot| foot.is_proven()), "after {x}");
    }
}

#[test]
fn threads_and_hints_change_nothing() {
    let model = fixture("wing_sharp/wing_sharp.step");
    let group = all_faces(&model);
    let mut random = Random(23);
    let xs: Vec<DVec3> = (0..2000).map(|_| random.in_box(model.bounds().min, model.bounds().max)).collect();
    let serial: Vec<Option<Foot>> = xs.iter().map(|&x| group.closest(x, None)).collect();
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        assert_eq!(pool.install(|| group.closest_batch(&xs, &mut [])), serial, "{threads} threads");
    }
    let mut hint = Hint::default();
    for (i, foot) in serial.iter().flatten().enumerate() {
        group.closest(xs[(i * 7 + 1) % xs.len()], Some(&mut hint)).unwrap();
        let hinted = group.closest(xs[i], Some(&mut hint)).unwrap();
        assert!((hinted.distance - foot.distance).abs() < 1e-12 * model.diagonal(), "a hint made an answer wrong");
    }
}

/// At a trim the old foot may be inside by rounding, and the next one outside: a hint must not leave the query without a foot.
#[test]
fn a_hint_at_the_rim_of_a_face_is_never_wrong() {
    for name in ["weeble/weeble.step", "wing_sharp/wing_sharp.igs", "onera_m6/onera_m6.egads"] {
        let model = fixture(name);
        let mut random = Random(37);
        for face in model.faces() {
            let group = Group::of_faces(&model, &[face.id]).unwrap();
            for &edge in &face.edges {
                let edge = model.edge(edge).unwrap();
                let mut hint = Hint::default();
                for k in 0..400 {
                    let t = random.between(edge.parameters[0], edge.parameters[1]);
                    let Some(on) = model.evaluate(edge.id.into(), [t, 0.0]) else { break };
                    // often the same place twice, but for its rounding
                    let step = model.diagonal() * [0.0, 1e-16, 1e-15, 1e-13][k % 4];
                    for _ in 0..3 {
                        let x = on.point() + step * random.in_box(-DVec3::ONE, DVec3::ONE);
                        let foot = group.closest(x, Some(&mut hint));
                        let slack = edge.tolerance + 1e-12 * model.diagonal();
                        assert!(
                            foot.is_some_and(|foot| foot.distance <= slack),
                            "{name} {} {}: {foot:?}",
                            face.id,
                            edge.id
                        );
                    }
                }
            }
        }
    }
}
