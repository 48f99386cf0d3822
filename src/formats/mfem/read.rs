//! A mesh from an MFEM mesh.

use std::collections::BTreeSet;
use std::io::BufRead;

use glam::DVec3;

use super::collection::Collection;
use super::elements::{self, Elements};
use super::fault::MfemFault;
use super::geometry;
use super::nodes::{Layout, Placed};
use super::sets::{self, Set};
use crate::element::Order;
use crate::formats::assembly::Assembly;
use crate::formats::error::{Fault, Flaw};
use crate::formats::scanner::Scanner;
use crate::mesh::{EntityKey, Mesh, NodeId};

/// Reads a mesh from a file's content of `length` bytes.
///
/// # Errors
/// The first [`Fault`] and its place. Memory stays within a small multiple of `length`.
pub(super) fn read(input: impl BufRead, length: u64) -> Result<Mesh, Flaw> {
    let mut file = File { scanner: Scanner::new(input, length) };
    let version = file.version()?;
    file.keyword("dimension")?;
    let dimension: usize = file.scanner.number("the dimension")?;
    if !(2..=3).contains(&dimension) {
        return Err(file.scanner.flaw(MfemFault::Dimension(dimension)));
    }
    file.keyword("elements")?;
    let cells = file.elements("elements", dimension, dimension)?;
    let cell_sets = file.sets("attribute_sets", version)?;
    file.keyword("boundary")?;
    let sides = file.elements("boundary elements", dimension, dimension - 1)?;
    let side_sets = file.sets("bdr_attribute_sets", version)?;
    let [of_cells, of_sides] = [&cells, &sides].map(Elements::attributes);
    file.keyword("vertices")?;
    let mut assembly = file.geometry(dimension, cells, sides)?;
    assembly.parts.notes.extend(file.end(version)?);
    for (attributes, dimension, sets) in [(of_cells, dimension, cell_sets), (of_sides, dimension - 1, side_sets)] {
        sets::group(&mut assembly, dimension as u8, &attributes, &sets);
    }
    if version == Version::Parallel {
        let note = "the mesh is one process's part of a mesh, without what joins it to the others";
        assembly.parts.notes.push(note.to_owned());
    }
    assembly.finish().map_err(|fault| file.scanner.flaw(fault))
}

/// Versions of the format.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    /// 1.0
    Plain,
    /// 1.2: with what joins it to other processes' parts at its end.
    Parallel,
    /// 1.3: with sets of attributes.
    Named,
}

struct File<R> {
    scanner: Scanner<R>,
}

impl<R: BufRead> File<R> {
    fn version(&mut self) -> Result<Version, Flaw> {
        let line = self.scanner.full_line("the version")?;
        match line.strip_prefix("MFEM mesh v").map(str::trim) {
            Some("1.0") => Ok(Version::Plain),
            Some("1.2") => Ok(Version::Parallel),
            Some("1.3") => Ok(Version::Named),
            _ => Err(self.scanner.flaw(MfemFault::Version(line.chars().take(40).collect()))),
        }
    }

    /// The next word that is not in a comment.
    fn word(&mut self, what: &'static str) -> Result<String, Flaw> {
        self.scanner.past_comments()?;
        Ok(self.scanner.word(what)?.to_owned())
    }

    fn keyword(&mut self, keyword: &'static str) -> Result<(), Flaw> {
        let found = self.word(keyword)?;
        if found == keyword {
            return Ok(());
        }
        let found = found.chars().take(40).collect();
        Err(self.scanner.flaw(Fault::Unexpected { what: keyword, found }))
    }

    /// A number of items, each of which takes two bytes at least.
    fn count(&mut self, what: &'static str) -> Result<usize, Flaw> {
        let (count, rest) = (self.scanner.number::<u64>(what)?, self.scanner.rest());
        match usize::try_from(count) {
            Ok(fits) if count <= rest / 2 + 1 => Ok(fits),
            _ => Err(self.scanner.flaw(Fault::Count { what, count, rest })),
        }
    }

    fn elements(&mut self, what: &'static str, mesh: usize, dimension: usize) -> Result<Elements, Flaw> {
        let count = self.count(what)?;
        let mut elements = Elements::default();
        for _ in 0..count {
            let attribute: i64 = self.scanner.number("an attribute")?;
            let Some(attribute) = i32::try_from(attribute).ok().filter(|&own| own > 0) else {
                return Err(self.scanner.flaw(MfemFault::Attribute(attribute)));
            };
            let code = self.scanner.number("a geometry")?;
            let cell = geometry::meaning(code).ok_or_else(|| self.scanner.flaw(MfemFault::Geometry(code)))?;
            if cell.dimension() != dimension {
                return Err(self.scanner.flaw(MfemFault::Misplaced { cell, what, dimension: mesh }));
            }
            for _ in 0..cell.corner_count() {
                let vertex: u32 = self.scanner.number("a vertex")?;
                let node = NodeId::new(vertex as usize).map_err(|fault| self.scanner.flaw(fault))?;
                elements.corners.push(node);
            }
            elements.kinds.push((attribute, cell));
        }
        Ok(elements)
    }

