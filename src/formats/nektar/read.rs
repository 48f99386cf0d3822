//! The sections of a file from its XML.

use glam::DVec3;
use quick_xml::escape::resolve_xml_entity;
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::assemble;
use super::fault::NektarFault;
use super::packed::{Curves, Unpacked};
use super::shape;
use super::tables::{Listed, Points, Row, Tables};
use crate::formats::error::{Fault, Flaw, Place};
use crate::formats::well_formed;
use crate::mesh::Mesh;

/// Reads a mesh from a file's whole content; it may take `memory` bytes.
///
/// # Errors
/// The first [`Fault`] and its place.
pub(super) fn read(content: &[u8], memory: u64) -> Result<Mesh, Flaw> {
    well_formed::characters(content)?;
    let mut file = File::default();
    file.parse(content)?;
    let end = Place::Byte(content.len() as u64);
    if !file.has_geometry {
        return Err(Flaw::new(end, NektarFault::NoGeometry));
    }
    for (own, of_edges) in [(&mut file.tables.curved_edges, true), (&mut file.tables.curved_faces, false)] {
        own.extend(file.curves.unpacked(of_edges).map_err(|fault| Flaw::new(end.clone(), fault))?);
    }
    file.scale();
    assemble::mesh(file.tables, memory).map_err(|fault| Flaw::new(end, fault))
}

/// An element of the XML that is open.
struct Open {
    name: String,
    attributes: Vec<(String, String)>,
    text: String,
}

impl Open {
    fn get(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(own, _)| own.eq_ignore_ascii_case(name)).map(|(_, value)| value.as_str())
    }
}

#[derive(Default)]
struct File {
    tables: Tables,
    curves: Curves,
    /// Scale and shift of an axis.
    axes: [[f64; 2]; 3],
    has_geometry: bool,
    /// Whether the outermost element has begun.
    root: bool,
    open: Vec<Open>,
    place: u64,
}

