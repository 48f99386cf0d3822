//! The lines of an SU2 file.

use std::io::BufRead;

use glam::DVec3;

use super::fault::Su2Fault;
use super::type_code;
use super::zone::{self, Elements, Marker, Zone};
use crate::element::Cell;
use crate::formats::error::{Fault, Flaw, Place};
use crate::formats::scanner::Scanner;
use crate::mesh::Mesh;

/// Numbers that may stand behind what a line must have: indices, of which old files of parallel runs have two.
const INDICES: usize = 2;

/// Reads a mesh from a file's content of `length` bytes.
///
/// # Errors
/// The first [`Fault`] and its place. Memory stays within a small multiple of `length`.
pub(super) fn read(input: impl BufRead, length: u64) -> Result<Mesh, Flaw> {
    let mut file = File {
        scanner: Scanner::new(input, length),
        announced: None,
        ahead: None,
        zones: Vec::new(),
        passing_over: false,
    };
    let mut notes = Vec::new();
    while let Some(line) = file.line()? {
        file.section(&line, &mut notes)?;
    }
    file.end_zone(&mut notes)?;
    if let Some(announced) = file.announced.filter(|&announced| announced != file.zones.len() as u64) {
        let fault = Fault::Miscounted { what: "zones", announced, found: file.zones.len() as u64 };
        return Err(file.flaw(fault));
    }
    let last = file.scanner.place();
    zone::mesh(file.zones, notes).map_err(|(line, fault)| match line {
        Some(line) => Flaw::new(Place::Line(line), fault),
        None => Flaw::new(last, fault),
    })
}

struct File<R> {
    scanner: Scanner<R>,
    /// `NZONE=`.
    announced: Option<u64>,
    /// `NDIME=` before the first zone: that of the zones that do not say theirs.
    ahead: Option<usize>,
    zones: Vec<Zone>,
    /// Whether the lines behind the last key are of a section that is not read.
    passing_over: bool,
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

    /// The first number of a text.
    fn number(&self, what: &'static str, text: &str) -> Result<u64, Flaw> {
        let word = text.split_whitespace().next().unwrap_or_default();
        let found = || word.chars().take(40).collect();
        word.parse().map_err(|_| self.flaw(Fault::Number { what, found: found() }))
    }

    /// The first number of a text; each item that it counts takes a line.
    fn count(&self, what: &'static str, text: &str) -> Result<usize, Flaw> {
        let (count, rest) = (self.number(what, text)?, self.scanner.rest());
        match usize::try_from(count) {
            Ok(fits) if count <= rest => Ok(fits),
            _ => Err(self.flaw(Fault::Count { what, count, rest })),
        }
    }

    /// The present zone; a file of one zone does not announce it.
    fn zone(&mut self) -> &mut Zone {
        if self.zones.is_empty() {
            self.zones.push(Zone::default());
        }
        let last = self.zones.len() - 1;
        &mut self.zones[last]
    }

    fn section(&mut self, line: &str, notes: &mut Vec<String>) -> Result<(), Flaw> {
        if self.passing_over && !line.contains('=') {
            return Ok(());
        }
        let (key, value) = self.pair(line)?;
        self.passing_over = false;
        match key {
            "NZONE" => self.announced = Some(self.number("the number of zones", value)?),
            "IZONE" => {
                // The dimension may stand before the zones, and again in each.
                let bare = self.zones.pop_if(|zone| zone.is_bare());
                self.end_zone(notes)?;
                self.number("a zone's number", value)?;
                self.ahead = self.ahead.or(bare.and_then(|zone| zone.dimension));
                self.zones.push(Zone::default());
            }
            "NDIME" => {
                let dimension = match value {
                    "2" => 2,
                    "3" => 3,
                    _ => {
                        let found = value.chars().take(40).collect();
                        return Err(self.flaw(Fault::Number { what: "the dimension, 2 or 3", found }));
                    }
                };
                if self.zone().dimension.replace(dimension).is_some() {
                    return Err(self.flaw(Su2Fault::Repeated("NDIME")));
                }
            }
            "NELEM" => {
                let dimension = self.dimension("NELEM")?;
                let count = self.count("elements", value)?;
                let cells = self.elements(count, "NELEM", dimension)?;
                if self.zone().cells.replace(cells).is_some() {
                    return Err(self.flaw(Su2Fault::Repeated("NELEM")));
                }
            }
            "NPOIN" => self.read_points(value)?,
            "NMARK" => {
                let count = self.number("the number of markers", value)?;
                if self.zone().announced.replace(count).is_some() {
                    return Err(self.flaw(Su2Fault::Repeated("NMARK")));
                }
            }
            "MARKER_TAG" => self.marker(value, notes)?,
            _ => self.pass_over(key, notes),
        }
        Ok(())
    }

    /// Leaves the lines of a section that says nothing of the mesh.
    fn pass_over(&mut self, key: &str, notes: &mut Vec<String>) {
        self.passing_over = true;
        // The parts of one section are one section to the user.
        let stem = key.split('_').next().unwrap_or_default();
        let name = if stem == "NPERIODIC" { "PERIODIC" } else { stem };
        let note = format!("sections {name}... are not used (the first is {key}=)");
        let prefix = format!("sections {name}...");
        if !notes.iter().any(|known| known.starts_with(&prefix)) {
            notes.push(note);
        }
    }

