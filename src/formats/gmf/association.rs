//! Which vertices lie on which entity of the geometry, and with which parameters.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::element::Cell;
use crate::formats::assembly::Assembly;
use crate::mesh::{EntityKey, NodeId, Parts};

/// A vertex on an entity; the parameters of a curve have `v = 0`, a point has none.
pub(super) struct OnGeometry {
    pub(super) node: NodeId,
    pub(super) entity: EntityKey,
    pub(super) parameters: [f64; 2],
}

/// Classifies each node on the entity of the lowest dimension that it lies on, and gives it the parameters there; corners that
/// lie on a point become elements.
///
/// The numbers of entities are those that elements refer to. In files of other programs they are elements of another mesh, which
/// stands for the geometry: where no element at a vertex refers to what the vertex lies on, though some refer to entities of that
/// dimension, nothing is used.
pub(super) fn apply(assembly: &mut Assembly, mut all: Vec<OnGeometry>, corners: &[NodeId]) {
    if let Some(reason) = contradiction(&assembly.parts, &all) {
        assembly.parts.notes.push(reason);
        all.clear();
    }
    all.sort_by_key(|own| (own.node, own.entity.dimension));
    all.dedup_by_key(|own| own.node);
    let lowest: FxHashMap<NodeId, EntityKey> = all.iter().map(|own| (own.node, own.entity)).collect();
    let mut unused = 0;
    for &corner in corners {
        match lowest.get(&corner) {
            Some(&point) if point.dimension == 0 => assembly.push(Cell::Point, point, &[corner]),
            _ => unused += 1,
        }
    }
    if unused > 0 {
        assembly
            .parts
            .notes
            .push(format!("{unused} Corners are not used, as no VerticesOnGeometricVertices numbers them"));
    }
    if all.is_empty() {
        return;
    }
    assembly.parts.node_entities = vec![None; assembly.parts.points.len()];
    for OnGeometry { node, entity, parameters } in all {
        assembly.parts.node_entities[node.index()] = Some(entity);
        if entity.dimension > 0 {
            assembly.parts.node_parameters.push((node, parameters));
        }
    }
}

/// Why the entities cannot be those of the elements.
fn contradiction(parts: &Parts, all: &[OnGeometry]) -> Option<String> {
    if all.is_empty() {
        return None;
    }
    let mut dimensions: FxHashSet<(NodeId, u8)> = FxHashSet::default();
    let mut references: FxHashSet<(NodeId, EntityKey)> = FxHashSet::default();
    for block in parts.blocks.iter().filter(|block| matches!(block.cell.dimension(), 1 | 2)) {
        dimensions.extend(block.nodes.iter().map(|&node| (node, block.entity.dimension)));
        references.extend(block.nodes.iter().map(|&node| (node, block.entity)));
    }
    let first = all.iter().find(|own| {
        dimensions.contains(&(own.node, own.entity.dimension)) && !references.contains(&(own.node, own.entity))
    })?;
    Some(format!(
        "{} VerticesOnGeometric* are not used: vertex {} is on {}, which none of its elements refers to",
        all.len(),
        first.node.index() + 1,
        first.entity
    ))
}
