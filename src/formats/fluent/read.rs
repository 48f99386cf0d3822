//! A mesh from the sections of a file.

use std::collections::BTreeMap;

use glam::DVec3;

use super::fault::FluentFault;
use super::lexer::Lexer;
use crate::element::Cell;
use crate::formats::assembly::{Assembly, node_of};
use crate::formats::error::{Fault, Flaw};
use crate::formats::from_faces::{self, Faces};
use crate::mesh::{Condition, EntityKey, Mesh, NodeId};

/// A face: its zone, its corners, the cells on its sides from 1, 0 for none.
struct Face {
    zone: i64,
    corners: Vec<i64>,
    cells: [i64; 2],
}

/// What a file holds.
#[derive(Default)]
struct Sections {
    dimension: usize,
    points: Vec<Option<DVec3>>,
    /// Zone of each cell.
    cells: Vec<Option<i64>>,
    faces: Vec<Face>,
    /// Type and name of the zones.
    names: BTreeMap<i64, (String, String)>,
    periodic: usize,
}

/// Reads a mesh from a file's whole content.
///
/// # Errors
/// The first [`Fault`] and its place.
pub(super) fn read(content: &[u8]) -> Result<Mesh, Flaw> {
    let mut lexer = Lexer::new(content);
    let mut sections = Sections { dimension: 3, ..Sections::default() };
    while lexer.peek().is_some() {
        lexer.expect(b'(', "a section in brackets")?;
        sections.section(&mut lexer)?;
    }
    mesh(&sections, &lexer)
}

/// Sections by their numbers.
const DIMENSION: &str = "2";
const NODES: &str = "10";
const CELLS: &str = "12";
const FACES: &str = "13";
const PERIODIC: &str = "18";
const NAMES: [&str; 2] = ["39", "45"];
const HANGING: [&str; 2] = ["58", "59"];

impl Sections {
    fn section(&mut self, lexer: &mut Lexer) -> Result<(), Flaw> {
        let index = lexer.word("the number of a section")?;
        match index {
            DIMENSION => {
                let dimension = lexer.hex("the dimension")?;
                self.dimension = usize::try_from(dimension)
                    .ok()
                    .filter(|own| (2..=3).contains(own))
                    .ok_or_else(|| lexer.flaw(FluentFault::Dimension(dimension)))?;
                lexer.skip(1)
            }
            NODES => self.nodes(lexer),
            CELLS => self.cells(lexer),
            FACES => self.faces(lexer),
            PERIODIC => {
                self.periodic += 1;
                lexer.skip(1)
            }
            _ if NAMES.contains(&index) => {
                lexer.expect(b'(', "(")?;
                let word = lexer.word("the number of a zone")?;
                // Its number is decimal here.
                let zone = word
                    .parse()
                    .map_err(|_| lexer.flaw(Fault::Number { what: "the number of a zone", found: word.into() }))?;
                let kind = lexer.word("the type of a zone")?.to_owned();
                let name = if lexer.peek() == Some(b')') {
                    kind.clone()
                } else {
                    lexer.word("the name of a zone")?.to_owned()
                };
                self.names.insert(zone, (kind, name));
                lexer.skip(2)
            }
            _ if HANGING.contains(&index) => Err(lexer.flaw(FluentFault::Hanging(index.parse().unwrap_or(0)))),
            _ => {
                let number = index.parse::<i64>().unwrap_or(0);
                let is_mesh = matches!(number % 1000, 10 | 12 | 13);
                if number >= 2000 && is_mesh {
                    return Err(lexer.flaw(FluentFault::Binary(number)));
                }
                lexer.skip(1)
            }
        }
    }

    fn nodes(&mut self, lexer: &mut Lexer) -> Result<(), Flaw> {
        let head = lexer.head()?;
        if head.first() == Some(&0) || !lexer.takes(b'(') {
            return lexer.skip(1); // how many there are in all
        }
        let axes = head.get(4).map_or(self.dimension, |&axes| if axes == 2 { 2 } else { 3 });
        let (first, last) = lexer.range(10, &head, 2 * axes)?;
        for number in first..=last {
            let mut x = DVec3::ZERO;
            for axis in 0..axes {
                x[axis] = lexer.real("a coordinate")?;
            }
            put(&mut self.points, "node", number, x).map_err(|fault| lexer.flaw(fault))?;
        }
        lexer.expect(b')', "the end of the nodes (more than announced?)")?;
        lexer.expect(b')', ")")
    }

    fn cells(&mut self, lexer: &mut Lexer) -> Result<(), Flaw> {
        let head = lexer.head()?;
        let zone = head.first().copied().unwrap_or(0);
        if zone != 0 {
            // Cells of one kind are not listed; each has four faces or more, in the plane three.
            let (first, last) = lexer.range(12, &head, 0)?;
            if last > self.cells.len() + lexer.rest() + self.faces.len() {
                let (count, rest) = ((last + 1 - first) as u64, lexer.rest() as u64);
                return Err(lexer.flaw(Fault::Count { what: "cells", count, rest }));
            }
            for number in first..=last {
                put(&mut self.cells, "cell", number, zone).map_err(|fault| lexer.flaw(fault))?;
            }
        }
        lexer.skip(1)
    }

