//! SU2's native meshes, read: text, linear, boundary elements by marker.

mod fault;

use std::collections::HashMap;
use std::io::BufRead;

use glam::DVec3;

use super::assembly::{Assembly, node_of};
use super::detect::{Head, Verdict};
use super::error::{Fault, Flaw};
use super::format::{Format, Holds, Reader};
use super::scanner::Scanner;
use super::vtk::node_order::ORDER;
use super::vtk::type_code::{self, Type};
use crate::element::{Cell, Order};
use crate::mesh::{EntityKey, Mesh, NodeId};
use fault::Su2Fault;

/// The native format of the solver SU2.
pub(super) static FORMAT: Format = Format {
    name: "SU2",
    endings: &["su2"],
    detect,
    reader: Reader {
        holds: Holds {
            highest: Order::LINEAR,
            cells: &Cell::ALL,
            dimensions: &[2, 3],
            names: true,
            fields: false,
            notes: "text; one zone",
        },
        read: |input, _| read(input.content, input.length).map_err(|flaw| flaw.of(input.path)),
    },
    writer: None,
};

/// Whether the first line that is no comment is SU2's.
fn detect(head: &Head) -> Verdict {
    let lines = head.lines();
    let line = lines.iter().find(|line| !line.is_empty() && !line.starts_with('%'));
    match line.and_then(|line| line.split_once('=')).map(|(key, _)| key.trim()) {
        Some("NDIME" | "NZONE" | "IZONE" | "NELEM" | "NPOIN" | "NMARK" | "NPERIODIC") => Verdict::ByContent,
        _ => Verdict::No,
    }
}

/// Reads a mesh from a file's content of `length` bytes.
///
/// # Errors
/// The first [`Fault`] and its place. Memory stays within a small multiple of `length`.
fn read(input: impl BufRead, length: u64) -> Result<Mesh, Flaw> {
    let mut file = File {
        scanner: Scanner::new(input, length),
        dimension: 0,
        points: None,
        cells: Vec::new(),
        markers: Vec::new(),
        zones: 0,
    };
    while let Some(line) = file.line()? {
        file.section(&line)?;
    }
    file.mesh()
}

/// An element as it stands in the file.
struct Element {
    cell: Cell,
    nodes: [i64; 8],
}

struct File<R> {
    scanner: Scanner<R>,
    dimension: usize,
    points: Option<Vec<DVec3>>,
    cells: Vec<Element>,
    markers: Vec<(String, Vec<Element>)>,
    /// Zones whose elements were met.
    zones: usize,
}

