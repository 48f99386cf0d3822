//! VTU: XML, with arrays as text, as base64 in place, or appended behind the XML as base64 or raw bytes.

use std::borrow::Cow;

use quick_xml::Reader;
use quick_xml::escape::resolve_xml_entity;
use quick_xml::events::{BytesStart, Event};

use super::array::{Number, Values};
use super::encoded::Source;
use super::fault::VtkFault;
use super::grid::Grid;
use super::header::Header;
use crate::formats::error::{Fault, Flaw, Place};
use crate::formats::well_formed;
use crate::mesh::Mesh;

/// Reads a mesh from a file's whole content; its arrays may take `memory` bytes.
///
/// # Errors
/// The first [`Fault`] and its place.
pub(super) fn read(content: &[u8], memory: u64) -> Result<Mesh, Flaw> {
    let (head, appended) = split(content)?;
    let room = ROOM.saturating_add((content.len() as u64).saturating_mul(EXPANSION)).min(memory);
    well_formed::characters(head)?;
    let mut file = File { appended, room, ..File::default() };
    file.parse(head)?;
    // The tag of the appended data stands within the outermost element.
    let open = usize::from(head.len() < content.len());
    if file.open.len() > open {
        return Err(file.flaw(Fault::Truncated("the XML")));
    }
    let end = Place::Byte(file.place);
    file.grid.mesh().map_err(|fault| Flaw::new(end, fault))
}

/// Bytes that the numbers of a file may take in memory, as 8 each, and how many more for each byte of the file: compressed arrays
/// of meshes expand by far less, and an array of zeros by a thousand.
const ROOM: u64 = 64 << 20;
const EXPANSION: u64 = 100;

/// The most nodes that a cell has that is read.
const MOST_NODES: u64 = 125;

/// The XML, and the appended data behind the underscore. Raw ones are no XML, and hide it from a parser.
fn split(content: &[u8]) -> Result<(&[u8], Appended<'_>), Flaw> {
    let name = b"<AppendedData";
    let Some(at) = content.windows(name.len()).position(|window| window == name) else {
        return Ok((content, Appended::default()));
    };
    let place = |at: usize| Place::Byte(at as u64);
    let cut = || Flaw::new(place(at), Fault::Truncated("the appended data"));
    let tag = content[at..].iter().position(|&byte| byte == b'>').ok_or_else(cut)?;
    let raw = content[at..at + tag].windows(5).any(|window| window == b"\"raw\"");
    let start = content[at + tag..].iter().position(|&byte| byte == b'_').ok_or_else(cut)?;
    let start = at + tag + start + 1;
    Ok((&content[..at], Appended { bytes: &content[start..], start, raw }))
}

#[derive(Clone, Copy, Default)]
struct Appended<'a> {
    bytes: &'a [u8],
    /// Their place in the file.
    start: usize,
    raw: bool,
}

/// Where an array's values stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Text,
    Inline,
    Appended,
}

/// An array as its tag tells of it.
#[derive(Debug)]
struct Array {
    section: String,
    name: String,
    number: Number,
    components: u64,
    form: Form,
    offset: usize,
    text: Vec<u8>,
}

/// A piece as its tag tells of it, and what the pieces before it have.
#[derive(Debug, Default)]
struct Piece {
    points: Option<u64>,
    cells: Option<u64>,
    points_before: usize,
    nodes_before: usize,
    cells_before: usize,
}

impl Piece {
    /// The most numbers that an array of the piece can have, where the counts tell.
    fn most(&self, array: &Array) -> Option<u64> {
        match (array.section.as_str(), array.name.as_str()) {
            ("Points", _) => self.points?.checked_mul(3),
            ("Cells", "connectivity") => self.cells?.checked_mul(MOST_NODES),
            _ => self.cells,
        }
    }
}

#[derive(Default)]
struct File<'a> {
    appended: Appended<'a>,
    header: Header,
    grid: Grid,
    piece: Piece,
    /// Bytes that numbers may still take.
    room: u64,
    /// Names of the open elements.
    open: Vec<String>,
    /// Whether the outermost element has begun.
    root: bool,
    /// The array whose element is open.
    array: Option<Array>,
    /// Bytes of the XML that were parsed.
    place: u64,
}