    fn faces(&mut self, lexer: &mut Lexer) -> Result<(), Flaw> {
        let head = lexer.head()?;
        let zone = head.first().copied().unwrap_or(0);
        if zone == 0 || !lexer.takes(b'(') {
            return lexer.skip(1);
        }
        let kind = head.get(4).copied().unwrap_or(0);
        let (first, last) = lexer.range(13, &head, 6)?;
        for _ in first..=last {
            // Of mixed and of polygonal faces each tells its number of corners.
            let corners = if matches!(kind, 0 | 5) { lexer.hex("the corners of a face")? } else { kind };
            if !(2..=4).contains(&corners) {
                return Err(lexer.flaw(FluentFault::Face { zone, corners }));
            }
            let corners = (0..corners).map(|_| lexer.hex("a node of a face")).collect::<Result<Vec<i64>, Flaw>>()?;
            let cells = [lexer.hex("a cell of a face")?, lexer.hex("a cell of a face")?];
            self.faces.push(Face { zone, corners, cells });
        }
        lexer.expect(b')', "the end of the faces (more than announced?)")?;
        lexer.expect(b')', ")")
    }
}

/// Keeps an item under its number, which is counted from 1.
fn put<T: Clone>(items: &mut Vec<Option<T>>, what: &'static str, number: usize, item: T) -> Result<(), FluentFault> {
    if items.len() < number {
        items.resize(number, None);
    }
    match items[number - 1].replace(item) {
        None => Ok(()),
        Some(_) => Err(FluentFault::Gap { what, number }),
    }
}

fn mesh(sections: &Sections, lexer: &Lexer) -> Result<Mesh, Flaw> {
    let told = |fault: Fault| lexer.flaw(fault);
    let whole =
        |what, gap: Option<usize>| gap.map_or(Ok(()), |n| Err(lexer.flaw(FluentFault::Gap { what, number: n + 1 })));
    whole("node", sections.points.iter().position(Option::is_none))?;
    whole("cell", sections.cells.iter().position(Option::is_none))?;
    let points: Vec<DVec3> = sections.points.iter().flatten().copied().collect();
    let mut assembly = Assembly::new(points).map_err(told)?;
    let count = sections.cells.len();
    let mut round: Vec<Faces> = vec![Vec::new(); count];
    let mut sides: Vec<(i64, Vec<NodeId>)> = Vec::new();
    for (n, Face { zone, corners, cells }) in sections.faces.iter().enumerate() {
        let node = |&number: &i64| node_of(assembly.parts.points.len(), number, 1, n as u64 + 1);
        let own: Vec<NodeId> = corners.iter().map(node).collect::<Result<_, _>>().map_err(told)?;
        for (cell, turned) in cells.iter().zip([true, false]) {
            let place = usize::try_from(*cell).ok().filter(|&own| own <= count);
            let place = place.ok_or_else(|| lexer.flaw(FluentFault::Cell { zone: *zone, cell: *cell, count }))?;
            if let Some(place) = place.checked_sub(1) {
                // The first cell is the one to which the normal points.
                round[place].push(if turned { own.iter().rev().copied().collect() } else { own.clone() });
            }
        }
        if cells.contains(&0) {
            sides.push((*zone, own));
        }
    }
    let found: Vec<Option<(Cell, Vec<NodeId>)>> = round
        .iter()
        .map(|faces| if sections.dimension == 2 { from_faces::flat(faces) } else { from_faces::cell(faces) })
        .collect();
    if let Some(cell) = found.iter().position(Option::is_none) {
        let others = found.iter().filter(|own| own.is_none()).count() - 1;
        let nodes: Vec<NodeId> = round[cell].iter().flatten().copied().collect();
        let at = from_faces::place(&assembly.parts.points, &nodes);
        let faces = from_faces::told(&round[cell]);
        return Err(lexer.flaw(FluentFault::Polyhedron { cell: cell + 1, at, faces, others }));
    }
    let mut zones = Zones { sections, assembly: &mut assembly };
    for ((cell, corners), zone) in found.iter().flatten().zip(sections.cells.iter().flatten()) {
        let key = zones.entity(sections.dimension, *zone);
        zones.assembly.push(*cell, key, corners);
    }
    for (zone, corners) in &sides {
        let key = zones.entity(sections.dimension - 1, *zone);
        let side = [Cell::Line, Cell::Triangle, Cell::Quad][corners.len() - 2];
        zones.assembly.push(side, key, corners);
    }
    if sections.periodic > 0 {
        let note = format!("{} pairs of periodic zones; which faces correspond is not taken over", sections.periodic);
        assembly.parts.notes.push(note);
    }
    assembly.finish().map_err(told)
}

/// The zones as entities and groups.
struct Zones<'a> {
    sections: &'a Sections,
    assembly: &'a mut Assembly,
}

impl Zones<'_> {
    /// The entity of a zone, made known when it is new.
    fn entity(&mut self, dimension: usize, zone: i64) -> EntityKey {
        let tag = i32::try_from(zone).unwrap_or(i32::MAX).max(1);
        let key = EntityKey::new(dimension as u8, tag);
        if self.assembly.parts.entities.iter().any(|entity| entity.key == key) {
            return key;
        }
        let named = self.sections.names.get(&zone);
        let (kind, name) = named.map_or_else(|| (String::new(), format!("zone_{zone}")), Clone::clone);
        let group = self.assembly.group(key.dimension, &name, Some(tag));
        self.assembly.entity(key, vec![group]);
        if dimension < self.sections.dimension {
            self.assembly.parts.conditions.push(Condition { entity: key, name, kind });
        }
        key
    }
}
