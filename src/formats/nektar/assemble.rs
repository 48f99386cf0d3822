//! A mesh from the sections of a file.

use std::collections::BTreeMap;

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::composite::{self, Membership};
use super::curve;
use super::fault::NektarFault;
use super::held::continued;
use super::modified;
use super::shape::{self, Shape};
use super::tables::{Row, Tables};
use crate::element::{Cell, InteriorSlots, Order, basis, edge_nodes, interior_count, interior_start, side_nodes};
use crate::formats::assembly::Assembly;
use crate::formats::error::Fault;
use crate::mesh::elevate::elevate;
use crate::mesh::{EntityKey, FaceKey, Mesh, NodeId, Parts};

/// Bytes that a node of an element takes: its number, and a share of its point.
const NODE: u64 = 16;

/// A mesh of what a file holds; it may take `memory` bytes.
///
/// # Errors
/// Sections that do not fit one another.
pub(super) fn mesh(tables: Tables, memory: u64) -> Result<Mesh, Fault> {
    let order = order(&tables)?;
    let topology = Topology::of(&tables)?;
    if order.get() > 2 && topology.cells.iter().any(|(shape, _)| shape.cell == Cell::Pyramid) {
        return Err(NektarFault::Pyramids.into());
    }
    let nodes = topology.cells.iter().map(|(shape, _)| shape.cell.node_count(order) as u64);
    let needed = nodes.sum::<u64>().saturating_mul(NODE);
    if needed > memory {
        return Err(NektarFault::Memory { needed: needed >> 20, limit: memory >> 20 }.into());
    }
    let mut assembly = Assembly::new(tables.vertices.iter().map(|&(_, x)| x).collect())?;
    elements(&mut assembly, &tables, &topology)?;
    if order > Order::LINEAR {
        let linear = Mesh::new(assembly.parts.clone())?;
        let mut parts = elevate(&linear, order)?.mesh.into_parts();
        Curved::new(order, &tables, &topology, &parts.points)?.place(&mut parts);
        let Parts { order, points, node_tags, node_entities, blocks, .. } = parts;
        assembly.parts = Parts { order, points, node_tags, node_entities, blocks, ..assembly.parts };
    }
    assembly.finish()
}

/// The order of the curves, which must be one.
fn order(tables: &Tables) -> Result<Order, Fault> {
    let mut order: Option<Order> = None;
    let edges = tables.curved_edges.iter().map(curve::edge_order);
    let cells: FxHashMap<i64, &str> = faces(tables).iter().map(|row| (row.id, row.letter.as_str())).collect();
    let faces = tables.curved_faces.iter().map(|own| {
        let cell = if cells.get(&own.id) == Some(&"Q") { Cell::Quad } else { Cell::Triangle };
        curve::face_order(cell, own)
    });
    for here in edges.chain(faces) {
        let here = here?;
        let known = *order.get_or_insert(here);
        if known != here {
            return Err(Fault::MixedOrders { order: known, here });
        }
    }
    Ok(order.unwrap_or_default())
}

/// The faces: in a plane mesh the elements.
fn faces(tables: &Tables) -> &[Row] {
    if tables.dimension == 2 { &tables.elements } else { &tables.faces }
}