impl File<'_> {
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        Flaw::new(Place::Byte(self.place), fault)
    }

    fn parse(&mut self, head: &[u8]) -> Result<(), Flaw> {
        let mut reader = Reader::from_reader(head);
        loop {
            self.place = reader.buffer_position();
            let event = reader.read_event().map_err(|error| self.flaw(Fault::Xml(error.to_string())))?;
            match event {
                Event::Start(start) => {
                    self.check(&start)?;
                    self.start(&start)?;
                    self.root = true;
                    self.open.push(String::from_utf8_lossy(start.local_name().as_ref().as_bytes()).into_owned());
                }
                Event::Empty(start) => {
                    self.check(&start)?;
                    self.start(&start)?;
                    // What is empty within an array, such as an InformationKey, does not end it.
                    match start.local_name().as_ref().as_bytes() {
                        b"DataArray" => self.end_array()?,
                        b"Piece" => self.end_piece()?,
                        _ => {}
                    }
                }
                Event::Text(text) => {
                    // Text within an InformationKey of an array is none of its values.
                    if self.in_array()
                        && let Some(array) = &mut self.array
                    {
                        array.text.extend_from_slice(text.as_bytes());
                    } else if !text.as_bytes().trim_ascii().is_empty() && self.has_no_text() {
                        let found = String::from_utf8_lossy(text.as_bytes()).trim().chars().take(40).collect();
                        return Err(self.flaw(Fault::Unexpected { what: "a tag", found }));
                    }
                }
                Event::End(end) => {
                    self.open.pop();
                    match end.local_name().as_ref().as_bytes() {
                        b"DataArray" => self.end_array()?,
                        b"Piece" => self.end_piece()?,
                        _ => {}
                    }
                }
                // Behind a mark of the encoding at most.
                Event::Decl(_) if self.place > 3 => {
                    return Err(self.flaw(Fault::Xml("a declaration that does not stand first".into())));
                }
                Event::Decl(found) => well_formed::declaration(&found).map_err(|fault| self.flaw(fault))?,
                // No program writes numbers so; left out they would be lost.
                Event::CData(_) | Event::GeneralRef(_) if self.in_array() || self.has_no_text() => {
                    return Err(self.flaw(Fault::Xml("a reference or CDATA where there is none".into())));
                }
                Event::GeneralRef(name) if !name.is_char_ref() && resolve_xml_entity(&name).is_none() => {
                    return Err(self.flaw(Fault::Xml("a reference to nothing".into())));
                }
                Event::Eof => return Ok(()),
                _ => {}
            }
        }
    }

    /// Whether the element that is open is an array itself, and not within one.
    fn in_array(&self) -> bool {
        self.open.last().is_some_and(|name| name == "DataArray")
    }

    /// Whether the element that is open holds elements alone; so does the file itself.
    fn has_no_text(&self) -> bool {
        let known = ["VTKFile", "UnstructuredGrid", "Piece", "Points", "Cells", "CellData", "PointData"];
        self.open.last().is_none_or(|name| known.contains(&name.as_str()))
    }

    /// Refuses a tag that is none, and a second root.
    fn check(&self, start: &BytesStart) -> Result<(), Flaw> {
        if self.root && self.open.is_empty() {
            return Err(self.flaw(Fault::Xml("an element behind the end".into())));
        }
        well_formed::tag(start).map_err(|fault| self.flaw(fault))
    }

    fn start(&mut self, start: &BytesStart) -> Result<(), Flaw> {
        let text = |name: &str| -> Option<String> {
            let attribute = start.try_get_attribute(name).ok()??;
            Some(String::from_utf8_lossy(attribute.value.as_ref().as_bytes()).into_owned())
        };
        match start.local_name().as_ref().as_bytes() {
            b"VTKFile" => {
                self.header = Header::new(text).map_err(|fault| self.flaw(fault))?;
                self.grid.old_hexes = self.header.version.map(|version| version < (2, 1));
            }
            b"Piece" => {
                let count = |what: &'static str| -> Result<Option<u64>, Flaw> {
                    let word = text(what).unwrap_or_default();
                    let found = || word.chars().take(40).collect();
                    let count = word.trim().parse();
                    count.map(Some).map_err(|_| self.flaw(Fault::Number { what, found: found() }))
                };
                self.piece = Piece {
                    points: count("NumberOfPoints")?,
                    cells: count("NumberOfCells")?,
                    points_before: self.grid.points.len() / 3,
                    nodes_before: self.grid.connectivity.len(),
                    cells_before: self.grid.types.len(),
                };
            }
            b"DataArray" => {
                let kind = text("type").unwrap_or_default();
                let number = Number::of(&kind);
                let section = self.open.last().cloned().unwrap_or_default();
                let name = text("Name").unwrap_or_default();
                let components = text("NumberOfComponents").and_then(|word| word.trim().parse().ok()).unwrap_or(1);
                if !wanted(&section, &name, components) {
                    return Ok(());
                }
                let Some(number) = number else {
                    return Err(self.flaw(Fault::Unexpected { what: "a type of numbers", found: kind }));
                };
                let form = match text("format").as_deref() {
                    Some("appended") => Form::Appended,
                    Some("binary") => Form::Inline,
                    Some("ascii") => Form::Text,
                    other => {
                        let found = other.unwrap_or_default().chars().take(40).collect();
                        return Err(self.flaw(Fault::Unexpected { what: "format: ascii, binary or appended", found }));
                    }
                };
                let offset = match form {
                    Form::Appended => {
                        let word = text("offset").unwrap_or_default();
                        let found = || word.chars().take(40).collect();
                        let what = "an array's offset";
                        word.trim().parse().map_err(|_| self.flaw(Fault::Number { what, found: found() }))?
                    }
                    _ => 0,
                };
                self.array = Some(Array { section, name, number, components, form, offset, text: Vec::new() });
            }
            _ => {}
        }
        Ok(())
    }

    /// Takes the array whose element ends into the grid.
    fn end_array(&mut self) -> Result<(), Flaw> {
        let Some(array) = self.array.take() else { return Ok(()) };
        let values = self.values(&array)?;
        let grid = &mut self.grid;
        let whole = |values: Values| values.whole().unwrap_or_default(); // read as whole numbers, they are
        match (array.section.as_str(), array.name.as_str()) {
            ("Points", _) => {
                if array.components != 3 {
                    let fault =
                        Fault::Unexpected { what: "points of three coordinates", found: array.components.to_string() };
                    return Err(self.flaw(fault));
                }
                grid.points.extend(values.real());
            }
            ("Cells", "connectivity") => {
                let before = self.piece.points_before as i64;
                grid.connectivity.extend(whole(values).into_iter().map(|n| n.saturating_add(before)));
            }
            ("Cells", "offsets") => {
                let before = self.piece.nodes_before as i64;
                grid.offsets.extend(whole(values).into_iter().map(|n| n.saturating_add(before)));
            }
            ("Cells", "types") => grid.types.extend(whole(values)),
            _ => grid.take(&array.name, values),
        }
        Ok(())
    }

    /// Holds the counts of the piece that ends against what it has.
    fn end_piece(&mut self) -> Result<(), Flaw> {
        let Piece { points, cells, points_before, nodes_before, cells_before } = std::mem::take(&mut self.piece);
        let grid = &self.grid;
        let compare = |what, announced: Option<u64>, found: usize| match announced {
            Some(announced) if announced != found as u64 => {
                Err(self.flaw(Fault::Miscounted { what, announced, found: found as u64 }))
            }
            _ => Ok(()),
        };
        compare("points of a piece", points, grid.points.len() / 3 - points_before)?;
        compare("cells of a piece", cells, grid.types.len() - cells_before)?;
        compare("ends of cells of a piece", cells, grid.offsets.len().saturating_sub(cells_before))?;
        let nodes = grid.offsets[cells_before.min(grid.offsets.len())..].last().map_or(nodes_before as i64, |&end| end);
        compare("nodes of cells of a piece", u64::try_from(nodes).ok(), grid.connectivity.len())?;
        grid.compare().map_err(|fault| self.flaw(fault))
    }

    fn values(&mut self, array: &Array) -> Result<Values, Flaw> {
        // An array that may be of use may also hold what is not whole; it is of none then.
        let mut values = if array.section == "Cells" { Values::Whole(Vec::new()) } else { Values::Real(Vec::new()) };
        if array.form == Form::Text {
            let text = std::str::from_utf8(&array.text).map_err(|_| self.flaw(Fault::NotUtf8("an array")))?;
            for word in text.split_ascii_whitespace() {
                values.push_word(word).map_err(|fault| self.flaw(fault))?;
            }
            return Ok(values);
        }
        let (bytes, raw, place) = match array.form {
            Form::Appended => {
                let bytes = self.appended.bytes.get(array.offset..).unwrap_or_default();
                (bytes, self.appended.raw, Place::Byte((self.appended.start + array.offset) as u64))
            }
            _ => (array.text.trim_ascii(), false, Place::Byte(self.place)),
        };
        let Some(big_endian) = self.header.big_endian else {
            return Err(Flaw::new(place, VtkFault::ByteOrder));
        };
        let mut source = Source { bytes, raw };
        let width = array.number.width() as u64;
        let room = self.room / 8 * width;
        let limit = self.piece.most(array).map_or(room, |most| most.saturating_mul(width).min(room));
        let decoded = self.content(&mut source, limit).map_err(|fault| Flaw::new(place.clone(), fault))?;
        if array.form == Form::Inline && !source.bytes.is_empty() {
            return Err(Flaw::new(place, VtkFault::Leftover(source.bytes.len())));
        }
        let decoded = array.number.decode(&decoded, big_endian, &mut values);
        decoded.map_err(|fault| Flaw::new(place, fault))?;
        self.room = self.room.saturating_sub(8 * values.len() as u64);
        Ok(values)
    }

    /// The bytes of an array behind their header; `limit` of them at most where they are compressed.
    fn content<'s>(&self, source: &mut Source<'s>, limit: u64) -> Result<Cow<'s, [u8]>, Fault> {
        let width = if self.header.long_lengths { 8 } else { 4 };
        let Some(compressor) = self.header.compressor else {
            return source.counted(width, |header| self.number(header));
        };
        // The header's length is not known before its first number; base64 encodes it apart from the blocks.
        let first = source.peek(3 * width)?;
        let [blocks, size, last] = std::array::from_fn(|n| self.number(&first[n * width..(n + 1) * width]));
        let header = usize::try_from(blocks).ok().and_then(|n| n.checked_add(3)?.checked_mul(width));
        let header = header.ok_or(Fault::Truncated("a compressed array"))?;
        let header = source.take(header)?;
        let sizes: Vec<u64> = header.chunks_exact(width).skip(3).map(|bytes| self.number(bytes)).collect();
        let all = sizes.iter().try_fold(0_u64, |sum, &size| sum.checked_add(size));
        let all = all.and_then(|all| usize::try_from(all).ok()).ok_or(Fault::Truncated("a compressed array"))?;
        // What the header says is the limit of what is expanded.
        let announced = blocks.saturating_sub(u64::from(last > 0)).saturating_mul(size).saturating_add(last);
        if announced > limit {
            return Err(VtkFault::Expanded { announced, limit }.into());
        }
        let blocks = source.take(all)?;
        let mut rest = &blocks[..];
        let mut content = Vec::new();
        for (n, &length) in sizes.iter().enumerate() {
            let Some(block) = rest.split_off(..length as usize) else {
                return Err(Fault::Truncated("a compressed array"));
            };
            let size = if n + 1 == sizes.len() && last > 0 { last } else { size };
            compressor.expand(block, size, &mut content)?;
        }
        Ok(content.into())
    }

    /// A header's number.
    fn number(&self, bytes: &[u8]) -> u64 {
        let mut wide = [0; 8];
        if self.header.big_endian == Some(true) {
            wide[8 - bytes.len()..].copy_from_slice(bytes);
            u64::from_be_bytes(wide)
        } else {
            wide[..bytes.len()].copy_from_slice(bytes);
            u64::from_le_bytes(wide)
        }
    }
}

/// Whether an array is of use.
fn wanted(section: &str, name: &str, components: u64) -> bool {
    match section {
        "Points" => true,
        "Cells" => matches!(name, "connectivity" | "offsets" | "types"),
        "CellData" => components == 1 && Grid::wants(name),
        _ => false,
    }
}
