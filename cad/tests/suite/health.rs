//! The report on what may be wrong with a model.

use crate::common::{fixture, options, shape};
use cad::{Kind, Model, ReadError};

#[test]
fn good_models_are_healthy() {
    for model in [fixture("weeble/weeble.step"), fixture("torus/torus.step"), shape("plate.brep")] {
        let health = model.health();
        let silent = [&health.dropped, &health.warnings].iter().all(|list| list.is_empty());
        assert!(silent && health.trims.is_empty(), "{:?}: {health:?}", model.path());
        assert!(health.open_edges.is_empty() && health.free_edges.is_empty(), "{:?}: {health:?}", model.path());
        assert_eq!(health.faces.values().sum::<usize>(), model.faces().len());
    }
}

#[test]
fn open_and_free_edges_are_told() {
    let unsewn = shape("unsewn.igs").health();
    assert!(
        unsewn.doubled_edges.len() > 10 && unsewn.open_edges.is_empty() && unsewn.free_edges.is_empty(),
        "{unsewn:?}"
    );
    let curves = shape("curves.step").health();
    assert_eq!((curves.free_edges.len(), curves.open_edges.len()), (3, 0));
    assert_eq!(curves.edges.get(&Kind::Circle), Some(&1));
}

/// A ridge of 87 degrees at the middle of a face, two boxes that touch in their faces 3 and 8, a lemon without edges.
#[test]
fn doubtful_faces_are_told() {
    let model = shape("doubtful.brep");
    let health = model.health();
    let [ridge] = health.creases[..] else { panic!("{:?}", health.creases) };
    assert_eq!((ridge.face.to_string().as_str(), ridge.direction, ridge.parameter), ("face:1", 0, 1.0));
    let point = |u: f64| {
        let at = |u: f64, v: f64| model.evaluate(ridge.face.into(), [u, v]).unwrap().point();
        (at(u + 1e-4, 0.9) - at(u, 0.9)).cross(at(u, 0.9 + 1e-4) - at(u, 0.9))
    };
    let angle = point(1.0 - 1.1e-4).angle_between(point(1.0));
    assert!((ridge.angle - angle).abs() < 1e-3 * angle && (ridge.place.x - 2.0).abs() < 1e-12, "{ridge}, not {angle}");
    let doubled: Vec<String> = model.duplicate_faces().iter().flatten().map(ToString::to_string).collect();
    assert_eq!(doubled, ["face:3", "face:8"]);

    let told = shape("lemon.step").health().warnings;
    assert!(told.iter().any(|told| told.contains("bounded by a vertex alone")), "{told:?}");

    for smooth in [fixture("weeble/weeble.step"), fixture("torus/torus.step"), fixture("wing_sharp/wing_sharp.step")] {
        assert!(smooth.health().creases.is_empty() && smooth.duplicate_faces().is_empty(), "{:?}", smooth.path());
    }
}

/// The corner of a box moved away by a millimetre: edges and surfaces no longer meet.
#[test]
fn moved_boundaries_are_told() {
    let text = std::fs::read_to_string(crate::common::shape_path("plate.brep")).unwrap();
    let healthy = shape("plate.brep").health();
    assert!(healthy.trims.is_empty());
    // the first straight curve of the shape, moved sideways
    let line = text.lines().position(|line| line.starts_with("Curves ")).unwrap() + 1;
    let moved: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(i, l)| if i == line { l.replacen(" 0 0 0 ", " 0 0.5 0.5 ", 1) } else { l.to_owned() })
        .collect();
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("moved.brep");
    std::fs::write(&path, moved.join("\n")).unwrap();
    let health = Model::read(&path, &options()).unwrap().health();
    assert!(!health.trims.is_empty(), "{}", moved[line]);
    assert!(health.trims[0].1.to_string().contains("away from the surface"), "{:?}", health.trims);
}

