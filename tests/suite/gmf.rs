//! GMF files, text and binary: what is written is read again, bit for bit, by us and by other programs.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use sagitta::certify::{self, Settings};
use sagitta::element::{Cell, Order};
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{EntityKey, Mesh, NodeId};

const NAMES: [&str; 2] = ["mesh.mesh", "mesh.meshb"];

fn read(path: &str) -> Mesh {
    formats::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(path)).unwrap()
}

fn curved(linear: &Mesh, order: Order) -> Mesh {
    if order == Order::LINEAR { linear.clone() } else { elevate(linear, order).unwrap().mesh }
}

/// Elements of a kind, by file order: entity and nodes.
fn elements(mesh: &Mesh, cell: Cell) -> Vec<(EntityKey, Vec<NodeId>)> {
    let blocks = mesh.blocks().iter().filter(|block| block.cell == cell);
    blocks.flat_map(|block| block.elements(mesh.order()).map(|nodes| (block.entity, nodes.to_vec()))).collect()
}

fn round_trip(mesh: &Mesh, path: &Path) -> Mesh {
    formats::write(path, mesh, &WriteOptions::default()).unwrap();
    formats::read(path).unwrap()
}

#[test]
fn what_is_written_is_read_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let cases =
        ["weeble_hybrid/weeble_hybrid.msh", "samples/hexpyrtet_p1_msh41b.msh", "samples/cylprism_p1_msh22b.msh"];
    let mut seen = std::collections::BTreeSet::new();
    for case in cases {
        let linear = read(case);
        for order in Order::all() {
            let mesh = curved(&linear, order);
            for name in NAMES {
                let (path, second) = (folder.path().join(name), folder.path().join(format!("again_{name}")));
                let again = round_trip(&mesh, &path);
                assert_eq!(again.order(), order);
                assert!(again.points() == mesh.points(), "{case} {order} {name}: other coordinates");
                for cell in Cell::ALL.into_iter().filter(|cell| *cell != Cell::Point) {
                    seen.extend(mesh.blocks().iter().map(|block| (block.cell, order)));
                    assert!(elements(&again, cell) == elements(&mesh, cell), "{case} {order} {name}: other {cell}s");
                }
                formats::write(&second, &again, &WriteOptions::default()).unwrap();
                assert!(std::fs::read(&path).unwrap() == std::fs::read(&second).unwrap(), "{case} {order} {name}");
            }
        }
    }
    for cell in Cell::ALL.into_iter().filter(|cell| cell.dimension() >= 2) {
        assert!(Order::all().all(|order| seen.contains(&(cell, order))), "{cell} was there at every order");
    }
}

#[test]
fn a_plane_mesh_stays_one() {
    let folder = tempfile::tempdir().unwrap();
    let linear = read("samples/circle2d_p1.su2");
    for order in Order::all() {
        let mesh = curved(&linear, order);
        for name in NAMES {
            let again = round_trip(&mesh, &folder.path().join(name));
            assert_eq!((again.dimension(), again.points()), (2, mesh.points()), "{order} {name}");
            assert_eq!(elements(&again, Cell::Quad), elements(&mesh, Cell::Quad), "{order} {name}");
        }
    }
    let text = std::fs::read_to_string(folder.path().join(NAMES[0])).unwrap();
    assert!(text.contains("\nDimension 2\n"));
}

#[test]
fn nodes_on_geometry_keep_their_entities_and_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let mut parts = read("samples/cylprism_p1_msh41b.msh").into_parts();
    let node = |n| NodeId::new(n).unwrap();
    let face = parts.blocks.iter().find(|block| block.cell == Cell::Quad).unwrap();
    let (surface, on_surface) = (face.entity, face.nodes[0]);
    let [point, on_curve] = [0, 1, 2].map(node).into_iter().filter(|n| *n != on_surface).collect::<Vec<_>>()[..2]
    else {
        panic!("two others")
    };
    parts.blocks.retain(|block| block.cell.dimension() != 1);
    let mut entities = vec![None; parts.points.len()];
    for (node, key) in [(point, EntityKey::new(0, 3)), (on_curve, EntityKey::new(1, 7)), (on_surface, surface)] {
        entities[node.index()] = Some(key);
    }
    parts.node_entities = entities.clone();
    parts.node_parameters = vec![(on_curve, [0.1, 0.0]), (on_surface, [0.1, 1.0 / 3.0])];
    parts.node_parameters.sort_by_key(|(node, _)| *node);
    let mesh = Mesh::new(parts).unwrap();
    for name in NAMES {
        let again = round_trip(&mesh, &folder.path().join(name));
        assert_eq!(again.node_entities(), entities, "{name}: {:?}", again.notes());
        assert_eq!(again.node_parameters(), mesh.node_parameters(), "{name}");
    }
}

