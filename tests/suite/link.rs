//! `sagitta link`: what is inferred without entity tags is what the generator knew.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::common::random::Random;
use crate::common::{fixture, json, root, sagitta};
use linkage_schema::{Entity, Resolution, resolve};
use sagitta::element::Cell;
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{Boundary, EntityKey, Mesh};

const CASES: [&str; 6] = ["weeble", "weeble_hybrid", "wing_sharp", "sphere_shell", "cylinder_bl", "torus"];

/// The mesh as a generator without CAD numbers writes it: one entity a physical name, no points or lines.
fn without_tags(mesh: Mesh) -> Mesh {
    let mut names: BTreeMap<Vec<String>, i32> = BTreeMap::new();
    let keys: BTreeSet<EntityKey> = mesh.blocks().iter().map(|block| block.entity).collect();
    // Far from any number of a CAD entity.
    let key = |names: &mut BTreeMap<Vec<String>, i32>, key: EntityKey| {
        let count = names.len() as i32;
        EntityKey::new(key.dimension, *names.entry(mesh.names_of(key)).or_insert(9001 + count))
    };
    let new: BTreeMap<EntityKey, EntityKey> = keys.into_iter().map(|old| (old, key(&mut names, old))).collect();
    let mut parts = mesh.into_parts();
    parts.blocks.retain(|block| block.cell.dimension() >= 2);
    parts.blocks.iter_mut().for_each(|block| block.entity = new[&block.entity]);
    let mut seen = BTreeSet::new();
    parts.entities.retain_mut(|entity| {
        let Some(&key) = new.get(&entity.key).filter(|key| key.dimension >= 2) else { return false };
        entity.key = key;
        entity.boundary.clear();
        seen.insert(key)
    });
    parts.node_entities.fill(None);
    parts.node_parameters.clear();
    parts.periodic.clear();
    Mesh::new(parts).unwrap()
}

/// Items by their nodes, each with the names of its CAD entities.
type Links = BTreeMap<Vec<u32>, BTreeSet<String>>;