    /// Named sets of attributes, where the version has them.
    fn sets(&mut self, keyword: &'static str, version: Version) -> Result<Vec<Set>, Flaw> {
        if version != Version::Named {
            return Ok(Vec::new());
        }
        self.keyword(keyword)?;
        let count = self.count("sets")?;
        let mut sets = Vec::new();
        for _ in 0..count {
            let line = self.scanner.full_line("a set's name")?;
            let (name, rest) = quoted(&line).ok_or_else(|| {
                let found = line.chars().take(40).collect();
                self.scanner.flaw(Fault::Unexpected { what: "a name and a count", found })
            })?;
            let mut words: Vec<String> = rest.split_whitespace().map(str::to_owned).collect();
            let number = |file: &Self, word: &str| {
                let what = "an attribute of a set";
                word.parse::<i32>().map_err(|_| file.scanner.flaw(Fault::Number { what, found: word.to_owned() }))
            };
            // The count and the attributes may stand on lines of their own.
            if words.is_empty() {
                words.push(self.scanner.word("a count")?.to_owned());
            }
            let Some(count) = usize::try_from(number(self, &words[0])?).ok().filter(|&count| words.len() <= count + 1)
            else {
                return Err(self.scanner.flaw(Fault::Row("a set of attributes")));
            };
            let mut attributes = BTreeSet::new();
            for place in 1..=count {
                let word = match words.get(place) {
                    Some(word) => word.clone(),
                    None => self.scanner.word("an attribute of a set")?.to_owned(),
                };
                attributes.insert(number(self, &word)?);
            }
            sets.push(Set { name, attributes });
        }
        Ok(sets)
    }

    /// The points and elements, without groups.
    fn geometry(&mut self, dimension: usize, mut cells: Elements, mut sides: Elements) -> Result<Assembly, Flaw> {
        let vertices = self.count("vertices")?;
        for elements in [&cells, &sides] {
            let beyond =
                |corners: &[NodeId]| corners.iter().map(|corner| corner.index()).find(|&node| node >= vertices);
            let wrong = elements.iter().zip(1..).find_map(|((_, _, corners), by)| Some((by, beyond(corners)? as i64)));
            if let Some((by, node)) = wrong {
                let last = vertices as i64 - 1;
                return Err(self.scanner.flaw(Fault::NodeRange { by, node, first: 0, last }));
            }
        }
        let word = self.word("coordinates or nodes")?;
        if word != "nodes" {
            let axes = word.parse::<usize>().ok().filter(|axes| (2..=3).contains(axes));
            let Some(axes) = axes else {
                return Err(self
                    .scanner
                    .flaw(Fault::Number { what: "the dimension of the space, 2 or 3", found: word }));
            };
            self.compare(axes, dimension)?;
            let points = self.values(vertices, axes, true)?;
            let mut assembly = Assembly::new(points).map_err(|fault| self.scanner.flaw(fault))?;
            for (elements, dimension) in [(&cells, dimension), (&sides, dimension - 1)] {
                for (cell, attribute, corners) in elements.iter() {
                    assembly.push(cell, EntityKey::new(dimension as u8, attribute), corners);
                }
            }
            return Ok(assembly);
        }
        let (space, axes, by_point) = self.space(&cells)?;
        self.compare(axes, dimension)?;
        let twice = cells.iter().chain(sides.iter()).find_map(|(_, _, corners)| repeated(corners));
        if let Some(vertex) = twice {
            return Err(self.scanner.flaw(MfemFault::Collapsed(vertex)));
        }
        let vertices = elements::compress(vertices, &mut cells, &mut sides);
        let layout = Layout::new(space, vertices, &cells);
        let values = self.values(layout.count(), axes, by_point)?;
        let placed = layout.place(&values, &cells, &sides).map_err(|fault| self.scanner.flaw(fault))?;
        self.curved(placed, dimension, space.order, [&cells, &sides])
    }

    /// Refuses fewer coordinates than the mesh has dimensions.
    fn compare(&self, axes: usize, dimension: usize) -> Result<(), Flaw> {
        if axes < dimension {
            return Err(self.scanner.flaw(MfemFault::Flat { axes, dimension }));
        }
        Ok(())
    }

    /// What stands behind the points: the mark of the end, or what joins the mesh to the parts of other processes. Numbers would be
    /// of the mesh. A note, where the mark is missing.
    fn end(&mut self, version: Version) -> Result<Option<String>, Flaw> {
        if !self.scanner.past_comments()? {
            let note = "there is no mfem_mesh_end: the file may have been cut off";
            return Ok((version == Version::Named).then(|| note.to_owned()));
        }
        let word = self.scanner.word("the end of the mesh")?;
        if word == "mfem_mesh_end" || version == Version::Parallel && word.starts_with(char::is_alphabetic) {
            return Ok(None);
        }
        let found = word.chars().take(40).collect();
        let what = "the end of the mesh (more numbers than announced?)";
        Err(self.scanner.flaw(Fault::Unexpected { what, found }))
    }

