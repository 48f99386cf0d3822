//! P1 to Pp: new nodes on the equispaced lattice of every edge, face and cell, all still straight.
//!
//! The elevated, unperturbed mesh is the paper's computational copy (§2.2): the targets are taken from it.
//! Linear nodes keep their places and numbers; a new node is made when its carrier (the edge, face or cell that it
//! lies in) is first met, entities of low dimension first, so that it is classified on the lowest one that holds it.

use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::{Block, EntityKey, FaceKey, Mesh, NodeId, Parts, TooMany};
use crate::element::{Cell, InteriorSlots, Order, basis, interior_start};

/// Elements whose sides are looked up at a time: what they take while they wait does not grow with the mesh.
const BATCH: usize = 1 << 12;
/// Elements or carriers that are worth a task of their own.
const TASK: usize = 256;

/// An elevated mesh and where its new nodes came from.
#[derive(Clone, Debug)]
pub struct Elevated {
    /// The mesh of order p, every node at its straight position.
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
    /// The first new node of the carrier with these corners in canonical order, sought among the carriers from `since` on.
    fn find(&self, carriers: &Carriers, corners: &[NodeId], since: usize) -> Option<NodeId> {
        let stride = corners.len();
        let mut at = *self.newest.get(corners[0].index())?;
        while at != u32::MAX && at as usize >= since {
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
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&[NodeId], NodeId)> + Clone {
        self.corners.chunks_exact(self.cell.corner_count()).zip(self.first.iter().copied())
    }

    /// Lets `write` give values to the new nodes inside each carrier, many at once. `values` are those of the nodes from number
    /// `offset` on, the number of linear nodes; carriers behind their end are left out.
    pub fn fill<T: Send>(&self, values: &mut [T], offset: usize, write: &(impl Fn(usize, &mut [T]) + Sync)) {
        let end = offset + values.len();
        let held = self.first.partition_point(|first| first.index() + self.inside() <= end);
        if self.inside() > 0 {
            self.fill_some(0..held, values, offset, write);
        }
    }

    /// [`Carriers::fill`] for some carriers: the numbers of their nodes rise, so that half of them is a part of the values.
    fn fill_some<T: Send>(
        &self,
        some: Range<usize>,
        values: &mut [T],
        offset: usize,
        write: &(impl Fn(usize, &mut [T]) + Sync),
    ) {
        if some.len() <= TASK {
            return some.for_each(|carrier| {
                write(carrier, &mut values[self.first[carrier].index() - offset..][..self.inside()]);
            });
        }
        let middle = some.start + some.len() / 2;
        let border = self.first[middle].index();
        let (low, high) = values.split_at_mut(border - offset);
        rayon::join(
            || self.fill_some(some.start..middle, low, offset, write),
            || self.fill_some(middle..some.end, high, border, write),
        );
    }
}

/// Elevates a linear mesh.
///
/// # Errors
/// [`TooMany`] when the nodes no longer fit 32 bits.
pub fn elevate(linear: &Mesh, order: Order) -> Result<Elevated, TooMany> {
    let mut builder = Builder::new(linear, order);
    let mut blocks: Vec<Option<Block>> = vec![None; linear.blocks().len()];
    let mut boundary_nodes = linear.points().len();
    for dimension in 0..=linear.dimension() {
        if dimension == linear.dimension() {
            boundary_nodes = builder.mesh.node_tags.len();
        }
        for (place, block) in linear.blocks_of(dimension) {
            blocks[place] = Some(builder.block(block)?);
        }
    }
    builder.place();
    let parts = Parts { blocks: blocks.into_iter().flatten().collect(), ..builder.mesh };
    Ok(Elevated {
        mesh: Mesh { parts },
        linear_nodes: linear.points().len(),
        boundary_nodes,
        carriers: builder.carriers,
    })
}

struct Builder {
    order: Order,
    mesh: Parts,
    next_tag: u64,
    carriers: Vec<Carriers>,
    linear_nodes: usize,
    /// The carriers that several elements share: edges, triangles and quadrilaterals.
    chains: [Chains; Cell::ALL.len()],
    slots: [InteriorSlots; Cell::ALL.len()],
}

/// An edge or face of a cell that holds new nodes.
struct Side {
    cell: Cell,
    /// Its corners among the cell's.
    corners: Vec<u8>,
}

/// A side of an element.
#[derive(Clone, Copy, Default)]
struct Seat {
    /// Its corners.
    key: FaceKey,
    /// Their order in the key, as positions in the corners as the element sees them.
    seen: [u8; 4],
    /// The first of its new nodes; [`NodeId::NONE`] until it is known.
    first: NodeId,
}

impl Builder {
    fn new(linear: &Mesh, order: Order) -> Builder {
        let linear = &linear.parts;
        let mesh = Parts {
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
        let slots = Cell::ALL.map(|cell| InteriorSlots::new(cell, order));
        let (linear_nodes, chains) = (linear.points.len(), Default::default());
        Builder { order, mesh, next_tag, carriers, linear_nodes, chains, slots }
    }

    /// Elevates a block: by batches of elements, whose sides are looked up and whose nodes are listed on all threads; between
    /// the two the new nodes are made, one after the other.
    fn block(&mut self, linear: &Block) -> Result<Block, TooMany> {
        let (corners, stride) = (linear.cell.corner_count(), linear.cell.node_count(self.order));
        let sides = self.sides(linear.cell);
        let mut nodes = bytemuck::zeroed_vec(linear.nodes.len() / corners * stride);
        let mut seats = Vec::new();
        for (elements, nodes) in linear.nodes.chunks(BATCH * corners).zip(nodes.chunks_mut(BATCH * stride)) {
            self.look_up(linear.cell, &sides, elements, &mut seats);
            let made = self.carriers[linear.cell as usize].len();
            self.make(linear, &sides, elements, &mut seats)?;
            self.list(linear.cell, &sides, elements, &seats, made, nodes)?;
        }
        Ok(Block { nodes, ..linear.clone() })
    }

    /// The sides of a cell that hold new nodes, in the order of these nodes.
    fn sides(&self, cell: Cell) -> Vec<Side> {
        let edges = cell.edges().iter().map(|edge| Side { cell: Cell::Line, corners: edge.to_vec() });
        let faces = cell.faces().iter().map(|face| Side { cell: face.cell, corners: face.corners.to_vec() });
        edges.chain(faces).filter(|side| self.carriers[side.cell as usize].inside() > 0).collect()
    }

    /// Finds the sides of elements among the carriers made so far.
    fn look_up(&self, cell: Cell, sides: &[Side], elements: &[NodeId], seats: &mut Vec<Seat>) {
        seats.clear();
        seats.resize(elements.len() / cell.corner_count() * sides.len(), Seat::default());
        let of_element = seats.par_chunks_mut(sides.len().max(1)).with_min_len(TASK);
        of_element.zip(elements.par_chunks(cell.corner_count())).for_each(|(seats, element)| {
            for (seat, side) in seats.iter_mut().zip(sides) {
                *seat = self.seat(side, element);
            }
        });
    }

    fn seat(&self, side: &Side, element: &[NodeId]) -> Seat {
        let mut corners = [NodeId::NONE; 4];
        for (slot, &q) in corners.iter_mut().zip(&side.corners) {
            *slot = element[usize::from(q)];
        }
        let count = side.corners.len();
        let (key, seen) = FaceKey::seen(&corners[..count]);
        let first = self.chains[side.cell as usize].find(&self.carriers[side.cell as usize], key.corners(), 0);
        Seat { key, seen, first: first.unwrap_or(NodeId::NONE) }
    }

    /// Makes the new nodes of the sides that were not found, and those inside the elements.
    fn make(&mut self, linear: &Block, sides: &[Side], elements: &[NodeId], seats: &mut [Seat]) -> Result<(), TooMany> {
        let (cell, entity) = (linear.cell, linear.entity);
        let since: [usize; Cell::ALL.len()] = std::array::from_fn(|cell| self.carriers[cell].len());
        for (n, corners) in elements.chunks(cell.corner_count()).enumerate() {
            let seats = &mut seats[n * sides.len()..][..sides.len()];
            for (seat, side) in seats.iter_mut().zip(sides).filter(|(seat, _)| seat.first == NodeId::NONE) {
                let (kind, key) = (side.cell as usize, seat.key.corners());
                let known = self.chains[kind].find(&self.carriers[kind], key, since[kind]);
                seat.first = match known {
                    Some(first) => first,
                    None => {
                        let first = self.create(side.cell, key, entity)?;
                        self.chains[kind].push(self.linear_nodes, key[0]);
                        first
                    }
                };
            }
            if cell.dimension() == 3 && self.carriers[cell as usize].inside() > 0 {
                self.create(cell, corners, entity)?;
            }
        }
        Ok(())
    }

    /// Lists the nodes of elements; `made` is the number of carriers of their kind before the first of them.
    fn list(
        &self,
        cell: Cell,
        sides: &[Side],
        elements: &[NodeId],
        seats: &[Seat],
        made: usize,
        nodes: &mut [NodeId],
    ) -> Result<(), TooMany> {
        let (corners, inner) = (cell.corner_count(), &self.carriers[cell as usize]);
        let of_element = nodes.par_chunks_mut(cell.node_count(self.order)).with_min_len(TASK).enumerate();
        of_element.zip(elements.par_chunks(corners)).try_for_each(|((n, nodes), element)| {
            nodes[..corners].copy_from_slice(element);
            let mut rest = nodes[corners..].iter_mut();
            for (seat, side) in seats[n * sides.len()..].iter().zip(sides) {
                for (slot, node) in self.slots[side.cell as usize].of(seat.seen).iter().zip(rest.by_ref()) {
                    *node = NodeId::new(seat.first.index() + slot)?;
                }
            }
            if let Some(first) = inner.first.get(made + n).filter(|_| cell.dimension() == 3) {
                for (node, place) in rest.zip(first.index()..) {
                    *node = NodeId::new(place)?;
                }
            }
            Ok(())
        })
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

    /// Puts all new nodes at their straight positions.
    fn place(&mut self) {
        let points = &mut self.mesh.points;
        points.resize(self.mesh.node_tags.len(), DVec3::ZERO);
        let (linear, new) = points.split_at_mut(self.linear_nodes);
        for carriers in &self.carriers {
            carriers.fill(new, self.linear_nodes, &|carrier, inside| {
                let (corners, _) = carriers.get(carrier);
                for (point, weights) in inside.iter_mut().zip(&carriers.weights) {
                    *point = corners.iter().zip(weights).map(|(n, &w)| linear[n.index()] * w).sum();
                }
            });
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
        let entity = EntityKey::new(cell.dimension() as u8, 7);
        let nodes = shuffled.map(|c| NodeId::new(c).unwrap()).collect();
        let block = Block { tags: vec![1], nodes, ..Block::new(cell, entity) };
        let points = if n.is_multiple_of(3) { points } else { permuted };
        Mesh::new(Parts { points, blocks: vec![block], ..Parts::default() }).unwrap()
    }

    #[test]
    fn nodes_land_on_the_lattice() {
        for cell in [Cell::Line, Cell::Triangle, Cell::Quad].into_iter().chain(Cell::VOLUME) {
            for order in Order::all() {
                let linear = alone(cell);
                let elevated = elevate(&linear, order).unwrap();
                let nodes = &elevated.mesh.blocks()[0].nodes;
                assert_eq!(nodes.len(), cell.node_count(order));
                for (slot, at) in lattice(cell, order).iter().enumerate() {
                    let unit = at.map(|x| f64::from(x) / order.get() as f64);
                    let weights = basis::values(cell, Order::LINEAR, bernstein::chart(cell, unit));
                    let corners = &linear.blocks()[0].nodes;
                    let expected: DVec3 =
                        corners.iter().zip(weights).map(|(c, w)| linear.points()[c.index()] * w).sum();
                    let point = elevated.mesh.points()[nodes[slot].index()];
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
        let nodes = [0, 1, 2, 2, 3, 0].map(id).to_vec();
        let block = Block { tags: vec![1, 2], nodes, ..Block::new(Cell::Triangle, EntityKey::new(2, 1)) };
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
        let parts = Parts { points, node_tags: vec![4, 1, 9, 2], blocks: vec![block], ..Parts::default() };
        let linear = Mesh::new(parts).unwrap();
        let elevated = elevate(&linear, Order::MAX).unwrap();
        let mesh = &elevated.mesh;
        // 4 corners, 5 edges with 3 nodes, 2 triangles with 3.
        assert_eq!(mesh.points().len(), 4 + 15 + 6);
        assert_eq!(mesh.node_tags()[4], 10);
        let [a, b]: [Vec<NodeId>; 2] = std::array::from_fn(|e| mesh.blocks()[0].nodes[e * 15..(e + 1) * 15].to_vec());
        assert_eq!(a[9..12], b[9..12].iter().rev().copied().collect::<Vec<_>>()[..], "edge 2-0 seen from both sides");
        for (corners, first) in elevated.carriers[Cell::Line as usize].iter() {
            assert!(corners[0] < corners[1] && first.index() >= 4);
        }
    }
}