impl<R: BufRead> File<R> {
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        self.scanner.flaw(fault)
    }

    /// The next line with something in it, without comments.
    fn line(&mut self) -> Result<Option<String>, Flaw> {
        while let Some(line) = self.scanner.line("a line")? {
            let text = line.split('%').next().unwrap_or_default().trim();
            if !text.is_empty() {
                return Ok(Some(text.to_owned()));
            }
        }
        Ok(None)
    }

    fn full_line(&mut self, what: &'static str) -> Result<String, Flaw> {
        self.line()?.ok_or_else(|| self.flaw(Fault::Truncated(what)))
    }

    /// The key and the value of a line.
    fn pair<'a>(&self, line: &'a str) -> Result<(&'a str, &'a str), Flaw> {
        let unexpected = || Fault::Unexpected {
            what: "KEY= value (fewer items than announced, or more?)",
            found: line.chars().take(40).collect(),
        };
        let (key, value) = line.split_once('=').ok_or_else(|| self.flaw(unexpected()))?;
        Ok((key.trim(), value.trim()))
    }

    /// The first number of a text; each item that it counts takes a line.
    fn count(&self, what: &'static str, text: &str) -> Result<usize, Flaw> {
        let word = text.split_whitespace().next().unwrap_or_default();
        let found = || word.chars().take(40).collect();
        let count: u64 = word.parse().map_err(|_| self.flaw(Fault::Number { what, found: found() }))?;
        let rest = self.scanner.rest();
        match usize::try_from(count) {
            Ok(fits) if count <= rest => Ok(fits),
            _ => Err(self.flaw(Fault::Count { what, count, rest })),
        }
    }

    fn section(&mut self, line: &str) -> Result<(), Flaw> {
        let (key, value) = self.pair(line)?;
        match key {
            "NDIME" => {
                self.dimension = match value {
                    "2" => 2,
                    "3" => 3,
                    _ => {
                        let found = value.chars().take(40).collect();
                        return Err(self.flaw(Fault::Number { what: "the dimension, 2 or 3", found }));
                    }
                };
            }
            "NELEM" => {
                self.zones += 1;
                let count = self.count("elements", value)?;
                self.cells = self.elements(count)?;
            }
            "NPOIN" => self.read_points(value)?,
            "MARKER_TAG" => {
                let name = value.to_owned();
                let line = self.full_line("a marker")?;
                let ("MARKER_ELEMS", count) = self.pair(&line)? else {
                    let found = line.chars().take(40).collect();
                    return Err(self.flaw(Fault::Unexpected { what: "MARKER_ELEMS=", found }));
                };
                let count = self.count("boundary elements", count)?;
                let elements = self.elements(count)?;
                self.markers.push((name, elements));
            }
            // Counts that the items themselves tell, and what no linear mesh needs.
            _ => {}
        }
        if self.zones > 1 {
            let found = "a second zone".into();
            return Err(self.flaw(Fault::Unexpected { what: "one zone; write each to a file of its own", found }));
        }
        Ok(())
    }

    fn read_points(&mut self, value: &str) -> Result<(), Flaw> {
        if self.dimension == 0 {
            return Err(self.flaw(Su2Fault::Order { earlier: "NDIME", later: "NPOIN" }));
        }
        let count = self.count("points", value)?;
        let mut points = Vec::with_capacity(count.min(1 << 20));
        for _ in 0..count {
            let line = self.full_line("the points")?;
            let mut words = line.split_whitespace();
            let mut point = DVec3::ZERO;
            for axis in 0..self.dimension {
                let word = words.next().unwrap_or_default();
                let what = "a point's coordinates";
                point[axis] = word
                    .parse()
                    .map_err(|_| self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }))?;
            }
            points.push(point);
        }
        self.points = Some(points);
        Ok(())
    }

    fn elements(&mut self, count: usize) -> Result<Vec<Element>, Flaw> {
        let mut elements = Vec::with_capacity(count.min(1 << 20));
        for _ in 0..count {
            let line = self.full_line("the elements")?;
            elements.push(self.element(&line)?);
        }
        Ok(elements)
    }

    /// `type nodes...`, and perhaps its number.
    fn element(&self, line: &str) -> Result<Element, Flaw> {
        let what = "an element's type and nodes";
        let number = |word: Option<&str>| -> Result<i64, Flaw> {
            let word = word.unwrap_or_default();
            word.parse().map_err(|_| self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }))
        };
        let mut words = line.split_whitespace();
        let code = number(words.next())?;
        let known = Cell::ALL.into_iter().find(|cell| {
            matches!(type_code::meaning(code, cell.corner_count()), Type::Complete(c, Order::LINEAR) if c == *cell)
        });
        let Some(cell) = known else {
            return Err(self.flaw(Su2Fault::UnknownElementType(code)));
        };
        let mut nodes = [0; 8];
        for node in &mut nodes[..cell.corner_count()] {
            *node = number(words.next())?;
        }
        Ok(Element { cell, nodes })
    }

    fn mesh(mut self) -> Result<Mesh, Flaw> {
        let Some(points) = self.points.take() else {
            return Err(self.flaw(Su2Fault::Missing("NPOIN")));
        };
        let count = points.len();
        let flaw = |fault| self.scanner.flaw(fault);
        let mut assembly = Assembly::new(points).map_err(flaw)?;
        let mut nodes: Vec<NodeId> = Vec::new();
        let mut push = |assembly: &mut Assembly, element: &Element, entity: EntityKey, by: u64| {
            let slots = ORDER.slots(element.cell, Order::LINEAR).unwrap_or_default();
            nodes.clear();
            for &slot in slots {
                nodes.push(node_of(count, element.nodes[usize::from(slot)], 0, by)?);
            }
            assembly.push(element.cell, entity, &nodes);
            Ok(())
        };
        for (n, element) in self.cells.iter().enumerate() {
            let entity = EntityKey::new(element.cell.dimension() as u8, 1);
            push(&mut assembly, element, entity, n as u64).map_err(flaw)?;
        }
        let mut tags: HashMap<&str, i32> = HashMap::new();
        for (name, elements) in &self.markers {
            let next = tags.len() as i32 + 1;
            let tag = *tags.entry(name).or_insert(next);
            for (n, element) in elements.iter().enumerate() {
                let entity = EntityKey::new(element.cell.dimension() as u8, tag);
                push(&mut assembly, element, entity, n as u64).map_err(flaw)?;
            }
            if let Some(element) = elements.first().filter(|_| tag == next) {
                let dimension = element.cell.dimension() as u8;
                let group = assembly.group(dimension, name, Some(tag));
                assembly.entity(EntityKey::new(dimension, tag), vec![group]);
            }
        }
        assembly.finish().map_err(|fault| self.scanner.flaw(fault))
    }
}