/// A cylinder of half an annulus with another radius: below zero OCCT drops the face, at zero it keeps it far from its edges.
#[test]
fn dropped_and_shrunken_faces_are_told() {
    let text = std::fs::read_to_string(crate::common::path("cylinder_bl/cylinder_bl.step")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let at = text.find("CYLINDRICAL_SURFACE(").unwrap();
    let surface: String = text[..at].rsplit('#').next().unwrap().chars().take_while(char::is_ascii_digit).collect();
    let face =
        text.lines().find(|line| line.contains("ADVANCED_FACE") && line.contains(&format!("#{surface},"))).unwrap();
    let id = format!("step:{}", face.split(' ').next().unwrap());
    let end = at + text[at..].find(");").unwrap();
    let radius = at + text[at..end].rfind(',').unwrap() + 1;
    let read = |value: &str| {
        let path = dir.path().join(format!("{value}.step"));
        std::fs::write(&path, format!("{}{value}{}", &text[..radius], &text[end..])).unwrap();
        Model::read(&path, &options()).unwrap()
    };
    let negative = read("-0.5");
    let health = negative.health();
    assert_eq!(health.dropped, [id.as_str()]);
    assert!(!health.open_edges.is_empty() && negative.losses().is_some_and(|told| told.contains(&id)), "{health:?}");
    let zero = read("0.");
    let health = zero.health();
    let shrunken = zero.resolve(&id).unwrap();
    assert!(health.trims.iter().any(|(face, _)| shrunken == [(*face).into()]), "{health:?}");
}

/// An entity that OCCT dies of is named in the error.
#[test]
fn a_crash_names_the_suspects() {
    let text = std::fs::read_to_string(crate::common::path("weeble/weeble.step")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("dangling.step");
    let at = text.find("CARTESIAN_POINT").unwrap();
    let id: String = text[..at].rsplit('#').next().unwrap().chars().take_while(char::is_ascii_digit).collect();
    std::fs::write(&path, text.replacen(&format!("#{id} = CARTESIAN_POINT("), "#987654 = CARTESIAN_POINT(", 1))
        .unwrap();
    match Model::read(&path, &options()) {
        Err(error @ ReadError::Crashed { .. }) => assert!(error.to_string().contains("step:#"), "{error}"),
        Err(error) => assert!(error.to_string().contains("dangling.step"), "{error}"),
        Ok(model) => assert!(model.losses().is_some_and(|told| told.contains("step:#")), "nothing was said"),
    }
}

/// The same plate sewn (BREP) and in surface mode (IGES): as many edges between two faces, and at the same places.
#[test]
fn edges_between_unsewn_faces_resolve() {
    let (sewn, unsewn) = (shape("plate.brep"), shape("unsewn.igs"));
    assert_eq!(sewn.faces().len(), unsewn.faces().len());
    let real = sewn.edges().iter().filter(|edge| edge.faces.len() == 2 || edge.seam);
    assert_eq!(unsewn.sewing().merged.len(), real.count());
    let mut pairs = 0;
    for a in 1..=unsewn.faces().len() {
        for b in a..=unsewn.faces().len() {
            let Ok(edges) = unsewn.resolve(&format!("faces:{a}|{b}")) else { continue };
            pairs += edges.len();
            for id in edges {
                let cad::EntityId::Edge(id) = id else { panic!("{id}") };
                assert_eq!(unsewn.sewing().same_as(id).len(), 2);
                let group = cad::Group::of_edges(&unsewn, &[id]).unwrap();
                let twin = unsewn.edge(unsewn.sewing().same_as(id)[1]).unwrap();
                let middle =
                    group.evaluate(twin.id.into(), [0.5 * (twin.parameters[0] + twin.parameters[1]), 0.0]).unwrap();
                assert!(group.distance(middle.point()) < 1e-6);
            }
        }
    }
    assert_eq!(pairs, unsewn.sewing().merged.len());
}

/// Two faces above one: the rim of the lower one is the two lower rims of the upper ones, taken together.
#[test]
fn one_edge_may_be_two_pieces() {
    let model = shape("pieces.igs");
    let sewing = model.sewing();
    let sets: Vec<usize> = sewing.merged.iter().map(Vec::len).collect();
    assert_eq!((sets, sewing.open.len()), (vec![3, 2], 12 - 5), "{sewing:?}");
    let edges = |reference: &str| model.resolve(reference).unwrap();
    let (left, right) = (edges("faces:1|2"), edges("faces:1|3"));
    assert_eq!((left.len(), right.len(), edges("faces:2|3").len()), (1, 1, 1));
    for (piece, face) in [(left[0], 1), (right[0], 2)] {
        let cad::EntityId::Edge(id) = piece else { panic!("{piece}") };
        assert_eq!(model.edge(id).unwrap().faces, [cad::FaceId::new(face)], "the piece, not the whole rim");
        assert_eq!(sewing.same_as(id).len(), 3);
    }
}
