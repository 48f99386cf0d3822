//! The geometry of a page: faces and elements with their nodes, as numbers in base64, within a number of bytes.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;
use serde::Serialize;

use crate::element::{Cell, Filling, Order, Tables, basis};
use crate::mesh::{ElementId, Elements, Mesh, NodeId};
use crate::scene::{Measures, Shown, Surface, outer};

/// Bytes at most, before base64 makes four of three.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Of faces with their nodes.
    pub(super) faces: usize,
    /// Of elements with theirs.
    pub(super) elements: usize,
}

impl Room {
    /// That of a page that can be mailed.
    pub(super) const PAGE: Room = Room { faces: 5_500_000, elements: 7_000_000 };
}

/// Triangles that all faces are drawn as, about, at most.
const TRIANGLES: usize = 1_500_000;

/// What a page shows in space.
#[derive(Debug, Serialize)]
pub(super) struct Geometry {
    /// Order of the mesh.
    order: u8,
    /// Whether the cells are the faces that are shown.
    flat: bool,
    /// What node coordinates are relative to.
    origin: [f64; 3],
    /// Three `f32` a node.
    nodes: String,
    patches: Vec<Patch>,
    faces: Vec<Block>,
    elements: Vec<Block>,
    /// What is left out, in sentences.
    left_out: Vec<String>,
}

#[derive(Debug, Serialize)]
struct Patch {
    name: String,
    entity: String,
    /// Whether it stands far round the others, and is hidden at first.
    outer: bool,
}

/// Faces or elements of one kind and order.
#[derive(Debug, Serialize)]
struct Block {
    cell: &'static str,
    count: usize,
    /// Nodes of each.
    stride: usize,
    /// `u32` a node of each, in internal order.
    connectivity: String,
    /// Patch of each, `u32`; of elements empty.
    patch: String,
    /// Number in the file of each, or of the element behind it, `f64`; NaN where there is none.
    number: String,
    /// 1 where it is curved, `u8` of each.
    curved: String,
    /// `f32` of each.
    values: FxHashMap<&'static str, String>,
    /// How straight ones are drawn, and curved ones.
    fillings: [Drawn; 2],
}

/// Simplices that fill a cell.
#[derive(Clone, Debug, Serialize)]
struct Drawn {
    /// `[point][node]`, flat.
    weights: Vec<f32>,
    /// By points, flat.
    simplices: Vec<u16>,
    /// For each point of each simplex, 1 where the side opposite it lies on a side of the cell.
    outside: Vec<u8>,
    /// The points on each edge of the cell.
    edges: Vec<Vec<u16>>,
}

impl Drawn {
    fn new(cell: Cell, order: Order, divisions: usize) -> Drawn {
        let filling = Filling::new(cell, divisions);
        Drawn {
            weights: filling.weights(order).concat().into_iter().map(|weight| weight as f32).collect(),
            simplices: filling.simplices().flat_map(|(simplex, _)| simplex.to_vec()).collect(),
            outside: filling.simplices().flat_map(|(_, outside)| outside.iter().map(|&own| own.into())).collect(),
            edges: filling.edges().to_vec(),
        }
    }
}

/// An item on its way to the page.
struct Item<'a> {
    cell: Cell,
    nodes: &'a [NodeId],
    patch: usize,
    element: Option<ElementId>,
    distance: f64,
}

