//! A Nektar++ mesh from a mesh.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::io::{self, Write};

use glam::DVec3;
use quick_xml::escape::escape;
use rustc_hash::FxHashMap;

use super::held::{Held, Turns};
use super::shape;
use super::straight::Straight;
use crate::element::{Cell, Order, canonical, edge_nodes, lattice, side_nodes};
use crate::formats::part::Unwritten;
use crate::mesh::{Block, FaceKey, Mesh, NodeId};

/// Writes a mesh. Equal meshes make equal bytes.
pub(super) fn write(out: &mut impl Write, mesh: &Mesh) -> Result<(), Unwritten> {
    let held = Held::of(mesh).map_err(Unwritten::Inexpressible)?;
    let sides = Sides::of(mesh, &held);
    let composites = composites(mesh, &sides).map_err(Unwritten::Inexpressible)?;
    let is_flat = mesh.dimension() == 2 && mesh.points().iter().all(|x| x.z == 0.0);
    writeln!(out, "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\n<NEKTAR>")?;
    writeln!(out, "  <GEOMETRY DIM=\"{}\" SPACE=\"{}\">", mesh.dimension(), if is_flat { 2 } else { 3 })?;
    vertices(out, &held)?;
    rows(
        out,
        "EDGE",
        sides.edges.iter().enumerate().map(|(id, edge)| ("E", id, edge.ends.map(|n| n as usize).to_vec())),
    )?;
    if mesh.is_volume() {
        rows(out, "FACE", sides.faces.iter().enumerate().map(|(id, face)| (face.letter(), id, sides.around(face))))?;
    }
    rows(out, "ELEMENT", sides.cells.iter().enumerate().map(|(id, (letter, own))| (*letter, id, own.clone())))?;
    curves(out, mesh.order(), &held.points, &sides)?;
    writeln!(out, "    <COMPOSITE>")?;
    for Composite { id, name, members, .. } in &composites {
        let name = name.as_ref().map_or_else(String::new, |name| format!(" NAME=\"{}\"", escape(name.as_str())));
        writeln!(out, "      <C ID=\"{id}\"{name}> {members} </C>")?;
    }
    let domain: Vec<&Composite> = composites.iter().filter(|own| own.is_of_cells).collect();
    let ids: Vec<usize> = domain.iter().map(|own| own.id as usize).collect();
    writeln!(out, "    </COMPOSITE>\n    <DOMAIN>\n      <D ID=\"0\"> C[{}] </D>\n    </DOMAIN>", listed(&ids))?;
    writeln!(out, "  </GEOMETRY>\n  <EXPANSIONS>")?;
    for own in domain {
        let modes = mesh.order().get() + 1;
        writeln!(out, "    <E COMPOSITE=\"C[{}]\" NUMMODES=\"{modes}\" TYPE=\"MODIFIED\" FIELDS=\"u\" />", own.id)?;
    }
    writeln!(out, "  </EXPANSIONS>\n</NEKTAR>")?;
    Ok(())
}

fn point(out: &mut impl Write, x: DVec3) -> io::Result<()> {
    write!(out, "{:?} {:?} {:?}", x.x, x.y, x.z)
}

fn vertices(out: &mut impl Write, held: &Held) -> io::Result<()> {
    let numbered = held.numbers.iter().enumerate().filter(|(_, number)| **number != u32::MAX);
    let mut nodes: Vec<(u32, usize)> = numbered.map(|(node, &number)| (number, node)).collect();
    nodes.sort_unstable();
    writeln!(out, "    <VERTEX>")?;
    for (number, node) in nodes {
        write!(out, "      <V ID=\"{number}\">")?;
        point(out, held.points[node])?;
        writeln!(out, "</V>")?;
    }
    writeln!(out, "    </VERTEX>")
}

