//! Mesh files: read, written, and read again by us and by other programs.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::sample::sample;
use sagitta::element::{Cell, Order};
use sagitta::formats::msh::{self, Encoding, Version};
use sagitta::formats::{self, Field, Support, Values, WriteOptions};
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{Mesh, Parts};

const ENCODINGS: [Encoding; 2] = [Encoding::Binary, Encoding::Ascii];

fn samples() -> Vec<PathBuf> {
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples");
    let mut files: Vec<PathBuf> = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()).collect();
    // Version 4.0 is only there to be refused.
    files.retain(|file| file.extension().is_some_and(|e| e == "msh") && !file.to_string_lossy().contains("msh40"));
    files.sort();
    assert!(files.len() >= 15);
    files
}

fn msh(version: Version, encoding: Encoding) -> WriteOptions<'static> {
    WriteOptions { msh_version: version, msh_encoding: encoding, ..WriteOptions::default() }
}

/// All element numbers and nodes in file order.
fn elements(mesh: &Mesh) -> Vec<(Cell, u64, Vec<usize>)> {
    let of = |b: &sagitta::mesh::Block| {
        let nodes = b.elements(mesh.order()).map(|nodes| nodes.iter().map(|n| n.index()).collect());
        b.tags.iter().zip(nodes).map(|(&tag, nodes)| (b.cell, tag, nodes)).collect::<Vec<_>>()
    };
    mesh.blocks().iter().flat_map(of).collect()
}

/// What other programs find in files; `None`, said aloud, where no Python with Gmsh is at hand.
#[allow(clippy::explicit_write)] // the test harness would swallow what `eprintln!` says
fn reread(files: &[PathBuf]) -> Option<serde_json::Value> {
    let Ok(python) = std::env::var("SAGITTA_PYTHON") else {
        let warning =
            "!!! SAGITTA_PYTHON is not set: files are NOT read back by Gmsh, meshio and VTK, only by ourselves";
        writeln!(std::io::stderr(), "{warning}").unwrap();
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/judge/reread.py");
    let output = Command::new(&python).arg(script).args(files).output().expect("SAGITTA_PYTHON runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    let json = text.lines().last().map(serde_json::from_str);
    Some(
        json.unwrap_or_else(|| panic!("reread.py printed nothing: {errors}"))
            .unwrap_or_else(|e| panic!("{e}: {text} {errors}")),
    )
}

fn of<'a>(found: &'a serde_json::Value, file: &Path, reader: &str) -> &'a serde_json::Value {
    &found[file.to_str().unwrap()][reader]
}

#[test]
fn one_mesh_is_the_same_in_every_version_and_encoding() {
    let [text, bytes] = ["a", "b"].map(|encoding| sample(&format!("hexpyrtet_p1_msh41{encoding}.msh")));
    assert_eq!(text.physical_names().len(), 3);
    // Gmsh writes 16 digits, one less than would tell all numbers apart.
    assert!(text.points().iter().zip(bytes.points()).all(|(a, b)| a.distance(*b) < 1e-15));
    let (points, entities) = (text.points().to_vec(), text.entities().to_vec());
    let rounded = Parts { points, entities, ..bytes.clone().into_parts() };
    assert_eq!(Mesh::new(rounded).unwrap(), text);
    for (old, new) in [("hexpyrtet_p1_msh22a.msh", &text), ("hexpyrtet_p1_msh22b.msh", &bytes)] {
        let old = sample(old);
        assert_eq!(old.points(), new.points());
        assert_eq!(old.node_tags(), new.node_tags());
        // Version 2.2 has elements sorted by type, and numbered so.
        let unnumbered = |mesh: &Mesh| elements(mesh).into_iter().map(|(cell, _, nodes)| (cell, nodes)).collect();
        let [ours, theirs]: [std::collections::BTreeSet<_>; 2] = [unnumbered(&old), unnumbered(new)];
        assert_eq!(ours, theirs);
        assert_eq!(old.physical_names(), new.physical_names());
    }
    let parametric = sample("hexpyrtet_p1_msh41b_param.msh");
    assert_eq!(parametric.node_parameters().len(), 50);
    let bare = Parts { node_parameters: Vec::new(), ..parametric.into_parts() };
    assert_eq!(Mesh::new(bare).unwrap(), bytes);
}

