//! Legacy VTK files, versions 1 to 5.1, as text and as bytes (which are big-endian).

use std::io::BufRead;

use super::array::{Number, Values};
use super::fault::VtkFault;
use super::grid::Grid;
use crate::formats::error::{Fault, Flaw};
use crate::formats::scanner::Scanner;
use crate::mesh::Mesh;

/// Sections without which there is no grid; each stands once.
const NEEDED: [&str; 3] = ["POINTS", "CELLS", "CELL_TYPES"];

/// Numbers read in one go.
const PIECE: usize = 1 << 16;

/// Reads a mesh from a file's content of `length` bytes.
///
/// # Errors
/// The first [`Fault`] and its place.
pub(super) fn read(input: impl BufRead, length: u64) -> Result<Mesh, Flaw> {
    let mut scanner = Scanner::new(input, length);
    let line = scanner.full_line("the header")?;
    // It says how the nodes of some cells are ordered.
    let version = line.strip_prefix("# vtk DataFile Version").and_then(|rest| rest.trim().parse::<f64>().ok());
    let version = version.ok_or_else(|| unexpected(&scanner, "# vtk DataFile Version and its number", &line))?;
    scanner.end_line("the header")?;
    scanner.rest_of_line()?; // the title, which may be empty
    let encoding = scanner.full_line("the encoding")?;
    let binary = match encoding.as_str() {
        "ASCII" => false,
        "BINARY" => true,
        _ => return Err(unexpected(&scanner, "ASCII or BINARY", &encoding)),
    };
    let dataset = scanner.full_line("the kind of dataset")?;
    if dataset.split_whitespace().collect::<Vec<_>>() != ["DATASET", "UNSTRUCTURED_GRID"] {
        return Err(unexpected(&scanner, "DATASET UNSTRUCTURED_GRID (others are not read)", &dataset));
    }
    let mut file = File {
        scanner,
        binary,
        grid: Grid { old_hexes: Some(version < 5.1), ..Grid::default() },
        values_of: None,
        seen: Vec::new(),
    };
    while let Some(line) = file.scanner.line("a keyword")? {
        file.section(&line)?;
    }
    let File { grid, scanner, seen, .. } = file;
    if let Some(missing) = NEEDED.iter().find(|section| !seen.contains(section)) {
        return Err(scanner.flaw(VtkFault::Missing(missing)));
    }
    grid.mesh().map_err(|fault| scanner.flaw(fault))
}

fn unexpected<R: BufRead>(scanner: &Scanner<R>, what: &'static str, found: &str) -> Flaw {
    scanner.flaw(Fault::Unexpected { what, found: found.chars().take(40).collect() })
}

/// What the arrays that follow belong to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Support {
    Cells(u64),
    Points(u64),
}

struct File<R> {
    scanner: Scanner<R>,
    binary: bool,
    grid: Grid,
    values_of: Option<Support>,
    /// Which of [`NEEDED`] were read.
    seen: Vec<&'static str>,
}