/// A section of elements: letter, number and what bounds each.
fn rows(
    out: &mut impl Write,
    section: &str,
    items: impl Iterator<Item = (&'static str, usize, Vec<usize>)>,
) -> io::Result<()> {
    writeln!(out, "    <{section}>")?;
    for (letter, id, bounds) in items {
        write!(out, "      <{letter} ID=\"{id}\">")?;
        bounds.iter().try_for_each(|own| write!(out, " {own}"))?;
        writeln!(out, " </{letter}>")?;
    }
    writeln!(out, "    </{section}>")
}

/// Edges and faces that are not straight; an edge also where a face is not, which has as many points as its edges.
fn curves(out: &mut impl Write, order: Order, points: &[DVec3], sides: &Sides) -> io::Result<()> {
    if order == Order::LINEAR {
        return Ok(());
    }
    let straight = Straight::new(order, points);
    let curved_faces: Vec<usize> = (0..sides.faces.len())
        .filter(|&id| !straight.is(sides.faces[id].cell, points, &sides.faces[id].nodes))
        .collect();
    let of_faces: BTreeSet<usize> = curved_faces.iter().flat_map(|&id| sides.around(&sides.faces[id])).collect();
    let count = order.get() + 1;
    let mut next = 0;
    writeln!(out, "    <CURVED>")?;
    for (id, edge) in sides.edges.iter().enumerate() {
        if of_faces.contains(&id) || !straight.is(Cell::Line, points, &edge.nodes) {
            write!(out, "      <E ID=\"{next}\" EDGEID=\"{id}\" NUMPOINTS=\"{count}\" TYPE=\"PolyEvenlySpaced\">")?;
            let [first, last, inner @ ..] = &edge.nodes[..] else { continue };
            all(out, points, [first].into_iter().chain(inner).chain([last]))?;
            writeln!(out, "</E>")?;
            next += 1;
        }
    }
    for id in curved_faces {
        let face = &sides.faces[id];
        let (kind, count) = match face.cell {
            Cell::Triangle => ("NodalTriEvenlySpaced", face.nodes.len()),
            _ => ("PolyEvenlySpaced", face.nodes.len()),
        };
        write!(out, "      <F ID=\"{next}\" FACEID=\"{id}\" NUMPOINTS=\"{count}\" TYPE=\"{kind}\">")?;
        all(out, points, places(face.cell, order).iter().map(|&place| &face.nodes[place]))?;
        writeln!(out, "</F>")?;
        next += 1;
    }
    writeln!(out, "    </CURVED>")
}

fn all<'a>(out: &mut impl Write, points: &[DVec3], nodes: impl Iterator<Item = &'a NodeId>) -> io::Result<()> {
    for (n, node) in nodes.enumerate() {
        out.write_all(if n > 0 { b"  " } else { b"" })?;
        point(out, points[node.index()])?;
    }
    Ok(())
}

/// For each point of a face's curve, the node that it is, in internal order: those of a triangle by corners, edges and rows, those of a
/// quadrilateral by rows.
pub(super) fn places(cell: Cell, order: Order) -> Vec<usize> {
    let nodes = lattice(cell, order);
    let mut places: Vec<usize> = (0..nodes.len()).collect();
    let fixed = if cell == Cell::Triangle { 3 * order.get() } else { 0 };
    places[fixed..].sort_by_key(|&n| [nodes[n][1], nodes[n][0]]);
    places
}

/// An edge: its ends' numbers, the lower first, and its nodes from there on, in internal order.
struct Edge {
    ends: [u32; 2],
    nodes: Vec<NodeId>,
}

/// A face: its nodes in internal order, from its lowest corner towards the lower of that one's neighbours.
struct Face {
    cell: Cell,
    nodes: Vec<NodeId>,
}

impl Face {
    fn letter(&self) -> &'static str {
        shape::of(self.cell).map_or("", |shape| shape.letter)
    }
}

/// The edges, faces and cells of a mesh, numbered by their places.
struct Sides<'a> {
    held: &'a Held,
    edges: Vec<Edge>,
    by_ends: FxHashMap<[u32; 2], usize>,
    faces: Vec<Face>,
    by_corners: FxHashMap<FaceKey, usize>,
    /// Letter of each cell, and its faces, in a plane mesh its edges.
    cells: Vec<(&'static str, Vec<usize>)>,
}