/// Who has which corners.
struct Topology {
    edges: FxHashMap<i64, [NodeId; 2]>,
    /// Places of the numbers of edges.
    edge_places: FxHashMap<i64, usize>,
    /// Corners of the faces.
    faces: Vec<(Cell, Vec<NodeId>)>,
    face_places: FxHashMap<i64, usize>,
    /// The elements with their corners, in internal order.
    cells: Vec<(&'static Shape, Vec<NodeId>)>,
    cell_places: FxHashMap<i64, usize>,
}

/// Places of numbers that must differ.
fn places(section: &'static str, ids: impl Iterator<Item = i64>) -> Result<FxHashMap<i64, usize>, NektarFault> {
    let mut places = FxHashMap::default();
    for (place, id) in ids.enumerate() {
        if places.insert(id, place).is_some() {
            return Err(NektarFault::Twice { section, id });
        }
    }
    Ok(places)
}

impl Topology {
    fn of(tables: &Tables) -> Result<Topology, Fault> {
        NodeId::new(tables.vertices.len())?;
        let vertices = places("VERTEX", tables.vertices.iter().map(|own| own.0))?;
        let edge_places = places("EDGE", tables.edges.iter().map(|own| own.0))?;
        let mut edges = FxHashMap::default();
        for &(id, ends) in &tables.edges {
            let node = |wrong: i64| -> Result<NodeId, Fault> {
                let place = vertices.get(&wrong);
                let unknown = NektarFault::Unknown { section: "EDGE", id, what: "vertex", wrong };
                Ok(NodeId::new(*place.ok_or(unknown)?)?)
            };
            edges.insert(id, [node(ends[0])?, node(ends[1])?]);
        }
        let face_rows = faces(tables);
        let face_places = places("FACE", face_rows.iter().map(|row| row.id))?;
        let loops: Vec<_> = face_rows.iter().map(|row| closed(row, &edges)).collect::<Result<_, _>>()?;
        let cell_places = places("ELEMENT", tables.elements.iter().map(|row| row.id))?;
        let mut cells = Vec::with_capacity(tables.elements.len());
        for (place, row) in tables.elements.iter().enumerate() {
            let shape = shape::lettered(&row.letter).filter(|shape| shape.cell.dimension() == tables.dimension);
            let letter = || NektarFault::Letter { section: "ELEMENT", id: row.id, letter: row.letter.clone() };
            let shape = shape.ok_or_else(letter)?;
            let corners = match tables.dimension {
                2 => loops[place].1.clone(),
                _ => solid(row, shape, &face_places, &loops)?,
            };
            cells.push((shape, corners));
        }
        Ok(Topology { edges, edge_places, faces: loops, face_places, cells, cell_places })
    }
}

/// The corners of a face from its edges, each of which begins where the one before ends.
fn closed(row: &Row, edges: &FxHashMap<i64, [NodeId; 2]>) -> Result<(Cell, Vec<NodeId>), NektarFault> {
    let (section, id) = ("FACE", row.id);
    let shape = shape::lettered(&row.letter).filter(|shape| shape.cell.is_flat());
    let shape = shape.ok_or_else(|| NektarFault::Letter { section, id, letter: row.letter.clone() })?;
    let edge =
        |&wrong: &i64| edges.get(&wrong).copied().ok_or(NektarFault::Unknown { section, id, what: "edge", wrong });
    let own: Vec<[NodeId; 2]> = row.bounds.iter().map(edge).collect::<Result<_, _>>()?;
    let open = || NektarFault::Open { section, id, what: "edges" };
    let begin = |n: usize| {
        let next = own[(n + 1) % own.len()];
        own[n].into_iter().find(|node| !next.contains(node)).ok_or_else(open)
    };
    let corners: Vec<NodeId> = (0..own.len()).map(begin).collect::<Result<_, _>>()?;
    let follows = |n: usize| own[n].contains(&corners[n]) && own[n].contains(&corners[(n + 1) % own.len()]);
    let differ = (0..corners.len()).all(|n| !corners[..n].contains(&corners[n]));
    if differ && (0..own.len()).all(follows) { Ok((shape.cell, corners)) } else { Err(open()) }
}

/// The corners of an element from its faces: each is what those that meet there have in common.
fn solid(
    row: &Row,
    shape: &Shape,
    places: &FxHashMap<i64, usize>,
    faces: &[(Cell, Vec<NodeId>)],
) -> Result<Vec<NodeId>, NektarFault> {
    let (section, id) = ("ELEMENT", row.id);
    let face = |&wrong: &i64| {
        let unknown = NektarFault::Unknown { section, id, what: "face", wrong };
        places.get(&wrong).map(|&place| &faces[place]).ok_or(unknown)
    };
    let own: Vec<&(Cell, Vec<NodeId>)> = row.bounds.iter().map(face).collect::<Result<_, _>>()?;
    let open = || NektarFault::Open { section, id, what: "faces" };
    let corner = |corner: u8| {
        let mut there =
            shape.sides.iter().zip(&own).filter(|(side, _)| side.contains(&corner)).map(|(_, face)| &face.1);
        let mut common: Vec<NodeId> = there.next().cloned().unwrap_or_default();
        there.for_each(|face| common.retain(|node| face.contains(node)));
        if common.len() == 1 { Ok(common[0]) } else { Err(open()) }
    };
    let corners: Vec<NodeId> = (0..shape.cell.corner_count() as u8).map(corner).collect::<Result<_, _>>()?;
    let is_side = |(side, face): (&&[u8], &&(Cell, Vec<NodeId>))| {
        let side: Vec<NodeId> = side.iter().map(|&corner| corners[usize::from(corner)]).collect();
        side.len() == face.1.len() && FaceKey::new(&side) == FaceKey::new(&face.1)
    };
    if shape.sides.iter().zip(&own).all(is_side) { Ok(corners) } else { Err(open()) }
}

/// Takes in the elements and the sides that composites name.
fn elements(assembly: &mut Assembly, tables: &Tables, topology: &Topology) -> Result<(), Fault> {
    let sides = if tables.dimension == 2 { &topology.edge_places } else { &topology.face_places };
    let membership = Membership::of(tables, &topology.cell_places, sides)?;
    let mut entities = Entities::new(tables);
    for (place, (shape, corners)) in topology.cells.iter().enumerate() {
        let own = membership.cells.get(&place).map_or(&[][..], |own| own);
        let entity = entities.of(assembly, tables, tables.dimension, own);
        assembly.push(shape.cell, entity, corners);
    }
    for (place, own) in &membership.sides {
        let entity = entities.of(assembly, tables, tables.dimension - 1, own);
        match tables.dimension {
            2 => assembly.push(Cell::Line, entity, &topology.edges[&tables.edges[*place].0]),
            _ => assembly.push(topology.faces[*place].0, entity, &topology.faces[*place].1),
        }
    }
    if membership.lower > 0 {
        let note = format!("{} composites of vertices or edges are not read", membership.lower);
        assembly.parts.notes.push(note);
    }
    Ok(())
}

/// Entities: one for each set of composites that an element is in.
struct Entities {
    known: BTreeMap<(usize, Vec<usize>), EntityKey>,
    free: i32,
}

impl Entities {
    fn new(tables: &Tables) -> Entities {
        let last = tables.composites.iter().filter_map(|own| i32::try_from(own.id).ok()).max().unwrap_or(0);
        Entities { known: BTreeMap::new(), free: last.max(0).saturating_add(1) }
    }

