//! UGRID files of kind `b4`, as AFLR3 writes them: big-endian, numbers of 32 bits.

use std::path::Path;

use sagitta::element::{Cell, Order};
use sagitta::mesh::Mesh;

/// Writes a linear mesh of tets; coordinates lose what single precision does not hold.
pub fn write_b4(path: &Path, mesh: &Mesh) {
    let blocks = |cell: Cell| mesh.blocks().iter().filter(move |block| block.cell == cell);
    let count = |cell: Cell| blocks(cell).map(|block| block.tags.len()).sum::<usize>();
    assert_eq!(mesh.cells().len(), count(Cell::Tet), "of tets alone");
    let counts = [mesh.points().len(), count(Cell::Triangle), 0, count(Cell::Tet), 0, 0, 0];
    let mut bytes: Vec<u8> = counts.iter().flat_map(|&n| (n as i32).to_be_bytes()).collect();
    bytes.extend(mesh.points().iter().flat_map(|x| x.as_vec3().to_array()).flat_map(f32::to_be_bytes));
    let nodes = |cell: Cell| -> Vec<u8> {
        let elements = blocks(cell).flat_map(|block| block.elements(Order::LINEAR));
        elements.flatten().flat_map(|node| (node.index() as i32 + 1).to_be_bytes()).collect()
    };
    bytes.extend(nodes(Cell::Triangle));
    let surfaces = blocks(Cell::Triangle).flat_map(|block| block.tags.iter().map(|_| block.entity.tag));
    bytes.extend(surfaces.flat_map(i32::to_be_bytes));
    bytes.extend(nodes(Cell::Tet));
    std::fs::write(path, bytes).unwrap();
}