/// Faces and elements of a mesh; `distances` are those of the faces of its surface to the CAD, NaN where they are not known. Elements are those
/// nearest to the `places` to look at.
pub(super) fn geometry(
    mesh: &Mesh,
    surface: &Surface,
    measures: &Measures,
    distances: &[f64],
    places: &[DVec3],
    room: Room,
) -> Geometry {
    let mut left_out = Vec::new();
    let bounds = cad::Aabb::of_points(surface.faces.iter().flat_map(|face| mesh.points_of(&face.nodes)));
    let mut numbering =
        Numbering { mesh, origin: bounds.center(), places: FxHashMap::default(), coordinates: Vec::new() };
    let faces = faces(mesh, surface, distances, room.faces, &mut left_out);
    let curved = divisions(mesh.order(), faces.len());
    let faces = numbering.blocks(&faces, mesh.order(), measures, curved);
    let elements = elements(mesh, places, room.elements, &mut left_out);
    let elements =
        numbering.blocks(&elements, mesh.order(), measures, if mesh.order() == Order::LINEAR { 1 } else { 4 });
    let sides: Vec<crate::scene::Patch> = surface.patches.clone();
    let outer = outer(&sides);
    let patches = surface.patches.iter().zip(outer);
    Geometry {
        order: mesh.order().into(),
        flat: !mesh.is_volume(),
        origin: numbering.origin.to_array(),
        nodes: encoded(numbering.coordinates.iter().flat_map(|x| x.to_le_bytes())),
        patches: patches
            .map(|(own, outer)| Patch {
                name: own.label(),
                entity: own.entity.to_string(),
                outer: outer && mesh.is_volume(),
            })
            .collect(),
        faces,
        elements,
        left_out,
    }
}

/// Divisions of the edges of curved faces.
fn divisions(order: Order, faces: usize) -> usize {
    if order == Order::LINEAR {
        return 1;
    }
    (TRIANGLES / (2 * faces.max(1))).isqrt().clamp(2, 6)
}

/// The faces, or as many as there is room for.
fn faces<'a>(
    mesh: &Mesh,
    surface: &'a Surface,
    distances: &[f64],
    room: usize,
    left_out: &mut Vec<String>,
) -> Vec<Item<'a>> {
    let item = |(place, face): (usize, &'a Shown)| Item {
        cell: face.cell,
        nodes: &face.nodes,
        patch: face.patch,
        element: face.element,
        distance: distances.get(place).copied().unwrap_or(f64::NAN),
    };
    let all: Vec<Item> = surface.faces.iter().enumerate().map(item).collect();
    let bytes: usize = all.iter().map(bytes).sum();
    let step = bytes.div_ceil(room).max(1);
    if step > 1 {
        let noun = if mesh.is_volume() { "boundary faces" } else { "cells" };
        let shown = all.len().div_ceil(step);
        left_out.push(format!("The view shows {shown} of {} {noun}: one of every {step}.", all.len()));
    }
    all.into_iter().step_by(step).collect()
}

/// The volumes nearest to the places, as many as there is room for.
fn elements<'a>(mesh: &'a Mesh, places: &[DVec3], mut room: usize, left_out: &mut Vec<String>) -> Vec<Item<'a>> {
    let cells: Elements = mesh.cells();
    if !mesh.is_volume() {
        return Vec::new();
    }
    let far = |id: ElementId| {
        let corner = mesh.points()[cells.nodes(id)[0].index()];
        (places.iter().map(|place| place.distance_squared(corner)).fold(f64::INFINITY, f64::min), id)
    };
    let mut all: Vec<(f64, ElementId)> = cells.par_ids().map(far).collect();
    all.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut items = Vec::new();
    for (_, id) in all {
        let own = cells.get(id);
        let item = Item { cell: own.cell, nodes: own.nodes, patch: 0, element: Some(id), distance: f64::NAN };
        let Some(rest) = room.checked_sub(bytes(&item)) else { break };
        room = rest;
        items.push(item);
    }
    if items.len() < cells.len() {
        let told = "that can be cut and shown one by one: those nearest to the elements listed.";
        left_out.push(format!("The page holds {} of {} elements {told}", items.len(), cells.len()));
    }
    items
}

/// Bytes that an item takes, about: its numbers, and half of its nodes' coordinates.
fn bytes(item: &Item) -> usize {
    item.nodes.len() * (4 + 6) + 8 + 5 * 4 + 4
}

/// How far a node of a straight element may be from where its corners put it, as a fraction of the element's size.
const STRAIGHT: f64 = 1e-3;