#[test]
fn counts_are_those_of_the_program_that_wrote_them() {
    let cube =
        BTreeMap::from([(Cell::Triangle, 78), (Cell::Quad, 20), (Cell::Tet, 110), (Cell::Pyramid, 4), (Cell::Hex, 8)]);
    for (file, order, points) in [
        ("hexpyrtet_p1_msh41a.msh", 1, 67),
        ("hexpyrtet_p2_msh41b_param.msh", 2, 358),
        ("hexpyrtet_p3_msh41a.msh", 3, 1040),
    ] {
        let mesh = sample(file);
        assert_eq!(mesh.counts(), cube, "{file}");
        assert_eq!((mesh.order().get(), mesh.points().len()), (order, points), "{file}");
    }
}

#[test]
fn a_partitioned_mesh_is_the_mesh_that_was_partitioned() {
    let (parts, whole) = (sample("partitioned_tet_p1_msh41a_param.msh"), sample("periodic_tet_p1_msh41b.msh"));
    assert_eq!(parts.entities(), whole.entities());
    assert_eq!(parts.periodic().len(), whole.periodic().len());
    assert_eq!(parts.counts(), whole.counts());
    let known = |mesh: &Mesh| mesh.entities().iter().map(|e| e.key).collect::<Vec<_>>();
    assert!(parts.blocks().iter().all(|b| known(&whole).contains(&b.entity)));
    assert!(parts.node_entities().iter().all(|e| e.is_some_and(|e| known(&whole).contains(&e))));
}

#[test]
fn what_is_written_reads_back_and_the_same_mesh_makes_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    for file in samples() {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let mesh = formats::read(&file).unwrap();
        for encoding in ENCODINGS {
            let path = dir.path().join("a.msh");
            formats::write(&path, &mesh, &msh(Version::V4_1, encoding)).unwrap();
            let again = formats::read(&path).unwrap();
            if mesh.entities().is_empty() {
                assert_eq!(
                    (elements(&again), again.points(), again.node_tags()),
                    (elements(&mesh), mesh.points(), mesh.node_tags()),
                    "{name}"
                );
            } else {
                assert_eq!(again, mesh, "{name} {encoding:?}");
            }
            let bytes = std::fs::read(&path).unwrap();
            formats::write(&path, &again, &msh(Version::V4_1, encoding)).unwrap();
            assert!(bytes == std::fs::read(&path).unwrap(), "{name}: other bytes");
            formats::write(&path, &mesh, &msh(Version::V2_2, encoding)).unwrap();
            let old = formats::read(&path).unwrap();
            assert_eq!(elements(&old), elements(&mesh), "{name} 2.2 {encoding:?}");
            assert_eq!((old.points(), old.node_tags()), (mesh.points(), mesh.node_tags()), "{name} 2.2 {encoding:?}");
            assert_eq!((old.periodic(), old.physical_names()), (mesh.periodic(), mesh.physical_names()), "{name} 2.2");
        }
    }
    assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 1, "nothing but the file is left");
}

#[test]
fn other_programs_find_the_same_in_what_is_written() {
    let dir = tempfile::tempdir().unwrap();
    let mut pairs = Vec::new();
    for file in samples() {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let mesh = formats::read(&file).unwrap();
        for (n, encoding) in ENCODINGS.into_iter().enumerate() {
            for (version, number) in [(Version::V4_1, "41"), (Version::V2_2, "22")] {
                let path = dir.path().join(format!("{name}_as{number}{n}.msh"));
                formats::write(&path, &mesh, &msh(version, encoding)).unwrap();
                pairs.push((file.clone(), path));
            }
        }
    }
    let mut files = samples();
    files.extend(pairs.iter().map(|(_, written)| written.clone()));
    let Some(found) = reread(&files) else { return };
    for (original, written) in pairs {
        let (theirs, ours) = (of(&found, &original, "gmsh"), of(&found, &written, "gmsh"));
        assert!(ours.get("error").is_none(), "{}: {ours}", written.display());
        let mut keys = vec!["nodes", "largest_tag", "volume", "smallest_determinant", "box"];
        let partitioned = original.to_string_lossy().contains("partitioned");
        let same_version = original.to_string_lossy().contains("msh41") && written.to_string_lossy().contains("_as41");
        keys.extend((!partitioned).then_some("elements"));
        // Gmsh reads periodic nodes from 4.1 only.
        keys.extend(same_version.then_some(["groups", "periodic_pairs"]).into_iter().flatten());
        for key in keys {
            assert_eq!(theirs[key], ours[key], "{key} of {}", written.display());
        }
    }
}

