//! P1 to Pp: new nodes on the equispaced lattice of every edge, face and cell, all still straight.
//!
//! The elevated, unperturbed mesh is the paper's computational copy (§2.2): the targets are taken from it.
//! Linear nodes keep their places and numbers; a new node is made when its carrier (the edge, face or cell that it
//! lies in) is first met, entities of low dimension first, so that it is classified on the lowest one that holds it.

use glam::DVec3;
use rayon::prelude::*;

use crate::element::{Cell, InteriorSlots, Order, basis, canonical, interior_start};
use crate::mesh::{Block, EntityKey, Mesh, NodeId, TooMany};

/// Carriers whose new nodes are placed at a time: what they take while they wait does not grow with the mesh.
const BATCH: usize = 1 << 16;

/// An elevated mesh and where its new nodes came from.
#[derive(Clone, Debug)]
pub struct Elevated {
    /// The mesh of order p, every node at its straight place.
    pub mesh: Mesh,
    /// Number of nodes of the linear mesh; they come first.
    pub linear_nodes: usize,
    /// Number of nodes up to the last on the boundary: new nodes of the boundary follow the linear nodes.
    pub boundary_nodes: usize,
    /// The edges, faces and cells that hold new nodes, one list a cell kind.
    pub carriers: Vec<Carriers>,
}

/// Edges, faces or cells of one kind, and the new nodes inside each.
#[derive(Clone, Debug)]
pub struct Carriers {
    /// Their kind.
    pub cell: Cell,
    /// Linear nodes at their corners, `cell.corner_count()` each, in canonical order.
    corners: Vec<NodeId>,
    /// The first of each carrier's new nodes; the others follow it.
    first: Vec<NodeId>,
    /// Weights of the corners at each of the new nodes.
    weights: Vec<Vec<f64>>,
}

/// Carriers by their first corner: lists through all carriers of a kind, 4 bytes a carrier where a hash table takes 40.
#[derive(Default)]
struct Chains {
    /// The newest carrier of each linear node, and the one before each; `u32::MAX` ends a list.
    newest: Vec<u32>,
    before: Vec<u32>,
}

impl Chains {
    /// The carrier with these corners in canonical order.
    fn find(&self, carriers: &Carriers, corners: &[NodeId]) -> Option<NodeId> {
        let stride = corners.len();
        let mut at = *self.newest.get(corners[0].index())?;
        while at != u32::MAX {
            let own = at as usize;
            if carriers.corners[own * stride..][..stride] == *corners {
                return Some(carriers.first[own]);
            }
            at = self.before[own];
        }
        None
    }

    /// Takes in the carrier that was made last.
    fn push(&mut self, linear_nodes: usize, first_corner: NodeId) {
        if self.newest.is_empty() {
            self.newest = vec![u32::MAX; linear_nodes];
        }
        let newest = &mut self.newest[first_corner.index()];
        let own = self.before.len() as u32; // fewer carriers than new nodes, and these fit 32 bits
        self.before.push(*newest);
        *newest = own;
    }
}

impl Carriers {
    fn new(cell: Cell, order: Order) -> Carriers {
        let weights = basis::at_lattice(cell, Order::LINEAR, order).split_off(interior_start(cell, order));
        Carriers { cell, corners: Vec::new(), first: Vec::new(), weights }
    }

    /// Number of new nodes inside each.
    #[must_use]
    pub fn inside(&self) -> usize {
        self.weights.len()
    }

    /// Number of carriers.
    #[must_use]
    pub fn len(&self) -> usize {
        self.first.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.first.is_empty()
    }

    /// Weights of a carrier's corners at each of its new nodes.
    #[must_use]
    pub fn weights(&self) -> &[Vec<f64>] {
        &self.weights
    }

    /// A carrier by its number: corners, and first new node.
    #[must_use]
    pub fn get(&self, carrier: usize) -> (&[NodeId], NodeId) {
        let corners = self.cell.corner_count();
        (&self.corners[carrier * corners..][..corners], self.first[carrier])
    }

    /// The carriers: corners, and first new node.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&[NodeId], NodeId)> {
        self.corners.chunks_exact(self.cell.corner_count()).zip(self.first.iter().copied())
    }
}

/// Elevates a linear mesh.
///
/// # Errors
/// [`TooMany`] when the nodes no longer fit 32 bits.
pub fn elevate(linear: &Mesh, order: Order) -> Result<Elevated, TooMany> {
    let mut builder = Builder::new(linear, order);
    let mut blocks: Vec<Option<Block>> = vec![None; linear.blocks.len()];
    let mut boundary_nodes = linear.points.len();
    for dimension in 0..=3 {
        if dimension == 3 {
            boundary_nodes = builder.mesh.node_tags.len();
        }
        for (place, block) in linear.blocks_of(dimension) {
            blocks[place] = Some(builder.block(block)?);
        }
    }
    builder.place();
    let mut mesh = builder.mesh;
    mesh.blocks = blocks.into_iter().flatten().collect();
    Ok(Elevated { mesh, linear_nodes: linear.points.len(), boundary_nodes, carriers: builder.carriers })
}

