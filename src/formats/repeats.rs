//! Elements that are there twice, numbers that stand twice, corners that an element has twice: looked for once for all formats.

use rayon::prelude::*;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};
use std::hash::BuildHasher;

use super::error::{Fault, Flaw, Place};
use crate::mesh::{Block, Mesh, NodeId};

/// Refuses repeated numbers and doubled elements; notes what may be meant: faces in two patches, and collapsed elements.
///
/// # Errors
/// [`Fault::RepeatedElement`], [`Fault::Doubled`], at the second of the two.
pub(super) fn check(mesh: &mut Mesh) -> Result<(), Flaw> {
    let mut notes = Vec::new();
    for dimension in 1..=mesh.dimension() {
        let own = |block: &&Block| block.cell.dimension() == dimension;
        let blocks: Vec<&Block> = mesh.blocks().iter().filter(own).collect();
        numbers(&blocks)?;
        notes.extend(collapsed(mesh, &blocks));
        notes.extend(doubled(mesh, &blocks, dimension == mesh.dimension())?);
    }
    notes.into_iter().for_each(|note| mesh.note(note));
    Ok(())
}

/// Numbers of elements must differ.
fn numbers(blocks: &[&Block]) -> Result<(), Flaw> {
    let all = || blocks.iter().flat_map(|block| &block.tags).copied();
    if all().zip(all().skip(1)).all(|(a, b)| a < b) {
        return Ok(());
    }
    let mut sorted: Vec<u64> = all().collect();
    sorted.par_sort_unstable();
    match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(Flaw::new(Place::Element(pair[0]), Fault::RepeatedElement)),
        None => Ok(()),
    }
}

/// An element's corners, sorted.
type Corners = [NodeId; 8];

fn corners(block: &Block, nodes: &[NodeId]) -> (Corners, usize) {
    let mut corners = [NodeId::default(); 8];
    let count = block.cell.corner_count();
    corners[..count].copy_from_slice(&nodes[..count]);
    corners[..count].sort_unstable();
    (corners, count)
}

/// A note of elements that have one node at two corners.
fn collapsed(mesh: &Mesh, blocks: &[&Block]) -> Option<String> {
    let twice = |block: &Block, nodes: &[NodeId]| {
        let (corners, count) = corners(block, nodes);
        corners[..count].windows(2).any(|pair| pair[0] == pair[1])
    };
    let of = |block: &&Block| -> (usize, Option<u64>) {
        let elements = block.nodes.par_chunks_exact(block.stride(mesh.order())).zip(&block.tags);
        let found = elements.filter(|(nodes, _)| twice(block, nodes)).map(|(_, &tag)| (1, Some(tag)));
        found.reduce(|| (0, None), |a, b| (a.0 + b.0, a.1.or(b.1)))
    };
    let (count, first) = blocks.iter().map(of).fold((0, None), |a, b| (a.0 + b.0, a.1.or(b.1)));
    let (cell, tag) = (blocks.first()?.cell, first?);
    let noun = if cell.dimension() == mesh.dimension() { "cells" } else { "elements on the boundary" };
    Some(format!(
        "{count} {noun} have one node at two corners (element {tag} is the first): they are collapsed, and no collapsed element is \
         proven valid"
    ))
}

/// Elements with the same corners: refused where they are cells, or of one patch; else noted, as interfaces have a face in
/// each of two patches.
fn doubled(mesh: &Mesh, blocks: &[&Block], are_cells: bool) -> Result<Option<String>, Flaw> {
    let hash = |block: &Block, nodes: &[NodeId]| FxBuildHasher.hash_one((block.cell, corners(block, nodes).0));
    let mut hashes: Vec<u64> = Vec::new();
    for block in blocks {
        hashes.par_extend(block.nodes.par_chunks_exact(block.stride(mesh.order())).map(|nodes| hash(block, nodes)));
    }
    hashes.par_sort_unstable();
    let suspects: FxHashSet<u64> = hashes.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
    if suspects.is_empty() {
        return Ok(None);
    }
    drop(hashes);
    let mut first: FxHashMap<(Corners, usize), (u64, &Block)> = FxHashMap::default();
    let mut noted: Option<(usize, u64, u64)> = None;
    for &block in blocks {
        for (nodes, &tag) in block.elements(mesh.order()).zip(&block.tags) {
            if !suspects.contains(&hash(block, nodes)) {
                continue;
            }
            let Some(&(other, known)) = first.get(&corners(block, nodes)) else {
                first.insert(corners(block, nodes), (tag, block));
                continue;
            };
            let one_patch = known.entity == block.entity && known.physical_tags == block.physical_tags;
            if are_cells || one_patch {
                return Err(Flaw::new(Place::Element(tag), Fault::Doubled(other)));
            }
            noted.get_or_insert((0, other, tag)).0 += 1;
        }
    }
    Ok(noted.map(|(count, a, b)| {
        format!("{count} boundary elements are in two patches (elements {a} and {b} are the first)")
    }))
}