    /// The entity of elements in these composites, by their places; its groups are made known when it is new.
    fn of(&mut self, assembly: &mut Assembly, tables: &Tables, dimension: usize, own: &[usize]) -> EntityKey {
        if let Some(known) = self.known.get(&(dimension, own.to_vec())) {
            return *known;
        }
        let number = |place: &usize| i32::try_from(tables.composites[*place].id).ok().filter(|&tag| tag > 0);
        let mut next = || {
            self.free = self.free.saturating_add(1);
            self.free - 1
        };
        let tag = match own {
            [one] => number(one).unwrap_or_else(&mut next),
            _ => next(),
        };
        let key = EntityKey::new(dimension as u8, tag);
        let mut groups = Vec::new();
        for place in own {
            let wish = if own.len() == 1 { Some(tag) } else { number(place) };
            match &tables.composites[*place].name {
                Some(name) => {
                    // Cells of several kinds stand in several composites of one name.
                    let lowest = composite::lowest(tables, name, dimension == tables.dimension);
                    let wish = lowest.and_then(|id| i32::try_from(id).ok()).filter(|&id| id > 0).or(wish);
                    groups.push(assembly.group(key.dimension, name, wish));
                }
                None => groups.extend(wish),
            }
        }
        if !groups.is_empty() {
            assembly.entity(key, groups);
        }
        self.known.insert((dimension, own.to_vec()), key);
        key
    }
}

/// Where the nodes of curved edges, faces and elements are.
struct Curved {
    order: Order,
    /// First end, and points inside from there on.
    edges: FxHashMap<[NodeId; 2], (NodeId, Vec<DVec3>)>,
    /// Corners, and points inside in internal order from there on.
    faces: FxHashMap<FaceKey, (Vec<NodeId>, Vec<DVec3>)>,
    slots: [InteriorSlots; 2],
}

fn ends([a, b]: [NodeId; 2]) -> [NodeId; 2] {
    [a.min(b), a.max(b)]
}

impl Curved {
    fn new(order: Order, tables: &Tables, topology: &Topology, points: &[DVec3]) -> Result<Curved, Fault> {
        let slots = [Cell::Triangle, Cell::Quad].map(|cell| InteriorSlots::new(cell, order));
        let mut curved = Curved { order, edges: FxHashMap::default(), faces: FxHashMap::default(), slots };
        for own in &tables.curved_edges {
            let unknown = NektarFault::Unknown { section: "the curve of", id: own.id, what: "edge", wrong: own.id };
            let &edge = topology.edges.get(&own.id).ok_or(unknown)?;
            curved.edges.insert(ends(edge), (edge[0], curve::edge(order, own)?));
        }
        let mut given: FxHashMap<usize, Vec<DVec3>> = FxHashMap::default();
        for own in &tables.curved_faces {
            let unknown = NektarFault::Unknown { section: "the curve of", id: own.id, what: "face", wrong: own.id };
            let &place = topology.face_places.get(&own.id).ok_or(unknown)?;
            given.insert(place, curve::face(topology.faces[place].0, order, own)?);
        }
        for (place, (cell, corners)) in topology.faces.iter().enumerate() {
            let inside = match given.remove(&place) {
                Some(inside) => inside,
                None if curved.touches(*cell, corners) => {
                    continued(modified::interior(*cell, order), &curved.rim(*cell, corners, points))
                }
                None => continue,
            };
            curved.faces.insert(FaceKey::new(corners), (corners.clone(), inside));
        }
        Ok(curved)
    }

