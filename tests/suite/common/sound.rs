//! What holds of every mesh that was read, whatever was in the file; the fuzz targets (`fuzz/`) hold meshes against it too.

use std::collections::HashSet;

use sagitta::mesh::Mesh;

/// Counts once more: nodes are there, no cell and no number is there twice, names are such.
///
/// # Panics
/// Where one of them does not hold.
pub fn sound(mesh: &Mesh) {
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