struct Builder {
    order: Order,
    mesh: Mesh,
    next_tag: u64,
    carriers: Vec<Carriers>,
    linear_nodes: usize,
    /// The carriers that several elements share: edges, triangles and quadrilaterals.
    chains: [Chains; Cell::ALL.len()],
    slots: [InteriorSlots; Cell::ALL.len()],
}

impl Builder {
    fn new(linear: &Mesh, order: Order) -> Builder {
        let mesh = Mesh {
            order,
            points: linear.points.clone(),
            node_tags: linear.node_tags.clone(),
            node_entities: linear.node_entities.clone(),
            node_parameters: linear.node_parameters.clone(),
            blocks: Vec::new(),
            entities: linear.entities.clone(),
            physical_names: linear.physical_names.clone(),
            periodic: linear.periodic.clone(),
            conditions: linear.conditions.clone(),
            zones: linear.zones.clone(),
            notes: linear.notes.clone(),
        };
        let next_tag = linear.node_tags.iter().max().map_or(1, |tag| tag + 1);
        let carriers = Cell::ALL.iter().map(|&cell| Carriers::new(cell, order)).collect();
        let (linear_nodes, chains, slots) = (linear.points.len(), Default::default(), Default::default());
        Builder { order, mesh, next_tag, carriers, linear_nodes, chains, slots }
    }

    fn block(&mut self, linear: &Block) -> Result<Block, TooMany> {
        let mut nodes = Vec::with_capacity(linear.tags.len() * linear.cell.node_count(self.order));
        for corners in linear.elements(Order::LINEAR) {
            self.element(linear.cell, corners, linear.entity, &mut nodes)?;
        }
        Ok(Block { nodes, ..linear.clone() })
    }

    /// Appends an element's nodes, making those that are new.
    fn element(
        &mut self,
        cell: Cell,
        corners: &[NodeId],
        entity: EntityKey,
        nodes: &mut Vec<NodeId>,
    ) -> Result<(), TooMany> {
        nodes.extend_from_slice(corners);
        for &[a, b] in cell.edges() {
            let ends = [corners[usize::from(a)], corners[usize::from(b)]];
            self.shared(Cell::Line, &ends, entity, nodes)?;
        }
        for face in cell.faces() {
            let mut seen = [NodeId::default(); 4];
            for (slot, &corner) in seen.iter_mut().zip(face.corners) {
                *slot = corners[usize::from(corner)];
            }
            self.shared(face.cell, &seen[..face.corners.len()], entity, nodes)?;
        }
        if cell.dimension() == 3 && self.carriers[cell as usize].inside() > 0 {
            let first = self.create(cell, corners, entity)?;
            for node in first.index()..first.index() + self.carriers[cell as usize].inside() {
                nodes.push(NodeId::new(node)?);
            }
        }
        Ok(())
    }

    /// Appends the interior nodes of an edge or a face, in the order in which this element sees them.
    fn shared(
        &mut self,
        cell: Cell,
        corners: &[NodeId],
        entity: EntityKey,
        nodes: &mut Vec<NodeId>,
    ) -> Result<(), TooMany> {
        if self.carriers[cell as usize].inside() == 0 {
            return Ok(());
        }
        let seen = canonical(corners);
        let mut key = [NodeId::NONE; 4];
        for (slot, &q) in key.iter_mut().zip(&seen[..corners.len()]) {
            *slot = corners[usize::from(q)];
        }
        let key = &key[..corners.len()];
        let first = match self.chains[cell as usize].find(&self.carriers[cell as usize], key) {
            Some(first) => first,
            None => {
                let first = self.create(cell, key, entity)?;
                self.chains[cell as usize].push(self.linear_nodes, key[0]);
                first
            }
        };
        for slot in self.slots[cell as usize].of(cell, self.order, seen) {
            nodes.push(NodeId::new(first.index() + slot)?);
        }
        Ok(())
    }

    /// Makes a carrier's new nodes; their places are computed at the end.
    fn create(&mut self, cell: Cell, corners: &[NodeId], entity: EntityKey) -> Result<NodeId, TooMany> {
        let carriers = &mut self.carriers[cell as usize];
        let first = NodeId::new(self.mesh.node_tags.len())?;
        NodeId::new(first.index() + carriers.inside())?;
        carriers.corners.extend_from_slice(corners);
        carriers.first.push(first);
        for _ in 0..carriers.inside() {
            self.mesh.node_tags.push(self.next_tag);
            self.mesh.node_entities.push(Some(entity));
            self.next_tag += 1;
        }
        Ok(first)
    }