impl<R: BufRead> File<R> {
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        self.scanner.flaw(fault)
    }

    /// A keyword's line and what follows it.
    fn section(&mut self, line: &str) -> Result<(), Flaw> {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["POINTS", count, kind] => {
                let count = self.count(count)?;
                self.once("POINTS")?;
                self.grid.points = self.array(kind, count.saturating_mul(3), false)?.real();
            }
            ["CELLS", count, size] => self.cells(count, size)?,
            ["CELL_TYPES", count] => {
                let count = self.count(count)?;
                self.once("CELL_TYPES")?;
                self.grid.types = self.whole("int", count)?;
            }
            ["CELL_DATA", count] => {
                let count = self.count(count)?;
                self.compare("cells (CELL_DATA)", count, self.grid.types.len())?;
                self.values_of = Some(Support::Cells(count));
            }
            ["POINT_DATA", count] => {
                let count = self.count(count)?;
                self.compare("points (POINT_DATA)", count, self.grid.points.len() / 3)?;
                self.values_of = Some(Support::Points(count));
            }
            ["SCALARS", name, kind, ref rest @ ..] if rest.len() < 2 => {
                let components = rest.first().map_or(Ok(1), |word| self.count(word))?;
                self.typed("LOOKUP_TABLE")?;
                self.attribute(name, kind, components)?;
            }
            ["VECTORS" | "NORMALS", name, kind] => self.attribute(name, kind, 3)?,
            ["TENSORS", name, kind] => self.attribute(name, kind, 9)?,
            ["GLOBAL_IDS" | "PEDIGREE_IDS", name, kind] => self.attribute(name, kind, 1)?,
            ["TEXTURE_COORDINATES", name, components, kind] => {
                let components = self.count(components)?;
                self.attribute(name, kind, components)?;
            }
            ["FIELD", _, count] => {
                for _ in 0..self.count(count)? {
                    self.field()?;
                }
            }
            ["METADATA"] => self.scanner.skip_paragraph()?,
            _ => return Err(unexpected(&self.scanner, "a keyword of an unstructured grid", line)),
        }
        Ok(())
    }

    fn count(&self, word: &str) -> Result<u64, Flaw> {
        let found = || word.chars().take(40).collect();
        word.parse().map_err(|_| self.flaw(Fault::Number { what: "a count", found: found() }))
    }

    /// Refuses a second section of a kind.
    fn once(&mut self, section: &'static str) -> Result<(), Flaw> {
        if self.seen.contains(&section) {
            return Err(self.flaw(VtkFault::Repeated(section)));
        }
        self.seen.push(section);
        Ok(())
    }

    /// Holds a count against what there is.
    fn compare(&self, what: &'static str, announced: u64, found: usize) -> Result<(), Flaw> {
        let found = found as u64;
        if announced == found { Ok(()) } else { Err(self.flaw(Fault::Miscounted { what, announced, found })) }
    }

    /// Connectivity: each cell with its count before it, or, from version 5.0 on, ends and nodes as two arrays.
    fn cells(&mut self, count: &str, size: &str) -> Result<(), Flaw> {
        let (count, size) = (self.count(count)?, self.count(size)?);
        self.once("CELLS")?;
        let is_offsets = self.scanner.next_is(b"OFFSETS")?;
        if is_offsets {
            let kind = self.typed("OFFSETS")?;
            let mut offsets = self.whole(&kind, count)?;
            if let Some(first) = offsets.first().filter(|&&first| first != 0) {
                let found = first.to_string();
                return Err(self.flaw(Fault::Number { what: "the first of OFFSETS, which is 0", found }));
            }
            offsets.drain(..offsets.len().min(1));
            self.grid.offsets = offsets;
            let kind = self.typed("CONNECTIVITY")?;
            self.grid.connectivity = self.whole(&kind, size)?;
            return Ok(());
        }
        let values = self.whole("int", size)?;
        let mut rest = &values[..];
        while let Some((&nodes, more)) = rest.split_first() {
            let nodes = usize::try_from(nodes).ok().filter(|&nodes| nodes <= more.len());
            let Some(nodes) = nodes else {
                let fault = Fault::Number { what: "the number of a cell's nodes", found: rest[0].to_string() };
                return Err(self.flaw(fault));
            };
            self.grid.connectivity.extend_from_slice(&more[..nodes]);
            self.grid.offsets.push(self.grid.connectivity.len() as i64);
            rest = &more[nodes..];
        }
        self.compare("cells (CELLS)", count, self.grid.offsets.len())
    }

    /// The type in a line `NAME type`, or the name in one like it.
    fn typed(&mut self, name: &'static str) -> Result<String, Flaw> {
        let line = self.scanner.full_line(name)?;
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            [word, kind] if word == name => Ok(kind.to_owned()),
            _ => Err(unexpected(&self.scanner, name, &line)),
        }
    }

    fn attribute(&mut self, name: &str, kind: &str, components: u64) -> Result<(), Flaw> {
        let Some(support) = self.values_of else {
            return Err(unexpected(&self.scanner, "CELL_DATA or POINT_DATA before values", name));
        };
        let (Support::Cells(count) | Support::Points(count)) = support;
        let values = self.array(kind, count.saturating_mul(components), false)?;
        if matches!(support, Support::Cells(_)) && components == 1 {
            self.grid.take(name, values);
        }
        Ok(())
    }

    /// An array of a field: `name components tuples type`.
    fn field(&mut self) -> Result<(), Flaw> {
        let mut line = self.scanner.full_line("a field's array")?;
        while line == "METADATA" {
            self.scanner.skip_paragraph()?;
            line = self.scanner.full_line("a field's array")?;
        }
        let [name, components, tuples, kind] = line.split_whitespace().collect::<Vec<_>>()[..] else {
            return Err(unexpected(&self.scanner, "an array's name, components, tuples and type", &line));
        };
        let (components, tuples) = (self.count(components)?, self.count(tuples)?);
        let values = self.array(kind, components.saturating_mul(tuples), false)?;
        if matches!(self.values_of, Some(Support::Cells(_))) && components == 1 {
            self.grid.take(name, values);
        }
        Ok(())
    }

    /// The whole numbers that follow the present line.
    fn whole(&mut self, kind: &str, count: u64) -> Result<Vec<i64>, Flaw> {
        Ok(self.array(kind, count, true)?.whole().unwrap_or_default()) // read as whole numbers, they are
    }

    /// The values that follow the present line.
    fn array(&mut self, kind: &str, count: u64, whole: bool) -> Result<Values, Flaw> {
        let what = "an array's values";
        let Some(number) = Number::of(kind) else {
            return Err(unexpected(&self.scanner, "a type of numbers", kind));
        };
        let least = if self.binary { number.width() as u64 } else { 2 };
        let rest = self.scanner.rest();
        if count > (rest + 1) / least {
            return Err(self.flaw(Fault::Count { what, count, rest }));
        }
        let count = count as usize; // no more than the file has bytes
        let mut values =
            if whole { Values::Whole(Vec::with_capacity(count)) } else { Values::Real(Vec::with_capacity(count)) };
        if !self.binary {
            for _ in 0..count {
                let word = self.scanner.word(what)?.to_owned();
                values.push_word(&word).map_err(|fault| self.flaw(fault))?;
            }
            return Ok(values);
        }
        if count > 0 {
            self.scanner.end_line(what)?;
        }
        let mut bytes = Vec::new();
        for start in (0..count).step_by(PIECE) {
            bytes.resize(number.width() * PIECE.min(count - start), 0);
            self.scanner.fill(&mut bytes, what)?;
            number.decode(&bytes, true, &mut values).map_err(|fault| self.flaw(fault))?;
        }
        Ok(values)
    }
}
