//! Reading files: counts, order, units, references, and what bad files get.

use crate::common::{by, fixture, options, reader};
use cad::{EdgeId, EntityId, FaceId, Group, Kind, Model, ReadError, ReadOptions, Reader, SourceFormat};
use std::os::unix::fs::PermissionsExt;
use std::time::Duration;

#[test]
fn weeble_has_the_numbers_of_its_mesh() {
    let model = fixture("weeble/weeble.step");
    assert_eq!(model.format(), SourceFormat::Step);
    assert_eq!((model.faces().len(), model.edges().len(), model.vertices().len()), (4, 10, 6));
    assert_eq!(model.face(FaceId::new(0)).unwrap().kind, Kind::Sphere);
    let degenerate: Vec<u32> = model.edges().iter().filter(|e| e.degenerate).map(|e| e.id.tag()).collect();
    assert!(degenerate.contains(&2), "edge 2 is a pole: {degenerate:?}");
    assert!(model.edge(EdgeId::new(0)).unwrap().seam);
    assert_eq!(model.unit().metres, Some(0.001));
}

#[test]
fn formats_agree() {
    for case in ["weeble/weeble", "torus/torus", "wing_sharp/wing_sharp"] {
        let (step, iges) = (fixture(&format!("{case}.step")), fixture(&format!("{case}.igs")));
        assert_eq!(step.faces().len(), iges.faces().len(), "{case}");
        let (a, b) = (step.bounds(), iges.bounds());
        let apart = a.min.distance(b.min).max(a.max.distance(b.max));
        assert!(apart < 1e-3 * step.diagonal(), "{case}: boxes {a:?} {b:?}");
    }
}

#[test]
fn references_resolve() {
    let model = fixture("weeble/weeble.step");
    let face = |i| vec![EntityId::Face(FaceId::new(i))];
    assert_eq!(model.resolve("face:2").unwrap(), face(1));
    assert_eq!(model.resolve("face-2").unwrap(), face(1));
    let reference = &model.face(FaceId::new(1)).unwrap().label.reference;
    assert!(reference.starts_with("step:#"), "{reference:?}");
    assert_eq!(model.resolve(reference).unwrap(), face(1));
    let shared = model.resolve("faces:2|3").unwrap();
    assert_eq!(shared.len(), 1);
    for bad in ["", "face", "face:0", "face:5", "name:nobody", "step:#999999", "wing", "faces:1|2", "edge:-1"] {
        assert!(model.resolve(bad).is_err(), "{bad:?}");
    }
}

/// A group of an IGES file, of faces or of free curves, by its reference; one without a name has no other.
#[test]
fn groups_of_the_file_are_ready_groups() {
    for (name, kind, count) in [("unsewn.igs", "face", 7), ("curves.igs", "edge", 3)] {
        let model = crate::common::shape(name);
        let [group] = model.groups() else { panic!("{:?}", model.groups()) };
        assert!(group.reference.starts_with("iges:D") && group.members.len() == count, "{group:?}");
        assert!(group.members.iter().all(|member| member.to_string().starts_with(kind)), "{group:?}");
        assert_eq!(model.resolve(&group.reference).unwrap(), group.members);
    }
}

