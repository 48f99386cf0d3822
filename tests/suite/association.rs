//! Which boundary faces lie on which CAD faces, where no single source knows it of all.

use std::path::{Path, PathBuf};

use crate::common::{fixture, json, sagitta};
use glam::DVec3;
use sagitta::element::Cell;
use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{Block, EntityKey, Mesh, NodeId, Parts};

/// A fixture's mesh, changed and written to `folder`.
fn changed(case: &str, folder: &Path, change: impl FnOnce(&mut Parts)) -> PathBuf {
    let mut parts = formats::read(&fixture(case, "msh")).unwrap().into_parts();
    change(&mut parts);
    let path = folder.join("mesh.msh");
    formats::write(&path, &Mesh::new(parts).unwrap(), &WriteOptions::default()).unwrap();
    path
}

/// Gives surfaces other numbers.
fn renumber(parts: &mut Parts, new: impl Fn(i32) -> i32) {
    let surface = |key: &mut EntityKey| {
        if key.dimension == 2 {
            key.tag = new(key.tag);
        }
    };
    parts.blocks.iter_mut().for_each(|block| surface(&mut block.entity));
    parts.node_entities.iter_mut().flatten().for_each(surface);
    for entity in &mut parts.entities {
        surface(&mut entity.key);
        if entity.key.dimension == 3 {
            entity.boundary.iter_mut().for_each(|tag| *tag = new(tag.abs()));
        }
    }
}

/// What `sagitta link` says of a mesh: faces and undecided faces of all patches together, those off the CAD, and the source.
fn linked(mesh: &Path, cad: &Path, folder: &Path) -> (u64, u64, u64, String) {
    let [out, report] = ["link.xml", "link.json"].map(|name| folder.join(name));
    sagitta(args!["link", mesh, "--cad", cad, "-o", out, "--report", report]).expect(0);
    let report = json(&report);
    let sum = |key: &str| report["patches"].as_array().unwrap().iter().map(|patch| patch[key].as_u64().unwrap()).sum();
    (sum("faces"), sum("undecided"), sum("off_cad"), report["source"].as_str().unwrap().to_owned())
}

fn curved(mesh: &Path, cad: &Path, out: &Path) -> Mesh {
    sagitta(args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", out]).expect(0);
    formats::read(out).unwrap()
}

/// One patch has a number that the CAD lacks; what its tag leaves open geometry decides, and the mesh is as if the tag were right.
#[test]
fn a_number_that_the_cad_lacks_is_made_good_by_geometry() {
    let folder = tempfile::tempdir().unwrap();
    let cad = fixture("weeble", "step");
    let mesh = changed("weeble", folder.path(), |parts| renumber(parts, |tag| if tag == 3 { 30 } else { tag }));
    let (faces, undecided, off, source) = linked(&mesh, &cad, folder.path());
    assert_eq!((faces, undecided, off, &source[..]), (674, 0, 0, "geometry and the mesh's entity tags"));
    let curved = curved(&mesh, &cad, &folder.path().join("out.msh"));
    let linear = formats::read(&mesh).unwrap();
    let waist = curved.side_blocks().find(|block| block.entity.tag == 30).unwrap();
    let moved = |n: &NodeId| n.index() >= linear.points().len();
    assert!(waist.nodes.iter().any(moved), "the patch has new nodes");
}

/// Coordinates that are farther from the CAD than a tenth of the first cell is high, as those of files in single precision are.
#[test]
fn coordinates_less_exact_than_the_first_cell_are_associated_within_a_wider_tolerance() {
    let folder = tempfile::tempdir().unwrap();
    let cad = fixture("weeble", "step");
    let mut random = crate::common::random::Random(crate::common::random::seed(7));
    let mesh = changed("weeble", folder.path(), |parts| {
        renumber(parts, |tag| tag + 100);
        let noise = 3e-5; // the first cell is 1e-4 high
        for x in &mut parts.points {
            *x += DVec3::from_array([0; 3].map(|_| random.between(-noise, noise)));
        }
    });
    let (faces, undecided, off, source) = linked(&mesh, &cad, folder.path());
    assert_eq!((faces, undecided, off, &source[..]), (674, 0, 0, "geometry"));
}

/// A mesh over a part of a CAD face is not of another size.
#[test]
fn a_mesh_may_cover_a_part_of_its_cad() {
    let folder = tempfile::tempdir().unwrap();
    let whole = formats::read(&fixture("plate", "msh")).unwrap();
    let corners = whole.points().iter().copied();
    let (low, high) = corners.fold((DVec3::MAX, DVec3::MIN), |(low, high), x| (low.min(x), high.max(x)));
    // A hex on the plate's low corner, a tenth of its size.
    let points: Vec<DVec3> =
        Cell::Hex.corners().iter().map(|c| low + 0.1 * (high - low) * DVec3::from(c.map(f64::from))).collect();
    let node = |n: u8| NodeId::new(usize::from(n)).unwrap();
    let mut blocks: Vec<Block> = Cell::Hex
        .faces()
        .iter()
        .zip(100..)
        .map(|(face, tag)| Block {
            cell: face.cell,
            entity: EntityKey::new(2, tag),
            physical_tags: vec![],
            tags: vec![tag as u64],
            nodes: face.corners.iter().map(|&c| node(c)).collect(),
        })
        .collect();
    let nodes = (0..8).map(node).collect();
    blocks.push(Block { cell: Cell::Hex, entity: EntityKey::new(3, 1), physical_tags: vec![], tags: vec![1], nodes });
    let parts =
        Parts { points, node_tags: (1..=8).collect(), node_entities: vec![None; 8], blocks, ..Parts::default() };
    let mesh = folder.path().join("part.msh");
    formats::write(&mesh, &Mesh::new(parts).unwrap(), &WriteOptions::default()).unwrap();
    let (faces, undecided, off, _) = linked(&mesh, &fixture("plate", "step"), folder.path());
    assert_eq!((faces, undecided + off), (6, 3), "three faces lie on the plate, three inside it");
    curved(&mesh, &fixture("plate", "step"), &folder.path().join("out.msh"));
}