impl<'a> Sides<'a> {
    fn of(mesh: &Mesh, held: &'a Held) -> Sides<'a> {
        let (edges, faces, cells) = (Vec::new(), Vec::new(), Vec::new());
        let mut sides =
            Sides { held, edges, by_ends: FxHashMap::default(), faces, by_corners: FxHashMap::default(), cells };
        let mut turns = Turns::new(mesh.order());
        let normal = mesh.points().iter().all(|x| x.z == 0.0).then_some(DVec3::Z);
        for block in &held.cells {
            for nodes in block.elements(mesh.order()) {
                sides.edges_of(block, mesh.order(), nodes);
                let own = if mesh.is_volume() {
                    sides.faces_of(block, mesh.order(), nodes, &mut turns)
                } else {
                    sides.flat(block, nodes, normal, &mut turns)
                };
                sides.cells.push((shape::of(block.cell).map_or("", |shape| shape.letter), own));
            }
        }
        sides
    }

    fn ends(&self, a: NodeId, b: NodeId) -> [u32; 2] {
        let [a, b] = [a, b].map(|node| self.held.numbers[node.index()]);
        [a.min(b), a.max(b)]
    }

    /// Numbers of the edges between corners that follow one another.
    fn edges_between(&self, corners: &[NodeId]) -> Vec<usize> {
        let next = |n: usize| corners[(n + 1) % corners.len()];
        let ends = (0..corners.len()).map(|n| self.ends(corners[n], next(n)));
        ends.filter_map(|ends| self.by_ends.get(&ends).copied()).collect()
    }

    /// Numbers of the edges round a face.
    fn around(&self, face: &Face) -> Vec<usize> {
        self.edges_between(&face.nodes[..face.cell.corner_count()])
    }

    fn edges_of(&mut self, block: &Block, order: Order, nodes: &[NodeId]) {
        for slots in edge_nodes(block.cell, order) {
            let mut own: Vec<NodeId> = slots.iter().map(|&slot| nodes[slot]).collect();
            let ends = self.ends(own[0], own[1]);
            if self.by_ends.contains_key(&ends) {
                continue;
            }
            if self.held.numbers[own[0].index()] != ends[0] {
                own.swap(0, 1);
                own[2..].reverse();
            }
            self.by_ends.insert(ends, self.edges.len());
            self.edges.push(Edge { ends, nodes: own });
        }
    }

    /// Numbers of a cell's faces in Nektar++'s order; those that are new are taken in.
    fn faces_of(&mut self, block: &Block, order: Order, nodes: &[NodeId], turns: &mut Turns) -> Vec<usize> {
        for (face, slots) in block.cell.faces().iter().zip(side_nodes(block.cell, order)) {
            let own: Vec<NodeId> = slots.iter().map(|&slot| nodes[slot]).collect();
            let key = FaceKey::new(&own[..face.corners.len()]);
            if self.by_corners.contains_key(&key) {
                continue;
            }
            let numbers: Vec<u32> =
                own[..face.corners.len()].iter().map(|node| self.held.numbers[node.index()]).collect();
            let begin = canonical(&numbers);
            let turned = turns.of(face.cell, &begin[..numbers.len()]).iter().map(|&slot| own[slot]).collect();
            self.by_corners.insert(key, self.faces.len());
            self.faces.push(Face { cell: face.cell, nodes: turned });
        }
        let shape = shape::of(block.cell).into_iter().flat_map(|shape| shape.sides);
        let key = |side: &&[u8]| {
            let corners: Vec<NodeId> = side.iter().map(|&corner| nodes[usize::from(corner)]).collect();
            self.by_corners.get(&FaceKey::new(&corners)).copied()
        };
        shape.filter_map(key).collect()
    }

    /// Numbers of a plane cell's edges, counterclockwise where the mesh lies in the plane of x and y; it is a face itself.
    fn flat(&mut self, block: &Block, nodes: &[NodeId], normal: Option<DVec3>, turns: &mut Turns) -> Vec<usize> {
        let at = |n: usize| self.held.points[nodes[n].index()];
        let last = block.cell.corner_count() - 1;
        let is_clockwise = normal.is_some_and(|normal| (at(1) - at(0)).cross(at(last) - at(0)).dot(normal) < 0.0);
        let corners: Vec<u8> = match is_clockwise {
            true => (0..=last as u8).map(|n| if n == 0 { 0 } else { last as u8 + 1 - n }).collect(),
            false => (0..=last as u8).collect(),
        };
        let turned: Vec<NodeId> = turns.of(block.cell, &corners).iter().map(|&slot| nodes[slot]).collect();
        let own = self.edges_between(&turned[..=last]);
        self.faces.push(Face { cell: block.cell, nodes: turned });
        own
    }
}

/// A set of elements.
struct Composite {
    id: i32,
    name: Option<String>,
    members: String,
    is_of_cells: bool,
}

/// The composites: one a group of sides, one a group and kind of cells.
///
/// # Errors
/// Cells in two groups.
fn composites(mesh: &Mesh, sides: &Sides) -> Result<Vec<Composite>, String> {
    let mut sets: BTreeMap<(bool, Option<i32>, i32, &str), Vec<usize>> = BTreeMap::new();
    let mut first = 0;
    let kept = |tags: Vec<i32>| {
        let tags: BTreeSet<i32> = tags.into_iter().map(i32::saturating_abs).filter(|&tag| tag != 0).collect();
        tags.into_iter().collect::<Vec<i32>>()
    };
    let tags = |block: &Block| {
        kept(if block.physical_tags.is_empty() {
            mesh.physical_tags_of(block.entity)
        } else {
            block.physical_tags.clone()
        })
    };
    for block in mesh.cell_blocks() {
        let own = tags(block);
        if own.len() > 1 {
            return Err(format!("{} is in {} groups, and a cell of Nektar++'s is in one", block.entity, own.len()));
        }
        let letter = shape::of(block.cell).map_or("", |shape| shape.letter);
        let (group, entity) = own.first().map_or((None, block.entity.tag), |&tag| (Some(tag), 0));
        sets.entry((true, group, entity, letter)).or_default().extend(first..first + block.tags.len());
        first += block.tags.len();
    }
    for block in mesh.side_blocks() {
        let corners = block.cell.corner_count();
        let number = |nodes: &[NodeId]| match &nodes[..corners] {
            &[a, b] => sides.by_ends.get(&sides.ends(a, b)).copied(),
            corners => sides.by_corners.get(&FaceKey::new(corners)).copied(),
        };
        let found: Vec<usize> = block.elements(mesh.order()).filter_map(number).collect();
        let letter = if mesh.is_volume() { "F" } else { "E" };
        let groups = tags(block);
        let keys: Vec<_> = match groups.is_empty() {
            true => vec![(false, None, block.entity.tag, letter)],
            false => groups.into_iter().map(|tag| (false, Some(tag), 0, letter)).collect(),
        };
        keys.into_iter().for_each(|key| sets.entry(key).or_default().extend(&found));
    }
    sets.retain(|_, members| !members.is_empty());
    Ok(numbered(mesh, sets))
}

/// The composites with their numbers: those of their groups or entities, where no other has them.
fn numbered(mesh: &Mesh, sets: BTreeMap<(bool, Option<i32>, i32, &str), Vec<usize>>) -> Vec<Composite> {
    let wishes = sets.keys().map(|&(_, group, entity, _)| group.unwrap_or(entity)).max().unwrap_or(0);
    let (mut free, mut used) = (wishes.max(0).saturating_add(1), BTreeSet::new());
    let mut composites = Vec::new();
    for ((is_of_cells, group, entity, letter), mut members) in sets {
        let wish = group.unwrap_or(entity);
        let id = if wish >= 0 && used.insert(wish) {
            wish
        } else {
            free += 1;
            free - 1
        };
        let dimension = mesh.dimension() - usize::from(!is_of_cells);
        let is = |own: &&crate::mesh::PhysicalName| usize::from(own.dimension) == dimension && Some(own.tag) == group;
        let name = mesh.physical_names().iter().find(is).map(|own| own.name.clone());
        members.sort_unstable();
        members.dedup();
        composites.push(Composite { id, name, members: format!("{letter}[{}]", listed(&members)), is_of_cells });
    }
    composites.sort_by_key(|own| own.id);
    composites
}

/// Numbers with ranges: `0-4,7`.
fn listed(numbers: &[usize]) -> String {
    let mut text = String::new();
    for run in numbers.chunk_by(|a, b| a + 1 == *b) {
        let comma = if text.is_empty() { "" } else { "," };
        // A string takes what is written to it.
        let _ = match run {
            [one] => write!(text, "{comma}{one}"),
            [first, .., last] => write!(text, "{comma}{first}-{last}"),
            [] => Ok(()),
        };
    }
    text
}
