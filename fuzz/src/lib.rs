//! What the fuzz targets have in common: bytes become a file of some name, which is read or refused.

use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::LazyLock;

use sagitta::formats::{self, Error, ReadOptions};
use sagitta::mesh::Mesh;

/// A folder of this process alone; in memory, where the system has such a place.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let memory = PathBuf::from("/dev/shm");
    let parent = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let folder = parent.join(format!("sagitta-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the input");
    folder
});

/// Reads bytes as a file whose name ends in `ending`.
///
/// # Panics
/// Where what was read cannot be a mesh, or a refusal does not name the file.
pub fn read(bytes: &[u8], ending: &str) -> Option<Mesh> {
    let path = FOLDER.join(format!("input.{ending}"));
    std::fs::write(&path, bytes).expect("the input is written");
    match formats::read_with(&path, &ReadOptions::default()) {
        Ok(mesh) => {
            sound(&mesh);
            Some(mesh)
        }
        Err(error) => {
            assert!(error.to_string().contains("input."), "the file is not named: {error}");
            assert!(!matches!(error, Error::Io { .. }), "{error}");
            None
        }
    }
}

/// What holds of every mesh that was read: nodes are there, no cell and no number is there twice, names are such.
fn sound(mesh: &Mesh) {
    assert!(mesh.blocks().iter().all(|b| b.nodes.iter().all(|n| n.index() < mesh.points().len())));
    assert!(mesh.blocks().iter().all(|b| b.nodes.len() == b.tags.len() * b.stride(mesh.order())));
    assert!(mesh.points().iter().all(|x| x.is_finite()));
    let (mut corners, mut tags) = (HashSet::new(), HashSet::new());
    for cell in mesh.cells().iter() {
        let mut own: Vec<usize> = cell.corners().iter().map(|node| node.index()).collect();
        own.sort_unstable();
        assert!(corners.insert((cell.cell, own)), "cell {} is there twice", cell.tag);
        assert!(tags.insert(cell.tag), "number {} is there twice", cell.tag);
    }
    let names = mesh.physical_names().iter().map(|group| &group.name);
    assert!(names.chain(mesh.conditions().iter().map(|own| &own.name)).all(|name| !name.contains(['\n', '"', '\0'])));
}
