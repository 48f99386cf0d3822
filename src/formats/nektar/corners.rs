//! Numbers of corners with which all elements collapse a triangle at the same corner.
//!
//! Nektar++ maps triangles, and whatever has them, from squares by drawing one side together into a corner. Two elements that share a
//! triangle must do so at the same corner. Here it is that of the highest number. Prisms collapse an edge from triangle to triangle, so
//! that both triangles must have their highest numbers at its ends: corners that such edges join are numbered one after the other. A
//! pyramid collapses all its triangles at its apex.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use crate::element::Cell;
use crate::mesh::{Mesh, NodeId};

/// The number of each corner, of other nodes `u32::MAX`; corners are numbered from 0 without gaps.
///
/// # Errors
/// Prisms or pyramids for which there are no such numbers.
pub(super) fn numbers(mesh: &Mesh) -> Result<Vec<u32>, String> {
    let mut columns = Columns { parent: (0..mesh.points().len()).collect() };
    for prism in mesh.elements_of(Cell::Prism).iter() {
        (0..3).for_each(|side| columns.join(prism.nodes[side].index(), prism.nodes[side + 3].index()));
    }
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut is_corner = vec![false; mesh.points().len()];
    mesh.cells().iter().flat_map(|cell| cell.corners()).for_each(|node| is_corner[node.index()] = true);
    for node in (0..is_corner.len()).filter(|&node| is_corner[node]) {
        members.entry(columns.root(node)).or_default().push(node);
    }
    let ranks = ordered(&members, pyramids(mesh, &mut columns)?)?;
    let mut numbers = vec![u32::MAX; mesh.points().len()];
    let mut next = 0;
    for column in ranks {
        for &node in members.get(&column).into_iter().flatten() {
            numbers[node] = next;
            next += 1;
        }
    }
    let is_apart = |corners: &[NodeId]| highest(&corners[..3], &numbers) != highest(&corners[3..], &numbers);
    match mesh.elements_of(Cell::Prism).iter().find(|prism| is_apart(prism.corners())) {
        None => Ok(numbers),
        Some(prism) => Err(format!(
            "prism {} collapses another edge than its neighbours, as prisms stand across one another there; part these into tets",
            prism.tag
        )),
    }
}

/// Which of the corners has the highest number.
pub(super) fn highest(corners: &[NodeId], numbers: &[u32]) -> usize {
    (0..corners.len()).max_by_key(|&n| numbers[corners[n].index()]).unwrap_or(0)
}

/// Columns that must come before others: those of the corners of pyramids' bases before those of their apexes.
fn pyramids(mesh: &Mesh, columns: &mut Columns) -> Result<Vec<[usize; 2]>, String> {
    let mut before = Vec::new();
    for pyramid in mesh.elements_of(Cell::Pyramid).iter() {
        let apex = columns.root(pyramid.nodes[4].index());
        for corner in &pyramid.nodes[..4] {
            let base = columns.root(corner.index());
            if base == apex {
                return Err(format!(
                    "pyramid {} has its apex over an edge of prisms from its base; part it into tets",
                    pyramid.tag
                ));
            }
            before.push([base, apex]);
        }
    }
    before.sort_unstable();
    before.dedup();
    Ok(before)
}

/// The columns in an order that holds all pairs, else the smallest first.
fn ordered(members: &BTreeMap<usize, Vec<usize>>, before: Vec<[usize; 2]>) -> Result<Vec<usize>, String> {
    let mut waits: BTreeMap<usize, usize> = members.keys().map(|&column| (column, 0)).collect();
    for [_, later] in &before {
        *waits.entry(*later).or_default() += 1;
    }
    let mut free: BinaryHeap<Reverse<usize>> =
        waits.iter().filter(|(_, count)| **count == 0).map(|(&column, _)| Reverse(column)).collect();
    let mut ordered = Vec::new();
    while let Some(Reverse(column)) = free.pop() {
        ordered.push(column);
        let first = before.partition_point(|pair| pair[0] < column);
        for [_, later] in before[first..].iter().take_while(|pair| pair[0] == column) {
            if let Some(count) = waits.get_mut(later) {
                *count -= 1;
                if *count == 0 {
                    free.push(Reverse(*later));
                }
            }
        }
    }
    if ordered.len() == waits.len() {
        return Ok(ordered);
    }
    Err("pyramids stand on one another in a circle, and no order of their corners collapses all at their apexes; part some into tets".to_owned())
}

/// Corners that edges of prisms join: each by the smallest of them.
struct Columns {
    parent: Vec<usize>,
}

impl Columns {
    fn root(&mut self, node: usize) -> usize {
        let mut root = node;
        while self.parent[root] != root {
            root = self.parent[root];
        }
        let mut at = node;
        while self.parent[at] != root {
            at = std::mem::replace(&mut self.parent[at], root);
        }
        root
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
    }
}
