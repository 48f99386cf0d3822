//! Meshes of faces: plane ones are read, checked and converted; what has nothing to certify is refused.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::common::{fixture, json, root, sagitta};
use glam::DVec3;
use sagitta::element::Cell;
use sagitta::formats::{self, ReadOptions, WriteOptions};
use sagitta::mesh::{Mesh, Parts};

fn sample(file: &str) -> PathBuf {
    root().join("fixtures/samples").join(file)
}

/// Reading CGNS takes the program itself.
fn read(path: &Path) -> Mesh {
    let options = ReadOptions { reader: Some(env!("CARGO_BIN_EXE_sagitta").into()), ..ReadOptions::default() };
    formats::read_with(path, &options).unwrap()
}

fn write(path: &Path, mesh: &Mesh) {
    formats::write(path, mesh, &WriteOptions::default()).unwrap();
}

#[test]
fn a_plane_mesh_is_checked_from_every_format() {
    let files = ["circle2d_p1.cgns", "circle2d_p1.su2", "circle2d_p1.vtk", "circle2d_p1_app_raw.vtu"];
    for file in files {
        let told = sagitta(args!["check", sample(file)]).expect(0).stdout;
        for line in ["251 triangle: 251 valid, 0 invalid, 0 undecided", "42 quad: 42 valid, 0 invalid, 0 undecided"] {
            assert!(told.contains(line), "{file}: {told}");
        }
        assert!(told.contains("certified: every element valid") && !told.contains("note:"), "{file}: {told}");
    }
    // Gmsh bends the outer edges of thin layers through the inner ones.
    for file in ["circle2d_p2_msh22a.msh", "circle2d_p3.cgns"] {
        let told = sagitta(args!["check", sample(file)]).expect(4).stdout;
        for line in ["251 triangle: 251 valid, 0 invalid, 0 undecided", "42 quad: 35 valid, 7 invalid, 0 undecided"] {
            assert!(told.contains(line), "{file}: {told}");
        }
    }
}

#[test]
fn a_mesh_that_is_numbered_clockwise_in_another_plane_is_the_same_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let [path, report] = ["turned.msh", "turned.json"].map(|name| dir.path().join(name));
    let mut mesh = read(&sample("circle2d_p2_msh22a.msh"));
    mesh.points_mut().iter_mut().for_each(|x| *x = DVec3::new(x.x, 0.0, x.y));
    write(&path, &mesh);
    let told = sagitta(args!["check", path, "--report", report]).expect(4).stdout;
    assert!(told.contains("251 triangle: 251 valid") && told.contains("42 quad: 35 valid, 7 invalid"), "{told}");
    let note = "most cells are numbered clockwise as seen from +y; all are judged against the normal (0.000000, -1.000000, 0.000000)";
    assert!(told.contains(note), "{told}");
    assert_eq!(json(&report)["notes"], serde_json::json!([note]));
}

#[test]
fn a_plane_mesh_is_converted_and_back() {
    let dir = tempfile::tempdir().unwrap();
    let linear = read(&sample("circle2d_p1.su2"));
    let curved = read(&sample("circle2d_p2_msh22a.msh"));
    for (mesh, name) in [
        (&linear, "plane.msh"),
        (&linear, "plane.vtu"),
        (&linear, "plane.cgns"),
        (&curved, "plane_p2.msh"),
        (&curved, "plane_p2.vtu"),
        (&curved, "plane_p2.cgns"),
    ] {
        let path = dir.path().join(name);
        write(&path, mesh);
        let again = read(&path);
        let faces = |mesh: &Mesh| -> BTreeMap<Cell, usize> {
            mesh.counts().into_iter().filter(|(cell, _)| cell.dimension() > 0).collect()
        };
        assert_eq!((again.dimension(), faces(&again)), (2, faces(mesh)), "{name}");
        assert_eq!(again.points().len(), mesh.points().len(), "{name}");
        let told = sagitta(args!["info", path]).expect(0).stdout;
        assert!(told.contains("251 triangle") && told.contains(" faces"), "{name}: {told}");
    }
}

#[test]
fn what_has_nothing_to_certify_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let write_parts = |name: &str, parts: Parts| {
        let path = dir.path().join(name);
        write(&path, &Mesh::new(parts).unwrap());
        path
    };
    let refused = |path: &Path, needle: &str| {
        let told = sagitta(args!["check", path]).expect(2);
        assert!(told.stdout.is_empty() && told.stderr.contains(needle), "{}{}", told.stdout, told.stderr);
        assert!(told.stderr.contains(path.to_str().unwrap()), "{}", told.stderr);
    };
    let mut lines = read(&sample("circle2d_p2_msh22a.msh")).into_parts();
    lines.blocks.retain(|block| block.cell == Cell::Line);
    let mut empty = lines.clone();
    empty.blocks.clear();
    refused(&write_parts("lines.msh", lines), "no cells to certify");
    refused(&write_parts("empty.msh", empty), "no cells to certify");
    let mut surface = read(&fixture("weeble", "msh")).into_parts();
    surface.blocks.retain(|block| block.cell.dimension() < 3);
    let surface = write_parts("surface.msh", surface);
    refused(&surface, "do not lie in one plane");
    assert!(sagitta(args!["info", surface]).expect(0).stdout.contains("faces"));
    sagitta(args!["convert", surface, "-o", dir.path().join("surface.vtu")]).expect(0);
}