fn names(entities: &[Entity<'_>]) -> BTreeSet<String> {
    entities.iter().map(|entity| entity.reference.to_owned()).collect()
}

fn sorted(indices: &[u32]) -> Vec<u32> {
    let mut key = indices.to_vec();
    key.sort_unstable();
    key
}

/// Faces, edges and points of a document; strings on seams and degenerate edges, which the generator marks, left out.
fn links(resolution: &Resolution<'_>) -> [Links; 3] {
    let [mut faces, mut edges, mut points]: [Links; 3] = Default::default();
    let feature = |entity: &Entity<'_>| !matches!(entity.name, Some("seam" | "degenerate"));
    for model in &resolution.models {
        for link in model.sheets.iter().flat_map(|sheet| &sheet.faces) {
            link.run.faces().for_each(|face| drop(faces.insert(sorted(face), names(link.entities()))));
        }
        for link in model.strings.iter().flat_map(|string| &string.edges) {
            if link.entities().iter().all(feature) {
                link.run.edges().for_each(|edge| drop(edges.insert(sorted(&edge), names(link.entities()))));
            }
        }
        for link in &model.points {
            link.run.indices.iter().for_each(|&index| drop(points.insert(vec![index], names(link.entities()))));
        }
    }
    [faces, edges, points]
}

/// Links a mesh and returns its folder, the written file and the report.
fn link(case: &Path, mesh: &Mesh, more: &[&str]) -> (tempfile::TempDir, PathBuf, serde_json::Value) {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("mesh.msh");
    formats::write(&file, mesh, &WriteOptions::default()).unwrap();
    let (output, report) = link_file(case, &file, more);
    (dir, output, report)
}

/// Links a mesh file and returns what is written beside it, and the report.
fn link_file(case: &Path, file: &Path, more: &[&str]) -> (PathBuf, serde_json::Value) {
    let [output, report] = ["link.xml", "report.json"].map(|name| file.with_file_name(name));
    let cad = case.with_extension("step");
    let arguments = args!["link", file, "--cad", cad, "-o", output, "--report", report];
    let outcome = sagitta(arguments.into_iter().chain(more.iter().map(std::ffi::OsString::from)));
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    let validation = sagitta(args!["validate", output, "--mesh", file, "--cad", cad, "--strict"]);
    assert_eq!(validation.code, Some(0), "{}: {}", case.display(), validation.stdout);
    (output, json(&report))
}

/// Checks a case and returns the counts of faces: all, undecided.
fn compare(case: &Path) -> [usize; 2] {
    let name = case.display();
    let mut mesh = formats::read(&case.with_extension("msh")).unwrap();
    let parts: BTreeSet<EntityKey> = mesh.side_blocks().map(|block| block.entity).collect();
    mesh = without_tags(mesh);
    let merged: BTreeSet<EntityKey> = mesh.side_blocks().map(|block| block.entity).collect();
    assert!(merged.len() <= parts.len() && merged.iter().all(|key| key.tag > 9000), "{name}");
    let (_dir, output, report) = link(case, &mesh, &[]);
    assert_eq!(report["source"], "geometry");
    let own = linkage_schema::read_path(&output).unwrap().accept().unwrap();
    let generators = linkage_schema::read_path(&case.with_extension("meshlink.xml")).unwrap().accept().unwrap();
    let [own_faces, own_edges, own_points] = links(&resolve(&own));
    let [faces, edges, points] = links(&resolve(&generators));
    let wrong: Vec<_> = own_faces.iter().filter(|(face, on)| faces.get(*face) != Some(on)).collect();
    assert!(wrong.is_empty(), "{name}: {} faces wrong: {:?}", wrong.len(), &wrong[..wrong.len().min(5)]);
    let undecided = faces.len() - own_faces.len();
    assert!((undecided as f64) < 0.005 * faces.len() as f64, "{name}: {undecided} of {} undecided", faces.len());
    assert_eq!(own_edges, edges, "{name}: edges");
    let strays: Vec<_> = own_points.iter().filter(|(point, on)| points.get(*point) != Some(on)).collect();
    assert!(strays.is_empty(), "{name}: points {strays:?}");
    // The generator names vertices on seams too; every vertex at which edges meet or end must be there.
    let mut ends: BTreeMap<u32, BTreeSet<&BTreeSet<String>>> = BTreeMap::new();
    for (edge, on) in &edges {
        for &end in edge {
            ends.entry(end).or_default().insert(on);
        }
    }
    for (corner, _) in ends.iter().filter(|(_, meeting)| meeting.len() > 1) {
        assert!(own_points.contains_key(&vec![*corner]), "{name}: no vertex at node {corner}");
    }
    [faces.len(), undecided]
}

#[test]
fn inferred_without_tags_is_what_the_generator_knew() {
    for case in CASES {
        let [all, undecided] = compare(&fixture(case, "msh").with_extension(""));
        assert_eq!(undecided, 0, "{case}: of {all}");
    }
}

/// All cases of `make_cases.py` that lie in the folders below `SAGITTA_CASES`.
#[test]
fn so_it_is_for_every_case_that_was_made() {
    let Some(folder) = std::env::var_os("SAGITTA_CASES").filter(|folder| !folder.is_empty()) else {
        crate::common::warn("SAGITTA_CASES is not set: only the fixtures are compared");
        return;
    };
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir()) {
        for file in std::fs::read_dir(entry).unwrap().map(|file| file.unwrap().path()) {
            if file.extension().is_some_and(|e| e == "msh") && file.with_extension("meshlink.xml").exists() {
                let [all, undecided] = compare(&file.with_extension(""));
                println!("{}: {undecided} of {all} faces undecided, 0 wrong", file.display());
                count += 1;
            }
        }
    }
    assert!(count > 0, "SAGITTA_CASES holds no case");
}

#[test]
fn tags_are_used_where_they_hold() {
    let case = fixture("weeble", "msh").with_extension("");
    let mesh = formats::read(&case.with_extension("msh")).unwrap();
    assert_eq!(link(&case, &mesh, &[]).2["source"], "the mesh's entity tags");
    assert_eq!(link(&case, &mesh, &["--ignore-tags"]).2["source"], "geometry");
}