    /// The edges of a cell by its corners.
    fn edges_of(cell: Cell, corners: &[NodeId]) -> impl Iterator<Item = [NodeId; 2]> {
        cell.edges().iter().map(|edge| edge.map(|corner| corners[usize::from(corner)]))
    }

    /// Whether an edge of a cell is curved.
    fn touches(&self, cell: Cell, corners: &[NodeId]) -> bool {
        Curved::edges_of(cell, corners).any(|edge| self.edges.contains_key(&ends(edge)))
    }

    /// The points inside an edge, from its first end on.
    fn along(&self, edge: [NodeId; 2]) -> Option<Vec<DVec3>> {
        let (first, inside) = self.edges.get(&ends(edge))?;
        let mut inside = inside.clone();
        if *first != edge[0] {
            inside.reverse();
        }
        Some(inside)
    }

    /// Corners and points on the edges of a face, in internal order.
    fn rim(&self, cell: Cell, corners: &[NodeId], points: &[DVec3]) -> Vec<DVec3> {
        let mut rim: Vec<DVec3> = corners.iter().map(|node| points[node.index()]).collect();
        let weights = basis::at_lattice(Cell::Line, Order::LINEAR, self.order).split_off(2);
        for edge in Curved::edges_of(cell, corners) {
            let [a, b] = edge.map(|node| points[node.index()]);
            rim.extend(self.along(edge).unwrap_or_else(|| weights.iter().map(|w| a * w[0] + b * w[1]).collect()));
        }
        rim
    }

    /// Puts the nodes of all cells where they belong.
    fn place(&self, parts: &mut Parts) {
        let Parts { blocks, points, .. } = parts;
        let top = blocks.iter().map(|block| block.cell.dimension()).max().unwrap_or(0);
        for block in blocks.iter().filter(|block| block.cell.dimension() == top) {
            let (cell, start) = (block.cell, interior_start(block.cell, self.order));
            for nodes in block.elements(self.order) {
                let corners = &nodes[..cell.corner_count()];
                for (edge, slots) in Curved::edges_of(cell, corners).zip(edge_nodes(cell, self.order)) {
                    let inside = self.along(edge).unwrap_or_default();
                    slots[2..].iter().zip(inside).for_each(|(&slot, x)| points[nodes[slot].index()] = x);
                }
                let is_curved = self.faces_of(cell, nodes, points) | self.touches(cell, corners);
                if is_curved && cell.dimension() == 3 && interior_count(cell, self.order) > 0 {
                    let on: Vec<DVec3> = nodes[..start].iter().map(|node| points[node.index()]).collect();
                    let inside = continued(modified::interior(cell, self.order), &on);
                    nodes[start..].iter().zip(inside).for_each(|(node, x)| points[node.index()] = x);
                }
            }
        }
    }

    /// Puts the nodes inside the faces of a cell where they belong; whether one is curved.
    fn faces_of(&self, cell: Cell, nodes: &[NodeId], points: &mut [DVec3]) -> bool {
        let mut is_curved = false;
        // A plane cell is its own face, and its nodes stand in the same order.
        let own: Vec<usize> = (0..nodes.len()).collect();
        let sides = if cell.is_flat() { std::slice::from_ref(&own) } else { side_nodes(cell, self.order) };
        for (face, side) in cell.faces().iter().zip(sides) {
            let count = face.corners.len();
            let corners: Vec<NodeId> = side[..count].iter().map(|&slot| nodes[slot]).collect();
            let Some((known, inside)) = self.faces.get(&FaceKey::new(&corners)) else { continue };
            is_curved = true;
            let mut seen = [0; 4];
            for (slot, corner) in seen.iter_mut().zip(known) {
                *slot = corners.iter().position(|own| own == corner).unwrap_or(0) as u8;
            }
            let start = interior_start(face.cell, self.order);
            let places = self.slots[count - 3].of(seen);
            for (&slot, &place) in side[start..].iter().zip(places) {
                points[nodes[slot].index()] = inside[place];
            }
        }
        is_curved
    }
}