/// The Gmsh numbers and counts that a file of this mesh should hold.
fn gmsh_counts(mesh: &Mesh) -> serde_json::Value {
    let mut counts = BTreeMap::new();
    for block in mesh.blocks() {
        *counts.entry(msh::element_type(block.cell, mesh.order()).to_string()).or_insert(0) += block.tags.len();
    }
    serde_json::to_value(counts).unwrap()
}

#[test]
fn elevated_meshes_are_read_by_other_programs() {
    let dir = tempfile::tempdir().unwrap();
    let mut written = Vec::new();
    for name in ["hexpyrtet_p1_msh41b", "cylprism_p1_msh41b", "periodic_tet_p1_msh41b"] {
        let linear = sample(&format!("{name}.msh"));
        for order in Order::all() {
            let mesh = elevate(&linear, order).unwrap().mesh;
            for (n, version) in [Version::V4_1, Version::V2_2].into_iter().enumerate() {
                let path = dir.path().join(format!("{name}_p{}_{n}.msh", order.get()));
                formats::write(&path, &mesh, &msh(version, ENCODINGS[n])).unwrap();
                let again = formats::read(&path).unwrap();
                let linear_part = |m: &Mesh| {
                    (m.points()[..linear.points().len()].to_vec(), m.node_tags()[..linear.points().len()].to_vec())
                };
                assert_eq!(
                    linear_part(&again),
                    linear_part(&linear),
                    "{name} {order}: linear nodes keep number and place"
                );
                written.push((path, mesh.clone(), n));
            }
            let path = dir.path().join(format!("{name}_p{}.vtu", order.get()));
            let quality = Field {
                name: "quality <J/Jc>".into(),
                support: Support::Elements,
                values: Values::Real((0..mesh.cells().len()).map(|n| n as f64).collect()),
            };
            let height = Field {
                name: "height".into(),
                support: Support::Points,
                values: Values::Real(mesh.points().iter().map(|x| x.z).collect()),
            };
            let options =
                WriteOptions { fields: &[quality, height], volume_only: order.get() == 3, ..WriteOptions::default() };
            formats::write(&path, &mesh, &options).unwrap();
            written.push((path, mesh, 2));
        }
    }
    let files: Vec<PathBuf> = written.iter().map(|(path, ..)| path.clone()).collect();
    let Some(found) = reread(&files) else { return };
    for (path, mesh, kind) in written {
        let name = path.display();
        let volume = if name.to_string().contains("cylprism") { 15.315_897_453 } else { 1.0 };
        let close = |value: &serde_json::Value| value.as_f64().is_some_and(|v| (v - volume).abs() < 1e-8);
        if kind == 2 {
            let vtk = of(&found, &path, "pyvista");
            assert!(close(&vtk["volume"]), "{name}: {vtk}");
            let cells: i64 = vtk["elements"].as_object().unwrap().values().map(|n| n.as_i64().unwrap()).sum();
            let all = mesh.blocks().iter().map(|block| block.tags.len()).sum();
            let expected = if mesh.order().get() == 3 { mesh.cells().len() } else { all };
            assert_eq!(cells as usize, expected, "{name}");
            let arrays = &vtk["arrays"];
            assert_eq!(arrays["quality <J/Jc>"], serde_json::json!([0.0, (mesh.cells().len() - 1) as f64]), "{name}");
            assert!(
                arrays["height"][0]
                    == serde_json::json!(mesh.points().iter().map(|x| x.z).fold(f64::INFINITY, f64::min))
            );
            assert_eq!(arrays["dimension"][1], 3.0);
            continue;
        }
        let gmsh = of(&found, &path, "gmsh");
        assert_eq!(gmsh["elements"], gmsh_counts(&mesh), "{name}: {gmsh}");
        assert_eq!(gmsh["nodes"], mesh.points().len(), "{name}");
        if !gmsh["volume"].is_null() {
            assert!(close(&gmsh["volume"]) && gmsh["smallest_determinant"].as_f64().unwrap() > 0.0, "{name}: {gmsh}");
        }
    }
}