    fn dimension(&mut self, later: &'static str) -> Result<usize, Flaw> {
        let known = self.zone().dimension.or(self.ahead);
        known.ok_or_else(|| self.flaw(Su2Fault::Order { earlier: "NDIME", later }))
    }

    fn read_points(&mut self, value: &str) -> Result<(), Flaw> {
        let dimension = self.dimension("NPOIN")?;
        let count = self.count("points", value)?;
        let mut points = Vec::with_capacity(count.min(1 << 20));
        let mut behind = None;
        for _ in 0..count {
            let line = self.full_line("the points")?;
            let mut words = line.split_whitespace();
            let mut point = DVec3::ZERO;
            for axis in 0..dimension {
                let word = words.next().unwrap_or_default();
                let what = "a point's coordinates";
                point[axis] = word
                    .parse()
                    .map_err(|_| self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }))?;
            }
            self.rest_of_line(words, &mut behind)?;
            points.push(point);
        }
        if self.zone().points.replace(points).is_some() {
            return Err(self.flaw(Su2Fault::Repeated("NPOIN")));
        }
        Ok(())
    }

    /// Behind what is read of a line only indices may stand, as many as on the lines before.
    fn rest_of_line<'a>(&self, words: impl Iterator<Item = &'a str>, before: &mut Option<usize>) -> Result<(), Flaw> {
        let mut found = 0;
        for word in words {
            found += 1;
            if found > INDICES || word.parse::<i64>().is_err() {
                let what = "the index at the end of a line (a number too many?)";
                return Err(self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }));
            }
        }
        match *before.get_or_insert(found) {
            known if known == found => Ok(()),
            before => Err(self.flaw(Su2Fault::LineLength { found, before })),
        }
    }

    fn marker(&mut self, name: &str, notes: &mut Vec<String>) -> Result<(), Flaw> {
        let dimension = self.dimension("MARKER_TAG")?;
        let line = self.full_line("a marker")?;
        let ("MARKER_ELEMS", count) = self.pair(&line)? else {
            let found = line.chars().take(40).collect();
            return Err(self.flaw(Fault::Unexpected { what: "MARKER_ELEMS=", found }));
        };
        let count = self.count("boundary elements", count)?;
        self.zone().markers_found += 1;
        if name == "SEND_RECEIVE" {
            notes.push("a marker SEND_RECEIVE, which lists points for communication, is not used".into());
            for _ in 0..count {
                if self.full_line("a marker's points")?.contains('=') {
                    self.full_line("a marker's points")?; // SEND_TO= stands before them
                }
            }
            return Ok(());
        }
        let elements = self.elements(count, "MARKER_ELEMS", dimension - 1)?;
        self.zone().markers.push(Marker { name: name.to_owned(), elements });
        Ok(())
    }

    /// So many lines of elements, all of one dimension.
    fn elements(&mut self, count: usize, key: &'static str, dimension: usize) -> Result<Elements, Flaw> {
        let mut elements = Elements::default();
        let mut behind = None;
        for _ in 0..count {
            let line = self.full_line("the elements")?;
            self.element(&line, key, dimension, &mut behind, &mut elements)?;
        }
        Ok(elements)
    }

    /// `type nodes...`, and perhaps its number.
    fn element(
        &self,
        line: &str,
        key: &'static str,
        dimension: usize,
        behind: &mut Option<usize>,
        elements: &mut Elements,
    ) -> Result<(), Flaw> {
        let what = "an element's type and nodes";
        let number = |word: Option<&str>| -> Result<i64, Flaw> {
            let word = word.unwrap_or_default();
            word.parse().map_err(|_| self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }))
        };
        let mut words = line.split_whitespace();
        let code = number(words.next())?;
        let Some((cell, order)) = type_code::meaning(code) else {
            return Err(self.flaw(Su2Fault::UnknownElementType(code)));
        };
        if cell.dimension() != dimension || cell == Cell::Point {
            return Err(self.flaw(Su2Fault::Dimension { cell, key, dimension }));
        }
        for _ in 0..cell.node_count(order) {
            elements.nodes.push(number(words.next())?);
        }
        self.rest_of_line(words, behind)?;
        elements.kinds.push((cell, order));
        elements.lines.push(self.scanner.line_number());
        Ok(())
    }

    /// Holds what the zone announced against what it has.
    fn end_zone(&mut self, notes: &mut Vec<String>) -> Result<(), Flaw> {
        let Some(zone) = self.zones.last() else { return Ok(()) };
        let (announced, found) = (zone.announced.unwrap_or(zone.markers_found), zone.markers_found);
        if zone.points.is_none() {
            return Err(self.flaw(Su2Fault::Missing("NPOIN")));
        }
        if zone.cells.is_none() {
            return Err(self.flaw(Su2Fault::Missing("NELEM")));
        }
        if found < announced {
            return Err(self.flaw(Fault::Miscounted { what: "markers (NMARK)", announced, found }));
        }
        if found > announced {
            notes.push(format!("NMARK announces {announced} markers, and there are {found}; all are read"));
        }
        Ok(())
    }
}