/// Whether an item is seen to be curved.
fn is_curved(mesh: &Mesh, item: &Item) -> bool {
    let points: Vec<DVec3> = mesh.points_of(item.nodes).collect();
    let corners = &points[..item.cell.corner_count()];
    let size = cad::Aabb::of_points(corners.iter().copied()).diagonal();
    let weights = straight_weights(item.cell, mesh.order());
    points.iter().zip(weights).any(|(x, own)| {
        let straight: DVec3 = corners.iter().zip(own).map(|(&corner, &weight)| corner * weight).sum();
        straight.distance(*x) > STRAIGHT * size
    })
}

/// Weights of the corners at the nodes of a straight element.
fn straight_weights(cell: Cell, order: Order) -> &'static [Vec<f64>] {
    static TABLES: Tables<Vec<Vec<f64>>> = Tables::new();
    TABLES.get(cell, order, || basis::at_lattice(cell, Order::LINEAR, order))
}

/// Numbers of the nodes that occur, in the order in which they do.
struct Numbering<'a> {
    mesh: &'a Mesh,
    origin: DVec3,
    places: FxHashMap<NodeId, u32>,
    coordinates: Vec<f32>,
}

impl Numbering<'_> {
    fn number(&mut self, node: NodeId) -> u32 {
        let next = self.places.len() as u32;
        let number = *self.places.entry(node).or_insert(next);
        if number == next {
            let at = self.mesh.points()[node.index()] - self.origin;
            self.coordinates.extend(at.to_array().map(|x| x as f32));
        }
        number
    }

    /// Items by kind.
    fn blocks(&mut self, items: &[Item], order: Order, measures: &Measures, divisions: usize) -> Vec<Block> {
        let kinds = Cell::ALL.into_iter().filter(|&cell| items.iter().any(|item| item.cell == cell));
        kinds.map(|cell| self.block(cell, items, order, measures, divisions)).collect()
    }

    fn block(&mut self, cell: Cell, items: &[Item], order: Order, measures: &Measures, divisions: usize) -> Block {
        let own: Vec<&Item> = items.iter().filter(|item| item.cell == cell).collect();
        let cells = self.mesh.cells();
        let connectivity: Vec<u32> = own.iter().flat_map(|item| item.nodes).map(|&node| self.number(node)).collect();
        let number = |item: &&Item| item.element.map_or(f64::NAN, |id| cells.get(id).tag as f64);
        let of_element = |item: &Item, values: &[f64]| {
            item.element.and_then(|id| values.get(id.index()).copied()).unwrap_or(f64::NAN) as f32
        };
        let all = |value: &dyn Fn(&Item) -> f32| encoded(own.iter().flat_map(|item| value(item).to_le_bytes()));
        let mut values: FxHashMap<&'static str, String> = FxHashMap::default();
        for (name, of_all) in measures.named().into_iter().filter(|(_, values)| !values.is_empty()) {
            values.insert(name, all(&|item| of_element(item, of_all)));
        }
        if own.iter().any(|item| item.distance.is_finite()) {
            values.insert("distance to CAD", all(&|item| item.distance as f32));
        }
        Block {
            cell: cell.name(),
            count: own.len(),
            stride: cell.node_count(order),
            connectivity: encoded(connectivity.iter().flat_map(|n| n.to_le_bytes())),
            patch: encoded(own.iter().flat_map(|item| (item.patch as u32).to_le_bytes())),
            curved: encoded(own.iter().map(|item| is_curved(self.mesh, item).into())),
            number: encoded(own.iter().flat_map(|item| number(item).to_le_bytes())),
            values,
            fillings: [1, divisions].map(|divisions| Drawn::new(cell, order, divisions)),
        }
    }
}

fn encoded(bytes: impl Iterator<Item = u8>) -> String {
    STANDARD.encode(bytes.collect::<Vec<u8>>())
}
