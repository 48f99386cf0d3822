//! CGNS files that we write: read again by us and checked by the CGNS library's own program.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::sample::sample;
use sagitta::element::{Cell, Order};
use sagitta::formats::{self, ReadOptions, WriteOptions};
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{EntityKey, Mesh, NodeId};

fn read(path: &Path) -> Mesh {
    formats::read_with(
        path,
        &ReadOptions { reader: Some(env!("CARGO_BIN_EXE_sagitta").into()), ..ReadOptions::default() },
    )
    .unwrap()
}

/// Elements of the cells and the boundary by entity, in the mesh's order.
fn elements(mesh: &Mesh) -> BTreeMap<(EntityKey, Cell), Vec<NodeId>> {
    let mut all: BTreeMap<_, Vec<NodeId>> = BTreeMap::new();
    for block in mesh.blocks().iter().filter(|block| block.cell.dimension() >= 2) {
        all.entry((block.entity, block.cell)).or_default().extend(&block.nodes);
    }
    all
}

/// Groups of every entity, by number and name.
fn groups(mesh: &Mesh) -> BTreeMap<EntityKey, (Vec<i32>, Vec<String>)> {
    let entities = mesh.blocks().iter().filter(|block| block.cell.dimension() >= 2).map(|block| block.entity);
    entities.map(|key| (key, (mesh.physical_tags_of(key), mesh.names_of(key)))).collect()
}

fn elevated() -> Vec<(String, Mesh)> {
    let linear = [
        "hexpyrtet_p1_msh41b.msh",
        "hexpyrtet_p1_msh22a.msh",
        "cylprism_p1_msh41b.msh",
        "cylprism_p1.lb8.ugrid",
        "mixed_bc.cgns",
    ];
    let mut meshes = Vec::new();
    for name in linear {
        let mesh = sample(name);
        for order in Order::all() {
            meshes.push((format!("{}_{order}", name.replace('.', "_")), elevate(&mesh, order).unwrap().mesh));
        }
    }
    meshes
}

#[test]
fn what_is_written_reads_back_with_its_patches_and_groups() {
    let dir = tempfile::tempdir().unwrap();
    for (name, mesh) in elevated() {
        let path = dir.path().join("mesh.cgns");
        formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
        let again = read(&path);
        assert_eq!((again.order(), again.points()), (mesh.order(), mesh.points()), "{name}");
        assert_eq!(elements(&again), elements(&mesh), "{name}: same elements on same entities in same order");
        assert_eq!(groups(&again), groups(&mesh), "{name}: physical tags and names");
        assert!(again.notes().is_empty(), "{name}: {:?}", again.notes());
        let kinds = |mesh: &Mesh| -> BTreeMap<EntityKey, String> {
            mesh.conditions().iter().map(|c| (c.entity, c.kind.clone())).collect()
        };
        for (entity, kind) in kinds(&mesh) {
            assert_eq!(kinds(&again).get(&entity), Some(&kind), "{name}: condition of {entity}");
        }
        let bytes = std::fs::read(&path).unwrap();
        formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
        assert!(bytes == std::fs::read(&path).unwrap(), "{name}: the same mesh makes the same bytes");
        formats::write(&path, &again, &WriteOptions::default()).unwrap();
        assert_eq!(elements(&read(&path)), elements(&mesh), "{name}: twice");
    }
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1, "nothing but the file is left");
}

#[test]
fn element_numbers_of_a_cgns_file_stay() {
    let dir = tempfile::tempdir().unwrap();
    for name in ["hexpyrtet_p2.cgns", "cylprism_p1.cgns"] {
        let mesh = sample(name);
        let path = dir.path().join("again.cgns");
        formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
        let again = read(&path);
        assert_eq!(groups(&again), groups(&mesh), "{name}");
        let tags = |mesh: &Mesh| -> BTreeMap<(EntityKey, Cell), usize> {
            mesh.blocks().iter().map(|block| ((block.entity, block.cell), block.tags.len())).collect()
        };
        assert_eq!(tags(&again), tags(&mesh), "{name}");
    }
}

/// The CGNS library's checker finds no error and warns of nothing.
#[test]
#[allow(clippy::explicit_write)] // the test harness would swallow what `eprintln!` says
fn cgnscheck_finds_nothing() {
    if Command::new("cgnscheck").output().is_err() {
        writeln!(
            std::io::stderr(),
            "!!! cgnscheck (Debian: cgns-convert) is missing: CGNS files are NOT checked by it"
        )
        .unwrap();
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    for (name, mesh) in elevated() {
        let path: PathBuf = dir.path().join(format!("{name}.cgns"));
        formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
        // A process that another test starts meanwhile inherits the file's lock.
        let output =
            Command::new("cgnscheck").env("HDF5_USE_FILE_LOCKING", "FALSE").arg("-w1").arg(&path).output().unwrap();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{name}: {text}");
        assert!(text.contains("reading zone"), "{text}");
        let complaints: Vec<&str> =
            text.lines().filter(|line| line.contains("ERROR") || line.contains("WARNING")).collect();
        // A mesh of two volumes has a condition for each, as Gmsh writes it, which CGNS does not know.
        let volumes = mesh
            .blocks()
            .iter()
            .filter(|b| b.cell.dimension() == 3)
            .map(|b| b.entity)
            .collect::<std::collections::BTreeSet<_>>();
        assert!(complaints.is_empty() || volumes.len() > 1, "{name}: {complaints:#?}\n{text}");
    }
}

/// A host program that names no reader is not started again; one that does gets the same mesh, and the same errors in content.
#[test]
fn a_file_is_the_same_whichever_process_parses_it() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples");
    let reader = ReadOptions { reader: Some(env!("CARGO_BIN_EXE_sagitta").into()), ..ReadOptions::default() };
    let mut compared = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|ending| ending != "cgns") {
            continue;
        }
        let [here, there] = [formats::read(&path), formats::read_with(&path, &reader)]
            .map(|read| read.map_err(|error| error.to_string()));
        assert_eq!(here, there, "{}", path.display());
        compared += 1;
    }
    assert!(compared > 15, "{compared}");
}

#[test]
fn a_damaged_file_is_refused_in_this_process_too() {
    let folder = tempfile::tempdir().unwrap();
    let whole = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples/mixed_bc.cgns")).unwrap();
    let path = folder.path().join("cut.cgns");
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let told = formats::read(&path).unwrap_err().to_string();
    assert!(told.contains("the file ends here"), "{told}");
}

#[test]
fn a_reader_that_does_not_serve_is_told() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples/mixed_bc.cgns");
    let told = |reader: &str| {
        formats::read_with(&path, &ReadOptions { reader: Some(reader.into()), ..ReadOptions::default() })
            .unwrap_err()
            .to_string()
    };
    assert!(told("/bin/true").contains("does it call cgns::serve_reader"), "{}", told("/bin/true"));
    assert!(told("/bin/none").contains("the reading process /bin/none cannot be run"), "{}", told("/bin/none"));
}