#[test]
fn what_is_no_mesh_file_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let refused = |name: &str, content: &[u8]| {
        let path = dir.path().join(name);
        std::fs::write(&path, content).unwrap();
        let told = formats::read(&path).unwrap_err().to_string();
        assert!(told.starts_with(path.to_str().unwrap()), "{told}");
        told
    };
    assert!(refused("empty.msh", b"").contains("the file is empty"));
    assert!(refused("part.msh", b"ISO-10303-21;\nHEADER;").contains("CAD, not a mesh"));
    assert!(refused("grid.xml", b"<grid/>").contains("an XML file, but not a VTU or Nektar++ mesh"));
    for (name, content, told) in [
        (
            "deck.nas",
            &b"$ a comment\nBEGIN BULK\nGRID,1,,0.,0.,0.\n"[..],
            "a Nastran bulk data file, which is not read",
        ),
        ("deck.inp", b"** a comment\n*HEADING\n mesh\n", "an Abaqus input file, which is not read"),
        ("grid.vol", b"mesh3d\ndimension\n3\n", "a Netgen mesh, which is not read"),
        ("grid.exo", b"CDF\x01\0\0\0\0", "a netCDF file, as Exodus meshes are, which is not read"),
        ("grid.dat", b"TITLE = \"x\"\nVARIABLES = \"X\"\n", "a Tecplot file, which is not read"),
        ("grid.neu", b"        CONTROL INFO 2.4.6\n", "a Gambit neutral file, which is not read"),
        ("grid.xdmf", b"<?xml version=\"1.0\"?><Xdmf Version=\"3.0\">", "an XDMF file, which is not read"),
        ("points", b"FoamFile\n{\n}\n", "a file of an OpenFOAM case, but not its mesh"),
        ("grid.mesh", b"MFEM NC mesh v1.0\n", "an MFEM NC mesh of elements cut in part"),
    ] {
        let found = refused(name, content);
        assert!(found.contains(told), "{found}");
    }
    assert!(refused("noise.msh", &[0xff; 100]).contains("not a mesh file of a known format"));
    assert!(
        refused("old.msh", b"$MeshFormat\n4 0 8\n$EndMeshFormat\n")
            .contains("old.msh, line 2: MSH version 4 is not read")
    );
    let missing = formats::read(&dir.path().join("missing.msh")).unwrap_err().to_string();
    assert!(missing.contains("missing.msh: cannot read: No such file"), "{missing}");
    assert!(formats::read(dir.path()).unwrap_err().to_string().contains("not a regular file"));
}

#[test]
fn what_cannot_be_written_is_told_and_leaves_no_file() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = sample("hexpyrtet_p1_msh41a.msh");
    let refused = |name: &str, options: &WriteOptions| {
        let told = formats::write(&dir.path().join(name), &mesh, options).unwrap_err().to_string();
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0, "{name}");
        told
    };
    let plain = WriteOptions::default();
    let names = "name it .msh, .h5, .cgns, .mfem, .meshb, .mesh, .su2, .xml, .vtu, .vtm or .vtkhdf";
    assert!(refused("mesh.stl", &plain).contains(names));
    assert!(refused("mesh", &plain).contains(names));
    assert!(refused("none/mesh.msh", &plain).contains("cannot create: No such file"));
    let short = Field { name: "short".into(), support: Support::Elements, values: Values::Integer(vec![1, 2]) };
    let options = WriteOptions { fields: &[short], ..plain };
    assert!(refused("mesh.vtu", &options).contains("field \"short\" has 2 values for 122 elements"));
}