impl File {
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        Flaw::new(Place::Byte(self.place), fault)
    }

    fn parse(&mut self, content: &[u8]) -> Result<(), Flaw> {
        let mut reader = Reader::from_reader(content);
        loop {
            self.place = reader.buffer_position();
            match reader.read_event().map_err(|error| self.flaw(Fault::Xml(error.to_string())))? {
                Event::Start(start) => self.start(&start)?,
                Event::Empty(start) => {
                    self.start(&start)?;
                    self.end()?;
                }
                Event::Text(text) => {
                    if let Some(open) = self.open.last_mut() {
                        open.text.push_str(&text.xml10_content());
                    }
                }
                Event::CData(text) => {
                    if let Some(open) = self.open.last_mut() {
                        open.text.push_str(&text.xml10_content());
                    }
                }
                // Conditions may have them; in the geometry there is nothing to be said with them.
                Event::GeneralRef(name) if !name.is_char_ref() && resolve_xml_entity(&name).is_none() => {
                    return Err(self.flaw(Fault::Xml("a reference to nothing".into())));
                }
                Event::End(_) => self.end()?,
                Event::Decl(found) => well_formed::declaration(&found).map_err(|fault| self.flaw(fault))?,
                Event::Eof if self.open.is_empty() => return Ok(()),
                Event::Eof => return Err(self.flaw(Fault::Truncated("the XML"))),
                _ => {}
            }
        }
    }

    fn start(&mut self, start: &BytesStart) -> Result<(), Flaw> {
        if self.root && self.open.is_empty() {
            return Err(self.flaw(Fault::Xml("an element behind the end".into())));
        }
        self.root = true;
        well_formed::tag(start).map_err(|fault| self.flaw(fault))?;
        let mut attributes = Vec::new();
        for attribute in start.attributes() {
            let attribute = attribute.map_err(|error| self.flaw(Fault::Xml(error.to_string())))?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|error| self.flaw(Fault::Xml(error.to_string())))?.into_owned();
            attributes.push((attribute.key.as_ref().to_owned(), value));
        }
        let name = start.name().as_ref().to_owned();
        self.open.push(Open { name, attributes, text: String::new() });
        if self.path() == ["NEKTAR", "GEOMETRY"] {
            self.geometry()?;
        }
        Ok(())
    }

    /// Names of the open elements.
    fn path(&self) -> Vec<String> {
        self.open.iter().map(|open| open.name.to_ascii_uppercase()).collect()
    }

    fn geometry(&mut self) -> Result<(), Flaw> {
        let Some(open) = self.open.last() else { return Ok(()) };
        if let Some(file) = open.get("HDF5FILE") {
            return Err(self.flaw(NektarFault::Hdf5(file.to_owned())));
        }
        let dimension = open.get("DIM").unwrap_or("3").trim().to_owned();
        self.tables.dimension = match dimension.as_str() {
            "2" => 2,
            "3" => 3,
            _ => return Err(self.flaw(NektarFault::Dimension(dimension.chars().take(40).collect()))),
        };
        self.has_geometry = true;
        self.axes = [[1.0, 0.0]; 3];
        Ok(())
    }

    /// Takes in the element that ends.
    fn end(&mut self) -> Result<(), Flaw> {
        let path = self.path();
        let Some(open) = self.open.pop() else { return Ok(()) };
        let path: Vec<&str> = path.iter().map(String::as_str).collect();
        let ["NEKTAR", "GEOMETRY", section, rest @ ..] = &path[..] else { return Ok(()) };
        let packing = open.get("COMPRESSED").or_else(|| self.open.last().and_then(|outer| outer.get("COMPRESSED")));
        let packing = packing.map(str::to_owned);
        self.section(section, rest, &open, packing.as_deref()).map_err(|fault| self.flaw(fault))
    }

    /// Takes in an element of a section; `rest` are the names below that of the section.
    fn section(&mut self, section: &str, rest: &[&str], open: &Open, packing: Option<&str>) -> Result<(), Fault> {
        match (section, rest, packing) {
            ("VERTEX", [], _) => {
                self.axes = axes(open)?;
                if let Some(packing) = packing {
                    self.tables.vertices.extend(Unpacked::new("VERTEX", packing, &open.text, 4)?.points());
                }
            }
            ("VERTEX", ["V"], _) => {
                let id = id("VERTEX", open, "ID")?;
                let [x, y, z] = three(&numbers(&open.text, "a coordinate")?, "VERTEX", id)?;
                self.tables.vertices.push((id, DVec3::new(x, y, z)));
            }
            ("EDGE", [], Some(packing)) => {
                let rows = Unpacked::new("EDGE", packing, &open.text, 3)?.whole();
                self.tables.edges.extend(rows.chunks_exact(3).map(|row| (row[0], [row[1], row[2]])));
            }
            ("EDGE", ["E"], _) => {
                let id = id("EDGE", open, "ID")?;
                let ends: Vec<i64> = numbers(&open.text, "a vertex")?;
                let &[a, b] = &ends[..] else {
                    return Err(NektarFault::Length { section: "EDGE", id, found: ends.len(), wanted: 2 }.into());
                };
                self.tables.edges.push((id, [a, b]));
            }
            ("FACE", [letter], _) => self.tables.faces.extend(rows("FACE", letter, open, packing)?),
            ("ELEMENT", [letter], _) => self.tables.elements.extend(rows("ELEMENT", letter, open, packing)?),
            ("CURVED", ["E"], None) => self.tables.curved_edges.push(curve("edge", "EDGEID", open)?),
            ("CURVED", ["F"], None) => self.tables.curved_faces.push(curve("face", "FACEID", open)?),
            ("CURVED", _, _) => self.packed_curves(rest, open, packing)?,
            ("COMPOSITE", ["C"], _) => {
                let name = open.get("NAME").map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned);
                let id = id("COMPOSITE", open, "ID")?;
                self.tables.composites.push(Listed { id, name, members: open.text.clone() });
            }
            _ => {}
        }
        Ok(())
    }

    fn packed_curves(&mut self, rest: &[&str], open: &Open, packing: Option<&str>) -> Result<(), Fault> {
        let outer = self.open.iter().find_map(|open| open.get("COMPRESSED").map(str::to_owned));
        let Some(packing) = packing.map(str::to_owned).or(outer) else { return Ok(()) };
        let unpacked = |width| Unpacked::new("CURVED", &packing, &open.text, width);
        match rest {
            ["E"] => self.curves.edges = unpacked(Curves::WIDTH)?.whole(),
            ["F"] => self.curves.faces = unpacked(Curves::WIDTH)?.whole(),
            ["DATAPOINTS", "INDEX"] => self.curves.index = unpacked(1)?.whole(),
            ["DATAPOINTS", "POINTS"] => self.curves.points = unpacked(4)?.points(),
            _ => {}
        }
        Ok(())
    }

    /// Scales and shifts all points as the file says.
    fn scale(&mut self) {
        let (axes, tables) = (self.axes, &mut self.tables);
        if axes == [[1.0, 0.0]; 3] {
            return;
        }
        let curves = tables.curved_edges.iter_mut().chain(&mut tables.curved_faces);
        let points = tables.vertices.iter_mut().map(|(_, x)| x).chain(curves.flat_map(|own| &mut own.points));
        points.for_each(|x| (0..3).for_each(|axis| x[axis] = x[axis] * axes[axis][0] + axes[axis][1]));
    }
}