#[test]
fn a_mesh_of_other_cad_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("link.xml");
    let outcome =
        sagitta(args!["link", fixture("torus", "msh"), "--cad", fixture("cylinder_bl", "step"), "-o", output]);
    assert_eq!(outcome.code, Some(2), "{}", outcome.stdout);
    assert!(outcome.stderr.contains("torus.msh") && outcome.stderr.contains("--tolerance"), "{}", outcome.stderr);
    assert!(!output.exists());
}

/// Faces of IGES files are not sewn: every edge and vertex is there once for each face.
#[test]
fn unsewn_iges_is_as_good() {
    for case in CASES {
        let path = fixture(case, "msh").with_extension("");
        let mut mesh = formats::read(&fixture(case, "msh")).unwrap();
        mesh = without_tags(mesh);
        let (dir, output, report) = link(&path, &mesh, &[]);
        let iges = dir.path().join("iges.xml");
        let [file, cad] = [dir.path().join("mesh.msh"), fixture(case, "igs")];
        sagitta(args!["link", file, "--cad", cad, "-o", iges, "--report", dir.path().join("iges.json")]).expect(0);
        sagitta(args!["validate", iges, "--mesh", file, "--cad", cad, "--strict"]).expect(0);
        let [step, iges] = [output, iges].map(|path| linkage_schema::read_path(&path).unwrap().accept().unwrap());
        let ([faces, edges, points], [own_faces, own_edges, own_points]) =
            (links(&resolve(&step)), links(&resolve(&iges)));
        // Faces have the same numbers in both files, edges and vertices have not.
        assert_eq!(own_faces, faces, "{case}");
        let on = |links: &Links| links.keys().cloned().collect::<BTreeSet<_>>();
        assert_eq!((on(&own_edges), on(&own_points)), (on(&edges), on(&points)), "{case}");
        assert_eq!(json(&dir.path().join("iges.json"))["undecided"], report["undecided"]);
    }
}

/// A linkage that calls its sheets by the mesh file's physical names.
#[test]
fn sheets_by_name_are_used() {
    let dir = tempfile::tempdir().unwrap();
    let [linkage, output, report] = ["link.xml", "out.msh", "report.json"].map(|name| dir.path().join(name));
    let sheet = |name: &str, gref: u32| format!("<MeshSheetReference name=\"{name}\" ref=\"{name}\" gref=\"{gref}\"/>");
    let text = format!(
        "<MeshLink version=\"1.0\" xmlns=\"https://cadence.com\"><GeometryFile filename=\"torus.step\">\
         <GeometryReference gid=\"1\" ref=\"face-1\"/><GeometryReference gid=\"2\" ref=\"face-2\"/></GeometryFile>\
         <MeshFile filename=\"torus.msh\"><MeshModelReference ref=\"m\">{}{}{}</MeshModelReference></MeshFile></MeshLink>",
        sheet("farfield", 1),
        sheet("wall", 2),
        sheet("nothing", 2)
    );
    std::fs::write(&linkage, text).unwrap();
    let mut mesh = formats::read(&fixture("torus", "msh")).unwrap();
    mesh = without_tags(mesh);
    let file = dir.path().join("torus.msh");
    formats::write(&file, &mesh, &WriteOptions::default()).unwrap();
    let cad = fixture("torus", "step");
    let arguments = args![
        "curve",
        file,
        "--cad",
        cad,
        "--order",
        "2",
        "-q",
        "-o",
        output,
        "--linkage",
        linkage,
        "--report",
        report
    ];
    let told = sagitta(arguments).expect(0).stdout;
    assert!(told.contains("\"nothing\" by name"), "{told}");
    let patches = &json(&report)["patches"];
    assert!(
        patches.as_array().unwrap().iter().all(|patch| patch["cad_groups"].as_array().unwrap().len() == 1),
        "{patches:#}"
    );
    let validated = sagitta(args!["validate", linkage, "--mesh", file, "--cad", cad]).expect(0).stdout;
    assert!(validated.contains("note ML411") && validated.contains("clean, 1 notes"), "{validated}");
}

