//! GMF files, text and binary: what is written is read again, bit for bit; node orders are those that the file itself gives.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::fs;
use std::path::Path;

use glam::DVec3;
use sagitta::element::{Cell, Order};
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::elevate::elevate;
use sagitta::mesh::{EntityKey, Mesh, NodeId};

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
    for case in ["weeble_hybrid", "torus", "cylinder_bl"] {
        let linear = formats::read(Path::new(&format!("fixtures/{case}/{case}.msh"))).unwrap();
        for order in Order::all() {
            let mesh = if order == Order::LINEAR { linear.clone() } else { elevate(&linear, order).unwrap().mesh };
            for name in ["mesh.mesh", "mesh.meshb"] {
                let again = round_trip(&mesh, &folder.path().join(name));
                assert_eq!(again.order(), order);
                assert!(again.points() == mesh.points(), "{case} {order} {name}: other coordinates");
                for cell in Cell::ALL.into_iter().filter(|cell| *cell != Cell::Point) {
                    assert!(elements(&again, cell) == elements(&mesh, cell), "{case} {order} {name}: other {cell}s");
                }
            }
        }
    }
}

#[test]
fn nodes_on_geometry_keep_their_entities_and_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = formats::read(Path::new("fixtures/samples/cylprism_p1_msh41b.msh")).unwrap();
    let mut parts = mesh.into_parts();
    let curve = EntityKey::new(1, 7);
    parts.node_entities = vec![None; parts.points.len()];
    parts.node_entities[0] = Some(EntityKey::new(0, 3));
    parts.node_entities[1] = Some(curve);
    parts.node_parameters = vec![(NodeId::new(1).unwrap(), [0.1, 0.0])];
    let mesh = Mesh::new(parts).unwrap();
    for name in ["mesh.mesh", "mesh.meshb"] {
        let again = round_trip(&mesh, &folder.path().join(name));
        assert_eq!(again.node_entities()[..3], [Some(EntityKey::new(0, 3)), Some(curve), None], "{name}");
        assert_eq!(again.node_parameters(), mesh.node_parameters(), "{name}");
    }
}

/// A P2 triangle and its tetrahedron, the nodes of which the file lists backwards.
const BACKWARDS: &str = "MeshVersionFormatted 2 # a comment\nDimension\n3\nRequiredVertices\n1\n1\n\
    Vertices\n10\n0 0.5 0.5 0\n.5 0 .5 0\n0 0 .5 0\n0 .5 0 0\n.5 .5 0 0\n.5 0 0 0\n0 0 1 0\n0 1 0 0\n1 0 0 0\n0 0 0 0\n\
    TetrahedraP2Ordering\n10\n0 0 1 1\n0 1 0 1\n1 0 0 1\n1 0 1 0\n0 1 1 0\n1 1 0 0\n0 0 0 2\n0 0 2 0\n0 2 0 0\n2 0 0 0\n\
    TetrahedraP2\n1\n1 2 3 4 5 6 7 8 9 10 4\nEnd\n";

#[test]
fn the_order_of_nodes_is_what_the_file_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("backwards.mesh");
    fs::write(&path, BACKWARDS).unwrap();
    let mesh = formats::read(&path).unwrap();
    assert_eq!(mesh.order().get(), 2);
    let [(entity, nodes)] = &elements(&mesh, Cell::Tet)[..] else { panic!("one tet") };
    assert_eq!(*entity, EntityKey::new(3, 4));
    let corners: Vec<DVec3> = nodes[..4].iter().map(|n| mesh.points()[n.index()]).collect();
    assert_eq!(corners, [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
    let middle = mesh.points()[nodes[4].index()];
    assert_eq!(middle, 0.5 * DVec3::X, "the first edge's");
    assert!(mesh.notes().iter().any(|note| note == "not read: RequiredVertices"), "{:?}", mesh.notes());
}

#[test]
fn damaged_files_are_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bad.mesh");
    let changes = [
        ("Formatted 2", "Formatted 9", "MeshVersionFormatted 9 is not read"),
        ("Dimension\n3", "Dimension\n7", "Dimension 7 is not read"),
        ("Vertices\n10\n0", "Vertices\n99999999999\n0", "do not fit into"),
        ("0 0 0 2\n", "0 0 2 0\n", "does not name each node of the lattice once"),
        ("1 2 3 4 5", "1 2 3 4 55", "refers to node 55"),
        ("1 2 3 4 5", "1 2 x 4 5", "\"x\" is not a valid number"),
        (" 7 8 9 10 4\nEnd\n", "", "cut off"),
        ("0 0.5 0.5 0", "0 inf 0.5 0", "not a finite number"),
    ];
    for (from, to, expected) in changes {
        assert!(BACKWARDS.contains(from), "{from}");
        fs::write(&path, BACKWARDS.replacen(from, to, 1)).unwrap();
        let told = formats::read(&path).unwrap_err().to_string();
        assert!(told.contains(expected) && told.contains("bad.mesh"), "{from} -> {to}: {told}");
    }
    // A binary file cut off anywhere, and one whose next keyword is before this one.
    fs::write(&path, BACKWARDS).unwrap();
    let whole = folder.path().join("whole.meshb");
    formats::write(&whole, &formats::read(&path).unwrap(), &WriteOptions::default()).unwrap();
    let bytes = fs::read(&whole).unwrap();
    let cut = folder.path().join("cut.meshb");
    for length in 9..bytes.len() - 8 {
        fs::write(&cut, &bytes[..length]).unwrap();
        assert!(formats::read(&cut).is_err(), "cut to {length} of {} bytes", bytes.len());
    }
    let mut looped = bytes;
    looped[12..16].copy_from_slice(&8_i32.to_le_bytes());
    fs::write(&cut, looped).unwrap();
    assert!(formats::read(&cut).unwrap_err().to_string().contains("next keyword"));
}
