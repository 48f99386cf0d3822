//! The boundary of a mesh, from its cells.

use std::collections::HashSet;

use rustc_hash::FxHashMap;

use crate::element::{Cell, face_lattice, lattice};
use crate::formats::assembly::Assembly;
use crate::mesh::{Block, EntityKey, FaceKey, NodeId, Parts};

/// A face of the boundary.
pub(super) struct SkinFace {
    pub(super) cell: Cell,
    /// Nodes in internal order.
    pub(super) nodes: Vec<NodeId>,
    /// The element that the file has there: block and place.
    element: Option<(usize, usize)>,
}

/// Blocks of cells of a dimension, with their places.
fn blocks_of(mesh: &Parts, dimension: usize) -> impl Iterator<Item = (usize, &Block)> {
    mesh.blocks.iter().enumerate().filter(move |(_, block)| block.cell.dimension() == dimension)
}

/// Faces of the boundary, and of elements of one dimension less than the cells, that belong to none of these entities;
/// in the order of the file's faces, then of the cells.
pub(super) fn bare_faces(mesh: &Parts, taken: &HashSet<EntityKey>) -> Vec<SkinFace> {
    let mut faces = Vec::new();
    let mut known: HashSet<FaceKey> = HashSet::new();
    for (place, block) in blocks_of(mesh, 2) {
        for (n, nodes) in block.elements(mesh.order).enumerate() {
            known.insert(FaceKey::new(&nodes[..block.cell.corner_count()]));
            if !taken.contains(&block.entity) {
                faces.push(SkinFace { cell: block.cell, nodes: nodes.to_vec(), element: Some((place, n)) });
            }
        }
    }
    faces.extend(
        skin(mesh).into_iter().filter(|face| !known.contains(&FaceKey::new(&face.nodes[..face.cell.corner_count()]))),
    );
    faces
}

/// The faces that one cell alone has, in the order of the cells.
fn skin(mesh: &Parts) -> Vec<SkinFace> {
    let mut open: FxHashMap<FaceKey, (usize, usize, usize)> = FxHashMap::default();
    for (place, block) in blocks_of(mesh, 3) {
        for (n, nodes) in block.elements(mesh.order).enumerate() {
            for (f, face) in block.cell.faces().iter().enumerate() {
                let corners: Vec<NodeId> = face.corners.iter().map(|&c| nodes[usize::from(c)]).collect();
                let key = FaceKey::new(&corners);
                if open.remove(&key).is_none() {
                    open.insert(key, (place, n, f));
                }
            }
        }
    }
    let mut places: Vec<(usize, usize, usize)> = open.into_values().collect();
    places.sort_unstable();
    places.into_iter().map(|place| face(mesh, place)).collect()
}

fn face(mesh: &Parts, (place, n, f): (usize, usize, usize)) -> SkinFace {
    let block = &mesh.blocks[place];
    let face = &block.cell.faces()[f];
    let nodes = &block.nodes[n * block.stride(mesh.order)..];
    let slots = lattice(block.cell, mesh.order);
    let own = face_lattice(block.cell, face, mesh.order);
    let slot = |at: &[u8; 3]| slots.iter().position(|x| x == at).unwrap_or_default();
    SkinFace { cell: face.cell, nodes: own.iter().map(|at| nodes[slot(at)]).collect(), element: None }
}

/// Gives faces to entities: as new elements, or by moving those that are there.
pub(super) fn assign(assembly: &mut Assembly, faces: Vec<(SkinFace, EntityKey)>) {
    let moved: HashSet<(usize, usize)> = faces.iter().filter_map(|(face, _)| face.element).collect();
    let tags: Vec<Option<u64>> =
        faces.iter().map(|(face, _)| face.element.map(|(block, n)| assembly.parts.blocks[block].tags[n])).collect();
    withdraw(&mut assembly.parts, &moved);
    for ((face, entity), tag) in faces.into_iter().zip(tags) {
        match tag {
            None => assembly.push(face.cell, entity, &face.nodes),
            Some(tag) => assembly.push_tagged(face.cell, entity, tag, &face.nodes),
        }
    }
}

/// Takes elements out, given by block and place.
fn withdraw(parts: &mut Parts, elements: &HashSet<(usize, usize)>) {
    let order = parts.order;
    for (place, block) in parts.blocks.iter_mut().enumerate() {
        if !elements.iter().any(|&(b, _)| b == place) {
            continue;
        }
        let kept: Vec<usize> = (0..block.tags.len()).filter(|&n| !elements.contains(&(place, n))).collect();
        let stride = block.stride(order);
        block.nodes = kept.iter().flat_map(|&n| block.nodes[n * stride..][..stride].iter().copied()).collect();
        block.tags = kept.iter().map(|&n| block.tags[n]).collect();
    }
}