/// Scale and shift of each axis.
fn axes(open: &Open) -> Result<[[f64; 2]; 3], Fault> {
    let number = |attribute: &'static str, default: f64| match open.get(attribute) {
        None => Ok(default),
        Some(word) => {
            word.trim().parse().map_err(|_| NektarFault::Scale { attribute, found: word.chars().take(40).collect() })
        }
    };
    Ok([
        [number("XSCALE", 1.0)?, number("XMOVE", 0.0)?],
        [number("YSCALE", 1.0)?, number("YMOVE", 0.0)?],
        [number("ZSCALE", 1.0)?, number("ZMOVE", 0.0)?],
    ])
}

/// A number that an element is known by.
fn id(section: &'static str, open: &Open, attribute: &'static str) -> Result<i64, Fault> {
    let word = open.get(attribute).unwrap_or_default().trim();
    let fault = || NektarFault::Attribute { section, id: word.chars().take(40).collect(), attribute };
    Ok(word.parse().map_err(|_| fault())?)
}

fn numbers<T: std::str::FromStr>(text: &str, what: &'static str) -> Result<Vec<T>, Fault> {
    let number = |word: &str| word.parse().map_err(|_| Fault::Number { what, found: word.chars().take(40).collect() });
    text.split_ascii_whitespace().map(number).collect()
}

fn three(values: &[f64], section: &'static str, id: i64) -> Result<[f64; 3], Fault> {
    values.try_into().map_err(|_| NektarFault::Length { section, id, found: values.len(), wanted: 3 }.into())
}

/// A face or element, or many that are packed.
fn rows(section: &'static str, letter: &str, open: &Open, packing: Option<&str>) -> Result<Vec<Row>, Fault> {
    let shape = shape::lettered(letter);
    let Some(packing) = packing else {
        let id = id(section, open, "ID")?;
        let Some(shape) = shape else {
            return Err(NektarFault::Letter { section, id, letter: letter.to_owned() }.into());
        };
        let bounds: Vec<i64> = numbers(&open.text, "a number of an edge or face")?;
        let wanted = shape.sides.len();
        if bounds.len() != wanted {
            return Err(NektarFault::Length { section, id, found: bounds.len(), wanted }.into());
        }
        return Ok(vec![Row { letter: letter.to_owned(), id, bounds }]);
    };
    let Some(shape) = shape else {
        return Err(NektarFault::Letter { section, id: 0, letter: letter.to_owned() }.into());
    };
    let width = shape.sides.len() + 1;
    let values = Unpacked::new(section, packing, &open.text, width)?.whole();
    let row = |row: &[i64]| Row { letter: letter.to_owned(), id: row[0], bounds: row[1..].to_vec() };
    Ok(values.chunks_exact(width).map(row).collect())
}

/// The points of an edge or face.
fn curve(what: &'static str, attribute: &'static str, open: &Open) -> Result<Points, Fault> {
    let section = "CURVED";
    let id = id(section, open, attribute)?;
    let announced = self::id(section, open, "NUMPOINTS")?;
    let values: Vec<f64> = numbers(&open.text, "a coordinate of a curve")?;
    let (points, rest) = values.as_chunks::<3>();
    let announced = usize::try_from(announced).unwrap_or(usize::MAX);
    if !rest.is_empty() || points.len() != announced {
        return Err(NektarFault::Points { what, id, found: points.len(), announced }.into());
    }
    let kind = open.get("TYPE").unwrap_or_default().to_owned();
    Ok(Points { id, kind, points: points.iter().map(|&x| DVec3::from(x)).collect() })
}
