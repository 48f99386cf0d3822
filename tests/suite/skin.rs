//! Boundary elements held against the cells: what is missing, crossed, stray or double is told, and costs no wall.

use std::path::{Path, PathBuf};

use crate::common::{fixture, json, sagitta};
use sagitta::curve::Settings;
use sagitta::element::{Cell, Order};
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{Block, Mesh, Parts, Skin};

/// The coarse cylinder's mesh, changed and written to `folder`.
fn changed(folder: &Path, change: impl FnOnce(&mut Parts)) -> PathBuf {
    let mut parts = formats::read(&mesh()).unwrap().into_parts();
    change(&mut parts);
    let path = folder.join("linear.msh");
    formats::write(&path, &Mesh::new(parts).unwrap(), &WriteOptions::default()).unwrap();
    path
}

fn mesh() -> PathBuf {
    fixture("cylinder_bl_coarse", "msh").with_file_name("cylinder_bl.msh")
}

fn cad() -> PathBuf {
    fixture("cylinder_bl_coarse", "step").with_file_name("cylinder_bl.step")
}

fn is_wall(parts: &Parts, block: &Block) -> bool {
    let radius = |n: &sagitta::mesh::NodeId| parts.points[n.index()].truncate().length();
    block.cell == Cell::Quad && block.nodes.iter().all(|n| radius(n) < 0.5 + 1e-9)
}

/// A wall without boundary elements is curved as if it had them; the file gets no more elements than it had.
#[test]
fn a_wall_without_boundary_elements_is_curved() {
    let folder = tempfile::tempdir().unwrap();
    let linear = changed(folder.path(), |parts| {
        let wall = parts.blocks.iter().position(|block| is_wall(parts, block)).unwrap();
        parts.blocks.remove(wall);
    });
    let [out, whole, report] = ["out.vtu", "whole.vtu", "report.json"].map(|name| folder.path().join(name));
    let options = args!["--cad", cad(), "-q", "--order", "3", "--ignore-tags"];
    let told = sagitta(args!["curve", linear].iter().chain(&options).chain(&args!["-o", out, "--report", report]));
    let told = told.expect(0).stdout;
    assert!(told.contains("8 faces of the skin have no boundary element"), "{told}");
    let report = json(&report);
    let patches = report["patches"].as_array().unwrap();
    let unmarked = patches.iter().find(|patch| patch["entity"] == "unmarked boundary").unwrap();
    assert_eq!((&unmarked["faces"], unmarked["cad_groups"].as_array().unwrap().len()), (&8.into(), 1), "{told}");
    sagitta(args!["curve", mesh()].iter().chain(&options).chain(&args!["-o", whole])).expect(0);
    let [out, whole] = [out, whole].map(|path| formats::read(&path).unwrap());
    let missing = whole.elements_of(Cell::Quad).len() - out.elements_of(Cell::Quad).len();
    assert_eq!(missing, 8, "nothing is added to what the file had");
    // Every node of the wall is on the cylinder, and there are as many as with boundary elements.
    let on_wall = |mesh: &Mesh| {
        let off = mesh.points().iter().map(|x| (x.truncate().length() - 0.5).abs());
        off.filter(|off| *off < 1e-12).count()
    };
    assert_eq!(on_wall(&out), on_wall(&whole));
    for command in ["info", "check"] {
        let told = sagitta(args![command, linear]).expect(0).stdout;
        assert!(told.contains("8 faces of the skin have no boundary element"), "{command}: {told}");
    }
}

/// Boundary elements whose edges cross are put right along the cells' faces when a file is read; of a mesh in memory they are refused.
#[test]
fn crossed_boundary_elements_are_put_right_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [out, whole] = ["out.vtu", "whole.vtu"].map(|name| folder.path().join(name));
    let crossed = |parts: &mut Parts| {
        let wall = parts.blocks.iter().position(|block| is_wall(parts, block)).unwrap();
        parts.blocks[wall].nodes.swap(4, 5);
    };
    let linear = changed(folder.path(), crossed);
    let options = args!["--cad", cad(), "--order", "2", "-q"];
    let told = sagitta(args!["curve", linear].iter().chain(&options).chain(&args!["-o", out])).expect(0).stdout;
    assert!(told.contains("1 of 196 quad elements on the boundary had their corners in crossed order"), "{told}");
    sagitta(args!["curve", mesh()].iter().chain(&options).chain(&args!["-o", whole])).expect(0);
    let [out, whole] = [out, whole].map(|path| formats::read(&path).unwrap().points().to_vec());
    assert!(out.iter().zip(&whole).all(|(a, b)| a.distance(*b) < 1e-12), "the same places");

    let mut parts = formats::read(&mesh()).unwrap().into_parts();
    crossed(&mut parts);
    let model = cad::Model::read(&cad(), &cad::ReadOptions::default()).unwrap();
    let settings = Settings::new(Order::new(2).unwrap());
    let refused = sagitta::curve::curve(Mesh::new(parts).unwrap(), &model, None, &settings, &mut ()).unwrap_err();
    assert!(refused.to_string().contains("their edges cross: quad "), "{refused}");
}

/// Boundary elements that belong to no cell and nodes without elements are told.
#[test]
fn strays_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let strays = changed(folder.path(), |parts| {
        let wall = parts.blocks.iter().position(|block| is_wall(parts, block)).unwrap();
        let cells = parts.blocks.iter().find(|block| block.cell == Cell::Hex).unwrap();
        let across = [cells.nodes[0], cells.nodes[1], cells.nodes[6], cells.nodes[7]];
        let own = &mut parts.blocks[wall];
        own.nodes.extend(across);
        own.tags.push(999_999);
        parts.points.push(glam::DVec3::splat(0.1));
        parts.node_tags.push(999_999);
        parts.node_entities.push(None);
    });
    for command in ["info", "check"] {
        let told = sagitta(args![command, strays]).expect(0).stdout;
        for finding in ["1 boundary elements are no side of any cell: 999999", "1 nodes belong to no element: 999999"] {
            assert!(told.contains(finding), "{finding}: {told}");
        }
    }
}

/// Sound fixtures have nothing to be told of.
#[test]
fn sound_meshes_have_no_findings() {
    for case in ["weeble", "weeble_hybrid", "torus"] {
        let mesh = formats::read(&fixture(case, "msh")).unwrap();
        assert_eq!(Skin::of(&mesh).notes(&mesh), [""; 0], "{case}");
    }
}