/// Four elements along the chord of a plate of 0.5 %, cambered by 12 %: the middles of its edges are nearer to the other side.
#[test]
fn a_thin_cambered_plate_goes_to_its_own_side() {
    let case = root().join("fixtures/plate/plate");
    let mesh = formats::read(&case.with_extension("msh")).unwrap();
    let boundary = Boundary::new(&mesh);
    let tags: Vec<EntityKey> = boundary.faces.iter().map(|face| face.entity).collect();
    let mut untagged = mesh.clone();
    untagged = without_tags(untagged);
    let (_dir, output, report) = link(&case, &untagged, &[]);
    assert_eq!(report["undecided"].as_array().unwrap().len(), 0, "{report:#}");
    let own = linkage_schema::read_path(&output).unwrap().accept().unwrap();
    let [faces, edges, points] = links(&resolve(&own));
    assert_eq!(faces.len(), boundary.faces.len());
    for (face, entity) in tags.iter().enumerate() {
        // Node numbers are places in the file, counted from 1.
        let nodes: Vec<u32> = boundary.corners[face].iter().map(|n| n.index() as u32 + 1).collect();
        assert_eq!(faces[&sorted(&nodes)], BTreeSet::from([format!("face-{}", entity.tag)]), "{nodes:?}");
    }
    let lines = mesh.elements_of(Cell::Line).len();
    let corners = mesh.elements_of(Cell::Point).len();
    assert_eq!((edges.len(), points.len()), (lines, corners));

    // It is the trap that it candidates to be: the sides are the faces with most elements but those of the box.
    let at = |n: usize| mesh.points()[n];
    let arc = |x: f64, height: f64| {
        let radius = (0.25 + height * height) / (2.0 * height);
        height - radius + (radius * radius - (x - 0.5) * (x - 0.5)).sqrt()
    };
    let mut nearer_to_the_other = 0;
    for &[a, b] in &boundary.edges {
        let [a, b] = [at(a.index()), at(b.index())];
        let off = |x: glam::DVec3, height: f64| (x.z - arc(x.x, height)).abs();
        let on_upper = |x: glam::DVec3| (0.0..=1.0).contains(&x.x) && off(x, 0.12) < 1e-9;
        if on_upper(a) && on_upper(b) && (a.x - b.x).abs() > 0.1 {
            let middle = 0.5 * (a + b);
            nearer_to_the_other += usize::from(off(middle, 0.115) < off(middle, 0.12));
        }
    }
    assert!(nearer_to_the_other >= 10, "{nearer_to_the_other}");
}

/// Noise of 1e-6, and coordinates of single precision: validated, linked by geometry, curved, and the offsets told.
#[test]
fn linear_nodes_off_the_cad() {
    let case = fixture("weeble", "msh").with_extension("");
    let good = formats::read(&case.with_extension("msh")).unwrap();
    let mut random = Random(1);
    let mut shaken = good.clone();
    shaken.points_mut().iter_mut().for_each(|x| *x += 1e-6 * random.vector());
    for (name, mut mesh, [least, most]) in [("mesh.msh", shaken, [1e-7, 2e-6]), ("mesh.b4.ugrid", good, [1e-9, 1e-6])] {
        mesh = without_tags(mesh);
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join(name);
        match name {
            "mesh.msh" => _ = formats::write(&file, &mesh, &WriteOptions::default()).unwrap(),
            _ => crate::common::ugrid::write_b4(&file, &mesh),
        }
        let (output, report) = link_file(&case, &file, &[]);
        assert_eq!(report["undecided"].as_array().unwrap().len(), 0, "{name}: {report:#}");
        let own = linkage_schema::read_path(&output).unwrap().accept().unwrap();
        let generators = linkage_schema::read_path(&case.with_extension("meshlink.xml")).unwrap().accept().unwrap();
        let ([faces, edges, _], [known, strings, _]) = (links(&resolve(&own)), links(&resolve(&generators)));
        assert!(faces == known && edges == strings, "{name}");
        let farthest = |list: &serde_json::Value, key: &str| {
            list.as_array().unwrap().iter().map(|item| item[key].as_f64().unwrap()).fold(0.0, f64::max)
        };
        let told = farthest(&report["patches"], "cad_distance_max");
        assert!((least..most).contains(&told), "{name}: {told:e}");
        let [curved, figures] = ["curved.msh", "figures.json"].map(|file| dir.path().join(file));
        let cad = case.with_extension("step");
        let arguments = args![
            "curve",
            file,
            "--cad",
            cad,
            "--linkage",
            output,
            "--order",
            "2",
            "-q",
            "-o",
            curved,
            "--report",
            figures
        ];
        sagitta(arguments).expect(0);
        let offset = farthest(&json(&figures)["patches"], "node_move_max");
        assert!((offset / told - 1.0).abs() < 1e-3, "{name}: {offset:e} {told:e}");
        let validated = sagitta(args!["validate", output, "--mesh", file, "--cad", cad, "--json"]).expect(0).stdout;
        let validated: serde_json::Value = serde_json::from_str(&validated).unwrap();
        assert!((farthest(&validated["sheets"], "cad_distance_max") / told - 1.0).abs() < 1e-3, "{name}");
    }
}

