//! Structured blocks as hexes.

use glam::DVec3;
use rustc_hash::FxHashMap;

use crate::element::Cell;
use crate::formats::assembly::Assembly;
use crate::formats::error::Fault;
use crate::mesh::{EntityKey, Mesh, NodeId, Zone};

/// A block of `size` points, the first index fastest.
pub(super) struct Block {
    size: [usize; 3],
    pub(super) points: Vec<DVec3>,
    /// Points whose iblank is 0.
    pub(super) blanked: usize,
}

impl Block {
    pub(super) fn new(size: [usize; 3]) -> Block {
        Block { size, points: Vec::new(), blanked: 0 }
    }

    /// Number of points.
    pub(super) fn count(&self) -> usize {
        self.size.iter().fold(1, |product, &n| product.saturating_mul(n))
    }

    /// Makes room for the points, whose number was checked.
    pub(super) fn allocate(&mut self, count: usize) {
        self.points = vec![DVec3::ZERO; count];
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.size[0] * (j + self.size[1] * k)
    }

    /// All cells, by their lowest corner.
    fn cells(&self) -> impl Iterator<Item = [usize; 3]> + use<> {
        let [ni, nj, nk] = self.size.map(|n| n - 1);
        (0..nk).flat_map(move |k| (0..nj).flat_map(move |j| (0..ni).map(move |i| [i, j, k])))
    }

    /// The points of a cell's corners, in the hex's order.
    fn corners(&self, cell: [usize; 3]) -> [usize; 8] {
        let mut corners = [0; 8];
        for (place, corner) in corners.iter_mut().zip(Cell::Hex.corners()) {
            *place = self.index(std::array::from_fn(|axis| cell[axis] + usize::from(corner[axis])));
        }
        corners
    }

    /// Which sides a cell lies on: for each, the corners of its face.
    fn sides(&self, cell: [usize; 3]) -> impl Iterator<Item = (usize, [u8; 4])> {
        let size = self.size;
        (0..6).filter_map(move |side| {
            let (axis, end) = (side / 2, side % 2);
            let outermost = if end == 0 { 0 } else { size[axis] - 2 };
            let face = Cell::Hex.faces().iter().find(|face| {
                face.corners.iter().all(|&c| usize::from(Cell::Hex.corners()[usize::from(c)][axis]) == end)
            })?;
            let corners: [u8; 4] = face.corners.try_into().ok()?;
            (cell[axis] == outermost).then_some((side, corners))
        })
    }
}

/// Sides of a block, as patches are named after them.
const SIDES: [&str; 6] = ["imin", "imax", "jmin", "jmax", "kmin", "kmax"];

/// The mesh of all blocks.
pub(super) fn mesh(blocks: Vec<Block>) -> Result<Mesh, Fault> {
    let (points, nodes, joined) = merged(&blocks)?;
    let mut assembly = Assembly::new(points)?;
    let mut faces: FxHashMap<[NodeId; 4], u32> = FxHashMap::default();
    let key = |mut corners: [NodeId; 4]| {
        corners.sort_unstable();
        corners
    };
    let each_face = |b: usize, visit: &mut dyn FnMut(usize, [NodeId; 4])| {
        let (block, nodes): (&Block, &[NodeId]) = (&blocks[b], &nodes[b]);
        for cell in block.cells() {
            let corners = block.corners(cell).map(|n| nodes[n]);
            block.sides(cell).for_each(|(side, face)| visit(side, face.map(|c| corners[usize::from(c)])));
        }
    };
    for b in 0..blocks.len() {
        each_face(b, &mut |_, corners| *faces.entry(key(corners)).or_default() += 1);
    }
    for (b, block) in blocks.iter().enumerate() {
        for cell in block.cells() {
            let corners = block.corners(cell).map(|n| nodes[b][n]);
            assembly.push(Cell::Hex, EntityKey::new(3, b as i32 + 1), &corners);
        }
    }
    for b in 0..blocks.len() {
        each_face(b, &mut |side, corners| {
            if faces.get(&key(corners)) == Some(&1) {
                assembly.push(Cell::Quad, EntityKey::new(2, (6 * b + side) as i32 + 1), &corners);
            }
        });
        for (side, name) in SIDES.iter().enumerate() {
            let tag = (6 * b + side) as i32 + 1;
            let group = assembly.group(2, &format!("blk-{}_{name}", b + 1), Some(tag));
            assembly.entity(EntityKey::new(2, tag), vec![group]);
        }
    }
    notes(&mut assembly, &blocks, joined);
    if blocks.len() > 1 || joined > 0 {
        let name = |b: usize| format!("/Base/blk-{}", b + 1);
        assembly.parts.zones = nodes.into_iter().enumerate().map(|(b, nodes)| Zone { name: name(b), nodes }).collect();
    }
    assembly.finish()
}

fn notes(assembly: &mut Assembly, blocks: &[Block], joined: usize) {
    let notes = &mut assembly.parts.notes;
    if joined > 0 {
        notes.push(format!("{joined} points on block sides coincide exactly with others and were merged with them"));
    }
    let blanked: usize = blocks.iter().map(|block| block.blanked).sum();
    if blanked > 0 {
        notes.push(format!("{blanked} points are blanked out (iblank 0); they are kept"));
    }
}

/// The points of all blocks, each place on a side once; the node of each block's points; how many were joined.
type Merged = (Vec<DVec3>, Vec<Vec<NodeId>>, usize);

fn merged(blocks: &[Block]) -> Result<Merged, Fault> {
    let mut points: Vec<DVec3> = Vec::new();
    let mut nodes = Vec::new();
    let mut known: FxHashMap<[u64; 3], NodeId> = FxHashMap::default();
    let mut joined = 0;
    for block in blocks {
        let mut own = Vec::with_capacity(block.points.len());
        for (n, &point) in block.points.iter().enumerate() {
            let node = NodeId::new(points.len())?;
            let [ni, nj, nk] = block.size;
            let at = [n % ni, n / ni % nj, n / (ni * nj)];
            let on_side = [ni, nj, nk].iter().zip(at).any(|(&size, n)| n == 0 || n + 1 == size);
            let bits = point.to_array().map(|x| (x + 0.0).to_bits()); // -0 and 0 are one place
            let node = if on_side { *known.entry(bits).or_insert(node) } else { node };
            if node.index() == points.len() {
                points.push(point);
            } else {
                joined += 1;
            }
            own.push(node);
        }
        nodes.push(own);
    }
    Ok((points, nodes, joined))
}