    fn curved(
        &self,
        placed: Placed,
        dimension: usize,
        order: Order,
        [cells, sides]: [&Elements; 2],
    ) -> Result<Assembly, Flaw> {
        let mut assembly = Assembly::new(placed.points).map_err(|fault| self.scanner.flaw(fault))?;
        assembly.parts.order = order;
        let mut rest = &placed.cells[..];
        for (cell, attribute, _) in cells.iter() {
            let (own, others) = rest.split_at(cell.node_count(order));
            rest = others;
            assembly.push(cell, EntityKey::new(dimension as u8, attribute), own);
        }
        for (n, ((cell, attribute, _), nodes)) in sides.iter().zip(placed.sides).enumerate() {
            let nodes = nodes.ok_or_else(|| self.scanner.flaw(MfemFault::Stray(n as u64 + 1)))?;
            assembly.push(cell, EntityKey::new(dimension as u8 - 1, attribute), &nodes);
        }
        if placed.apart > 0 {
            let note = "the mesh is joined to itself (periodic); what is joined is apart here";
            assembly.parts.notes.push(format!("{note}: {} nodes more", placed.apart));
        }
        Ok(assembly)
    }

    /// The space of the nodes, their coordinates, and whether those of a node follow one another.
    fn space(&mut self, cells: &Elements) -> Result<(Collection, usize, bool), Flaw> {
        let line = self.scanner.full_line("FiniteElementSpace")?;
        let is_long = line == "MFEM FiniteElementSpace v1.0";
        if !is_long && line != "FiniteElementSpace" {
            let found = line.chars().take(40).collect();
            return Err(self.scanner.flaw(Fault::Unexpected { what: "FiniteElementSpace", found }));
        }
        let name = self.value("FiniteElementCollection:")?;
        let has_all = |space: &Collection| cells.kinds.iter().all(|&(_, cell)| space.has(cell));
        let space = Collection::of(&name).filter(has_all);
        let space = space.ok_or_else(|| self.scanner.flaw(MfemFault::Collection(name)))?;
        let axes = self.value("VDim:")?.parse().unwrap_or(0);
        if !(2..=3).contains(&axes) {
            return Err(self.scanner.flaw(MfemFault::VectorDimension(axes)));
        }
        let ordering = self.value("Ordering:")?.parse().unwrap_or(-1);
        if !(0..=1).contains(&ordering) {
            return Err(self.scanner.flaw(MfemFault::Ordering(ordering)));
        }
        while is_long && !self.scanner.full_line("the end of the space")?.starts_with("End:") {}
        Ok((space, axes, ordering == 1))
    }

    /// What follows a key on its line.
    fn value(&mut self, key: &'static str) -> Result<String, Flaw> {
        let line = self.scanner.full_line(key)?;
        match line.strip_prefix(key) {
            Some(value) => Ok(value.trim().to_owned()),
            None => {
                let found = line.chars().take(40).collect();
                Err(self.scanner.flaw(Fault::Unexpected { what: key, found }))
            }
        }
    }

    /// Points: point by point, or axis by axis.
    fn values(&mut self, count: usize, axes: usize, by_point: bool) -> Result<Vec<DVec3>, Flaw> {
        let rest = self.scanner.rest();
        if (count * axes) as u64 > rest / 2 + 1 {
            return Err(self.scanner.flaw(Fault::Count { what: "points", count: count as u64, rest }));
        }
        let mut points = vec![DVec3::ZERO; count];
        for n in 0..count * axes {
            let (point, axis) = if by_point { (n / axes, n % axes) } else { (n % count, n / count) };
            points[point][axis] = self.scanner.number("a coordinate")?;
        }
        Ok(points)
    }
}

/// A vertex that stands twice among an element's.
fn repeated(corners: &[NodeId]) -> Option<usize> {
    let twice = |(n, corner): (usize, &NodeId)| corners[..n].contains(corner).then(|| corner.index());
    corners.iter().enumerate().find_map(twice)
}

/// A name as C++'s `std::quoted` writes it, or a word; and what follows.
fn quoted(line: &str) -> Option<(String, &str)> {
    let Some(text) = line.strip_prefix('"') else {
        let (name, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        return Some((name.to_owned(), rest));
    };
    let mut name = String::new();
    let mut characters = text.char_indices();
    while let Some((place, character)) = characters.next() {
        match character {
            '\\' => name.push(characters.next()?.1),
            '"' => return Some((name, &text[place + 1..])),
            other => name.push(other),
        }
    }
    None
}