/// Faces of higher order have more nodes than corners, and a linkage file could not say which is which.
#[test]
fn a_curved_mesh_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let output = dir.path().join("link.xml");
    let [mesh, linkage] =
        ["samples/hexpyrtet_p2.cgns", "weeble/weeble.meshlink.xml"].map(|name| root().join("fixtures").join(name));
    let cad = fixture("weeble", "step");
    for arguments in
        [args!["link", mesh, "--cad", cad, "-o", output].to_vec(), args!["validate", linkage, "--mesh", mesh].to_vec()]
    {
        let told = sagitta(arguments).expect(2).stderr;
        assert!(told.contains("hexpyrtet_p2.cgns: is of order P2"), "{told}");
    }
    assert!(!output.exists());
}

#[test]
fn patches_can_be_chosen_and_the_association_shown() {
    let dir = tempfile::tempdir().unwrap();
    let [report, output] = ["report.json", "out.msh"].map(|name| dir.path().join(name));
    let (mesh, cad) = (fixture("weeble", "msh"), fixture("weeble", "step"));
    let run = |more: &[&str]| {
        let arguments = args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "--report", report];
        sagitta(arguments.into_iter().chain(more.iter().map(std::ffi::OsString::from)))
    };
    let tied = |report: &serde_json::Value| -> Vec<bool> {
        report["patches"]
            .as_array()
            .unwrap()
            .iter()
            .map(|patch| !patch["cad_faces"].as_object().unwrap().is_empty())
            .collect()
    };
    for (options, wanted) in [
        (&[][..], [true; 4]),
        (&["--straight", "farfield"], [false, true, true, true]),
        (&["--curve", "wall"], [false, true, true, true]),
        (&["--curve", "surface 1,3"], [true, false, true, false]),
    ] {
        let told = run(&[options, &["--dry-run"]].concat()).expect(0).stdout;
        assert_eq!(tied(&json(&report)), wanted, "{options:?} {told}");
        assert!(told.starts_with("association by the mesh's entity tags"), "{told}");
    }
    let unknown = run(&["--curve", "wings", "--dry-run"]).expect(2).stderr;
    assert!(unknown.contains("\"wings\"") && unknown.contains("farfield"), "{unknown}");
    let path = output.to_str().unwrap();
    run(&["--straight", "farfield", "-o", path]).expect(0);
    let curved = formats::read(&output).unwrap();
    let blocks = curved.side_blocks().filter(|block| curved.names_of(block.entity).contains(&"farfield".to_owned()));
    for block in blocks {
        for nodes in block.elements(curved.order()) {
            for (node, &[a, b]) in (block.cell.corner_count()..).zip(block.cell.edges()) {
                let at = |n: usize| curved.points()[nodes[n].index()];
                assert!(at(node).distance(0.5 * (at(usize::from(a)) + at(usize::from(b)))) < 1e-12);
            }
        }
    }
    assert!(run(&["--order", "2"]).code == Some(2), "neither -o nor --dry-run");
}