    /// Puts all new nodes at their straight places.
    fn place(&mut self) {
        let points = &mut self.mesh.points;
        points.resize(self.mesh.node_tags.len(), DVec3::ZERO);
        for carriers in self.carriers.iter().filter(|carriers| carriers.inside() > 0) {
            for begin in (0..carriers.len()).step_by(BATCH) {
                let batch = begin..carriers.len().min(begin + BATCH);
                let straight = |carrier: usize| {
                    let (corners, _) = carriers.get(carrier);
                    let at =
                        |weights: &Vec<f64>| corners.iter().zip(weights).map(|(n, &w)| points[n.index()] * w).sum();
                    carriers.weights.iter().map(at).collect::<Vec<DVec3>>()
                };
                let own: Vec<Vec<DVec3>> = batch.clone().into_par_iter().with_min_len(256).map(straight).collect();
                for (carrier, own) in batch.zip(own) {
                    points[carriers.first[carrier].index()..][..own.len()].copy_from_slice(&own);
                }
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::{bernstein, lattice};

    /// One element of each kind, corners in an order that is not canonical.
    fn alone(cell: Cell) -> Mesh {
        let points: Vec<DVec3> = cell.corners().iter().map(|c| DVec3::from(c.map(f64::from)) * 2.0).collect();
        let n = points.len();
        let shuffle = |c: usize| (c * 3 + 1) % n;
        let permuted: Vec<DVec3> = (0..n).map(|i| points[(0..n).find(|&c| shuffle(c) == i).unwrap_or(i)]).collect();
        let shuffled = (0..n).map(|c| if n.is_multiple_of(3) { c } else { shuffle(c) });
        let block = Block {
            cell,
            entity: EntityKey::new(cell.dimension() as u8, 7),
            physical_tags: vec![],
            tags: vec![1],
            nodes: shuffled.map(|c| NodeId::new(c).unwrap()).collect(),
        };
        Mesh {
            points: if n.is_multiple_of(3) { points } else { permuted },
            node_tags: (1..=n as u64).collect(),
            node_entities: vec![None; n],
            blocks: vec![block],
            ..Mesh::default()
        }
    }

    #[test]
    fn nodes_land_on_the_lattice() {
        for cell in [Cell::Line, Cell::Triangle, Cell::Quad].into_iter().chain(Cell::VOLUME) {
            for order in Order::all() {
                let linear = alone(cell);
                let elevated = elevate(&linear, order).unwrap();
                let nodes = &elevated.mesh.blocks[0].nodes;
                assert_eq!(nodes.len(), cell.node_count(order));
                for (slot, at) in lattice(cell, order).iter().enumerate() {
                    let unit = at.map(|x| f64::from(x) / order.get() as f64);
                    let weights = basis::values(cell, Order::LINEAR, bernstein::chart(cell, unit));
                    let corners = &linear.blocks[0].nodes;
                    let expected: DVec3 = corners.iter().zip(weights).map(|(c, w)| linear.points[c.index()] * w).sum();
                    let point = elevated.mesh.points[nodes[slot].index()];
                    assert!(point.distance(expected) < 1e-13, "{cell} {order} node {slot}");
                }
            }
        }
    }

    /// ```text
    /// 3---2    two triangles under two tets would do; here two triangles share the edge 0-2
    /// | / |
    /// 0---1
    /// ```
    #[test]
    fn neighbours_share_the_nodes_between_them() {
        let id = |n: usize| NodeId::new(n).unwrap();
        let block = Block {
            cell: Cell::Triangle,
            entity: EntityKey::new(2, 1),
            physical_tags: vec![],
            tags: vec![1, 2],
            nodes: [0, 1, 2, 2, 3, 0].map(id).to_vec(),
        };
        let linear = Mesh {
            points: vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y],
            node_tags: vec![4, 1, 9, 2],
            node_entities: vec![None; 4],
            blocks: vec![block],
            ..Mesh::default()
        };
        let elevated = elevate(&linear, Order::MAX).unwrap();
        let mesh = &elevated.mesh;
        // 4 corners, 5 edges with 3 nodes, 2 triangles with 3.
        assert_eq!(mesh.points.len(), 4 + 15 + 6);
        assert_eq!(mesh.node_tags[4], 10);
        let [a, b]: [Vec<NodeId>; 2] = std::array::from_fn(|e| mesh.blocks[0].nodes[e * 15..(e + 1) * 15].to_vec());
        assert_eq!(a[9..12], b[9..12].iter().rev().copied().collect::<Vec<_>>()[..], "edge 2-0 seen from both sides");
        for (corners, first) in elevated.carriers[Cell::Line as usize].iter() {
            assert!(corners[0] < corners[1] && first.index() >= 4);
        }
    }
}