/// `group:` takes all entities of one name, `name:` only what has the name to itself.
#[test]
fn names_that_several_have_are_ready_groups() {
    let text = std::fs::read_to_string(crate::common::path("weeble/weeble.step")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("named.step");
    let mut parts: Vec<String> = text.split("ADVANCED_FACE('").map(str::to_owned).collect();
    for (part, name) in parts[1..].iter_mut().zip(["BODY", "BODY", "FAR FIELD"]) {
        part.insert_str(0, name);
    }
    std::fs::write(&path, parts.join("ADVANCED_FACE('")).unwrap();
    let model = Model::read(&path, &options()).unwrap();
    let body = model.resolve("group:BODY").unwrap();
    assert_eq!(body.len(), 2);
    match model.resolve("name:BODY") {
        Err(error @ cad::ReferenceError::Ambiguous { .. }) => {
            let told = error.to_string();
            assert!(body.iter().all(|id| told.contains(&id.to_string())) && told.contains("group:"), "{told}");
            assert!(told.contains("named.step"), "{told}");
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(model.resolve("name:\"FAR FIELD\"").unwrap().len(), 1);
    let told = model.resolve("group:WING").unwrap_err().to_string();
    assert!(told.contains("named groups: BODY"), "{told}");
}

#[test]
fn scale_moves_coordinates_and_tolerances_but_not_the_unit() {
    for name in ["weeble/weeble.step", "weeble/weeble.igs"] {
        let plain = fixture(name);
        let scaled = Model::read(&crate::common::path(name), &ReadOptions { scale: 0.001, ..options() }).unwrap();
        assert_eq!(plain.unit(), scaled.unit());
        assert!((scaled.diagonal() / plain.diagonal() - 0.001).abs() < 1e-12, "{name}");
        for (a, b) in plain.faces().iter().zip(scaled.faces()) {
            assert!((b.tolerance / a.tolerance - 0.001).abs() < 1e-9 && a.label == b.label, "{name} {}", a.id);
        }
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = Model::read(&crate::common::path(name), &ReadOptions { scale, ..options() });
            assert!(matches!(error, Err(ReadError::Scale { .. })), "{scale}");
        }
    }
}

/// A unit with a name of its own is told by its conversion factor.
#[test]
fn an_unknown_unit_is_what_its_factor_says() {
    const MILLIMETRE: &str = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );";
    let mut text = std::fs::read_to_string(crate::common::path("weeble/weeble.step")).unwrap();
    for number in 9000.. {
        let Some(at) = text.find(MILLIMETRE).filter(|_| number < 9030) else { break };
        let odd = format!(
            "( CONVERSION_BASED_UNIT('ODDUNIT',#{number}1) LENGTH_UNIT() NAMED_UNIT(#{number}2) );\n\
             #{number}2 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n\
             #{number}1 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(12.5),#{number}3);\n\
             #{number}3 = ( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI., .METRE.) );"
        );
        text.replace_range(at..at + MILLIMETRE.len(), &odd);
    }
    let file = tempfile::NamedTempFile::with_suffix(".step").unwrap();
    std::fs::write(file.path(), text).unwrap();
    let (odd, plain) = (Model::read(file.path(), &options()).unwrap(), fixture("weeble/weeble.step"));
    assert_eq!(odd.unit().metres, Some(0.0125));
    assert!((odd.diagonal() / plain.diagonal() - 1.0).abs() < 1e-12, "coordinates are those of the file");
}

#[test]
fn bad_files_get_errors() {
    let dir = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = dir.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let step = std::fs::read(crate::common::path("weeble/weeble.step")).unwrap();
    let iges = std::fs::read(crate::common::path("weeble/weeble.igs")).unwrap();
    let cut = |bytes: &[u8], percent: usize| bytes[..bytes.len() * percent / 100].to_vec();
    for (name, bytes) in [
        ("empty.step", Vec::new()),
        ("garbage.step", b"not a CAD file at all".to_vec()),
        ("zeros.igs", vec![0; 4000]),
        ("cut.step", cut(&step, 50)),
        ("head.step", cut(&step, 2)),
        ("cut.igs", cut(&iges, 20)),
        ("words.brep", b"DBRep_DrawableShape\nCASCADE Topology V1\nnonsense".to_vec()),
    ] {
        let path = write(name, &bytes);
        let error = Model::read(&path, &options()).expect_err(name);
        assert!(error.to_string().contains(name), "{error}");
    }
    assert!(matches!(Model::read(&dir.path().join("absent.step"), &options()), Err(ReadError::Open { .. })));
}

/// Without a reader no child is started: the same model, also when several threads read at once, and the same words where it is refused.
#[test]
fn this_process_reads_what_the_child_does() {
    let names = ["weeble/weeble.step", "weeble/weeble.igs", "wing_sharp/wing_sharp.step"];
    let feet = |model: &Model| {
        let all: Vec<FaceId> = model.faces().iter().map(|face| face.id).collect();
        let group = Group::of_faces(model, &all).unwrap();
        let middles: Vec<_> = model.faces().iter().map(|face| face.bounds.center()).collect();
        group.closest_batch(&middles, &mut [])
    };
    std::thread::scope(|scope| {
        for name in names {
            scope.spawn(move || {
                let path = crate::common::path(name);
                let [here, there] = [ReadOptions::default(), options()]
                    .map(|options| Model::read(&path, &ReadOptions { scale: 0.25, ..options }).unwrap());
                assert_eq!(format!("{:?}", here.faces()), format!("{:?}", there.faces()), "{name}");
                assert_eq!(format!("{:?}", here.edges()), format!("{:?}", there.edges()), "{name}");
                assert_eq!(format!("{:?}", here.vertices()), format!("{:?}", there.vertices()), "{name}");
                assert_eq!((here.unit(), here.groups(), here.losses()), (there.unit(), there.groups(), there.losses()));
                assert_eq!(feet(&here), feet(&there), "{name}");
            });
        }
    });
    let dir = tempfile::tempdir().unwrap();
    let cut = dir.path().join("cut.step");
    let text = std::fs::read(crate::common::path("weeble/weeble.step")).unwrap();
    std::fs::write(&cut, &text[..text.len() / 2]).unwrap();
    let [here, there] = [ReadOptions::default(), options()].map(|options| Model::read(&cut, &options).unwrap_err());
    assert_eq!(here.to_string(), there.to_string());
}

#[test]
fn crash_and_hang_of_the_child_are_errors() {
    let path = crate::common::path("weeble/weeble.step");
    let crashing = by(Reader::new("/bin/false"));
    assert!(matches!(Model::read(&path, &crashing), Err(ReadError::Crashed { .. })));
    let absent = by(Reader::new("/nowhere/reader"));
    assert!(matches!(Model::read(&path, &absent), Err(ReadError::Reader { .. })));
    let hasty = by(Reader { timeout: Duration::ZERO, ..reader() });
    assert!(matches!(Model::read(&path, &hasty), Err(ReadError::TimedOut { .. })));
    let poor = by(Reader { memory_limit: 40 << 20, ..reader() });
    assert!(Model::read(&path, &poor).is_err());
}

/// OCCT reads such poles without a word.
#[test]
fn poles_that_are_no_numbers_are_refused_by_entity() {
    let text = std::fs::read_to_string(crate::common::shape_path("kinds.brep")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let pole = "0.54574911354964839";
    let places: Vec<usize> = text.match_indices(pole).map(|(at, _)| at).collect();
    assert!(places.len() > 1, "the surface itself and the basis of its offset");
    for (i, number) in ["nan", "inf", "1e999", "-1e200"].iter().cycle().take(4 * places.len()).enumerate() {
        let at = places[i / 4];
        let path = dir.path().join(format!("{i}.brep"));
        std::fs::write(&path, format!("{}{number}{}", &text[..at], &text[at + pole.len()..])).unwrap();
        let told = Model::read(&path, &options()).expect_err(number).to_string();
        assert!(told.contains(&format!("{i}.brep")) && told.contains("face:") && told.contains("coordinate"), "{told}");
    }
}

/// What the child warned of before it hung is the likely cause.
#[test]
fn a_hang_names_the_suspects() {
    let dir = tempfile::tempdir().unwrap();
    let reader = dir.path().join("reader");
    std::fs::write(&reader, "#!/bin/sh\necho 'sagitta-warning step:#15: malformed' >&2\nexec sleep 60\n").unwrap();
    std::fs::set_permissions(&reader, std::fs::Permissions::from_mode(0o755)).unwrap();
    let hanging = by(Reader { timeout: Duration::from_secs(2), ..Reader::new(reader) });
    let error = Model::read(&crate::common::path("weeble/weeble.step"), &hanging).unwrap_err();
    assert!(matches!(error, ReadError::TimedOut { .. }), "{error}");
    assert!(error.to_string().contains("step:#15: malformed"), "{error}");
}

/// Numbers of BREP files are counts of what follows; OCCT reads on behind the end of the file.
#[test]
fn a_hang_in_brep_names_the_line() {
    let text = std::fs::read_to_string(crate::common::shape_path("plate.brep")).unwrap();
    let count = text.lines().find(|line| line.starts_with("Surfaces ")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("count.brep");
    std::fs::write(&path, text.replacen(count, "Surfaces 2000000000", 1)).unwrap();
    let hasty = by(Reader { timeout: Duration::from_secs(2), ..reader() });
    let told = Model::read(&path, &hasty).unwrap_err().to_string();
    assert!(told.contains("count.brep") && told.contains("line "), "{told}");
}

/// An entity that refers to a missing one makes OCCT 7.6 dereference null.
#[test]
fn dangling_references_do_not_end_the_parent() {
    let text = std::fs::read_to_string(crate::common::path("weeble/weeble.step")).unwrap();
    let dir = tempfile::tempdir().unwrap();
    for (i, word) in ["CARTESIAN_POINT", "VERTEX_POINT", "ADVANCED_FACE", "DIRECTION", "EDGE_LOOP"].iter().enumerate() {
        let path = dir.path().join(format!("{i}.step"));
        std::fs::write(&path, text.replacen(&format!("= {word}("), "= NOTHING(", 3)).unwrap();
        if let Err(error) = Model::read(&path, &options()) {
            assert!(error.to_string().contains(&format!("{i}.step")), "{error}");
        }
    }
}

/// Cycles, self-references, numbers that are none: an error that names the file, or a model, within the time limit.
#[test]
fn cyclic_and_self_referring_files_end_in_time() {
    let weeble = std::fs::read_to_string(crate::common::path("weeble/weeble.step")).unwrap();
    let assembly = std::fs::read_to_string(crate::common::shape_path("assembly.step")).unwrap();
    let edited = |text: &str, word: &str, edit: &dyn Fn(&str) -> String| -> String {
        let lines = text.split(";\n").map(|line| if line.contains(word) { edit(line) } else { line.to_owned() });
        lines.collect::<Vec<_>>().join(";\n")
    };
    // every usage uses the whole in itself
    let usages: Vec<&str> = assembly.split(";\n").filter(|line| line.contains("NEXT_ASSEMBLY_USAGE")).collect();
    let whole = usages[0].rsplit('#').nth(1).unwrap().split(',').next().unwrap();
    let cyclic = edited(&assembly, "NEXT_ASSEMBLY_USAGE", &|line| {
        let (head, _) = line.rsplit_once('#').unwrap();
        format!("{head}#{whole},$)")
    });
    // a placement whose origin is itself
    let axis = weeble.split(";\n").find(|line| line.contains("= AXIS2_PLACEMENT_3D(")).unwrap();
    let [own, origin] = [1, 2].map(|k| axis.split('#').nth(k).unwrap().split([' ', ',']).next().unwrap());
    let narcissus = weeble.replacen(axis, &axis.replacen(&format!("#{origin},"), &format!("#{own},"), 1), 1);
    let point = |value: &str| {
        let at = weeble.find("CARTESIAN_POINT('',(").unwrap() + "CARTESIAN_POINT('',(".len();
        let end = at + weeble[at..].find(')').unwrap();
        format!("{}{value},{value},{value}{}", &weeble[..at], &weeble[end..])
    };
    let files =
        [("cyclic.step", cyclic), ("self.step", narcissus), ("nan.step", point("NAN")), ("huge.step", point("1.E999"))];
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = dir.path().join(name);
        assert!(text != weeble && text != assembly, "{name} is spoilt");
        std::fs::write(&path, text).unwrap();
        let start = std::time::Instant::now();
        let limit = Duration::from_secs(5);
        let outcome = Model::read(&path, &by(Reader { timeout: limit, ..reader() }));
        // the parent assembles what the child did; the machine may be busy
        assert!(start.elapsed() < 3 * limit, "{name}: {:?}", start.elapsed());
        match outcome {
            Err(error) if name == "huge.step" => {
                let told = error.to_string();
                assert!(
                    told.contains("huge.step") && told.contains("step:#") && told.contains("not a finite"),
                    "{told}"
                );
            }
            Err(error) => assert!(error.to_string().contains(name), "{error}"),
            Ok(model) => assert!(name != "huge.step" && model.diagonal().is_finite(), "{name}: {model:?}"),
        }
    }
}