/// Gmsh states no order of nodes: that of tets of order 2 is not its own.
#[test]
fn the_order_of_another_program_is_understood() {
    let mesh = read("samples/periodic_tet_p2.mesh");
    assert!(certify::mesh(&mesh, mesh.points(), None, &Settings::default()).holds());
    let middle = |a: NodeId, b: NodeId| 0.5 * (mesh.points()[a.index()] + mesh.points()[b.index()]);
    for (_, nodes) in elements(&mesh, Cell::Tet) {
        for (place, &[a, b]) in Cell::Tet.edges().iter().enumerate() {
            let own = mesh.points()[nodes[4 + place].index()];
            assert!(own.distance(middle(nodes[usize::from(a)], nodes[usize::from(b)])) < 1e-12);
        }
    }
}

/// What other programs find in files; `None`, said aloud, where no Python is at hand.
#[allow(clippy::explicit_write)] // the test harness would swallow what `eprintln!` says
fn reread(files: &[PathBuf]) -> Option<serde_json::Value> {
    let Ok(python) = std::env::var("SAGITTA_PYTHON") else {
        assert!(std::env::var_os("CI").is_none(), "SAGITTA_PYTHON is not set: no other program reads the files");
        writeln!(std::io::stderr(), "!!! SAGITTA_PYTHON is not set: files are NOT read back by Gmsh and meshio")
            .unwrap();
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/judge/reread.py");
    let output = Command::new(python).arg(script).args(files).output().expect("SAGITTA_PYTHON runs");
    Some(serde_json::from_slice(&output.stdout).unwrap_or_else(|error| {
        panic!("{error}: {}", String::from_utf8_lossy(&output.stderr));
    }))
}

/// meshio reads linear files, binary and text; Gmsh texts of tets of order 1 and 2.
#[test]
fn other_programs_read_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let mut files = Vec::new();
    for case in ["hexpyrtet_p1_msh41b.msh", "cylprism_p1_msh41b.msh", "circle2d_p1.su2", "periodic_tet_p1_msh41b.msh"] {
        let linear = read(&format!("samples/{case}"));
        for (order, name) in [(1, "p1.mesh"), (1, "p1.meshb"), (2, "p2.mesh")] {
            let mesh = curved(&linear, Order::new(order).unwrap());
            let path = folder.path().join(format!("{case}_{name}"));
            formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
            files.push((path, mesh));
        }
    }
    let paths: Vec<PathBuf> = files.iter().map(|(path, _)| path.clone()).collect();
    let Some(found) = reread(&paths) else { return };
    let (mut by_meshio, mut by_gmsh) = (0, 0);
    for (path, mesh) in &files {
        let name = path.display();
        let of = |reader: &str| &found[path.to_str().unwrap()][reader];
        let text = path.extension().is_some_and(|ending| ending == "mesh");
        if text && std::fs::read_to_string(path).unwrap().contains("VerticesOnGeometric") {
            assert_eq!(
                of("meshio")["error"],
                "SystemExit: 1",
                "{name}: docs/formats.md says that meshio cannot read it"
            );
        } else if mesh.order() == Order::LINEAR {
            let theirs = of("meshio");
            assert_eq!(theirs["nodes"], mesh.points().len(), "{name}: {theirs}");
            for (cell, word) in
                [(Cell::Tet, "tetra"), (Cell::Pyramid, "pyramid"), (Cell::Prism, "wedge"), (Cell::Hex, "hexahedron")]
            {
                let own = elements(mesh, cell).len();
                assert_eq!(theirs["elements"][word].as_u64().unwrap_or(0), own as u64, "{name}: {cell} {theirs}");
            }
            by_meshio += 1;
        }
        let tets =
            path.to_string_lossy().contains("periodic_tet") && path.extension().is_some_and(|ending| ending == "mesh");
        if tets {
            let theirs = of("gmsh");
            assert_eq!(theirs["nodes"], mesh.points().len(), "{name}: {theirs}");
            assert!((theirs["volume"].as_f64().unwrap() - 1.0).abs() < 1e-10, "{name}: {theirs}");
            assert!(theirs["smallest_determinant"].as_f64().unwrap() > 0.0, "{name}: {theirs}");
            by_gmsh += 1;
        }
    }
    assert_eq!((by_meshio, by_gmsh), (7, 2));
}
