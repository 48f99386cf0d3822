//! Reading: the stream once through, into a [`Document`] and the findings made on the way.

mod content;
mod mesh;

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::str;

use crate::cursor::Cursor;
use crate::id::Id;
use crate::vocabulary::Element;
use crate::{Attribute, AttributeGroup, Code, Document, ElementLinkage, Findings, Position};
use crate::{GeometryFile, GeometryGroup, GeometryReference, ReadError, Refused, Transform};

/// What reading a file gave.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The file's name, for messages.
    pub file: PathBuf,
    /// What could be read.
    pub document: Document,
    /// What is wrong with it. Where there are errors, parts of the document are missing.
    pub findings: Findings,
}

impl Reading {
    /// The document, if nothing of it was lost; warnings do not count.
    pub fn accept(self) -> Result<Document, Refused> {
        Refused::check(&self.file, &self.findings)?;
        Ok(self.document)
    }
}

/// Reads a file.
pub fn read_path(path: &Path) -> Result<Reading, ReadError> {
    // A pipe would be waited for, and a device has no end.
    let regular = std::fs::metadata(path).and_then(|metadata| match metadata.is_file() {
        true => File::open(path),
        false => Err(std::io::Error::other("it is not a regular file")),
    });
    let file = regular.map_err(|source| ReadError::Open { file: path.to_owned(), source })?;
    read(BufReader::with_capacity(256 * 1024, file), path)
}

/// Reads a stream; `file` is its name in messages.
pub fn read(stream: impl BufRead, file: &Path) -> Result<Reading, ReadError> {
    let mut cursor = Cursor::new(stream, file);
    cursor.sniff()?;
    let document = match cursor.child()? {
        Some(Element::MeshLink) => cursor.document()?,
        other => {
            let (root, at) = match other {
                Some(_) => (cursor.tag.name().to_owned(), cursor.tag.origin.position()),
                None => ("missing".to_owned(), Some(cursor.position())),
            };
            return Err(ReadError::NotMeshLink { file: file.to_owned(), at: at.unwrap_or(Position::START), root });
        }
    };
    if cursor.child()?.is_some() {
        let at = cursor.tag.origin.position().unwrap_or(Position::START);
        return Err(ReadError::Xml { file: file.to_owned(), at, cause: "a second root element".into() });
    }
    Ok(Reading { file: cursor.file().to_owned(), document, findings: cursor.findings })
}

/// The elements right under the root.
impl<R: BufRead> Cursor<R> {
    fn document(&mut self) -> Result<Document, ReadError> {
        let mut document =
            Document { version: self.required("version"), origin: self.tag.origin, ..Document::default() };
        while let Some(element) = self.child()? {
            match element {
                Element::Attribute => document.attributes.extend(self.attribute()?),
                Element::AttributeGroup => document.attribute_groups.extend(self.attribute_group()?),
                Element::GeometryFile => document.geometry_files.push(self.geometry_file()?),
                Element::GeometryGroup => document.geometry_groups.extend(self.geometry_group()?),
                Element::MeshFile => document.mesh_files.push(self.mesh_file()?),
                Element::Transform => document.transforms.extend(self.transform()?),
                Element::MeshElementLinkage => document.linkages.extend(self.linkage()?),
                _ => self.unknown()?,
            }
        }
        Ok(document)
    }

    fn attribute(&mut self) -> Result<Option<Attribute>, ReadError> {
        let (id, name, origin) = (self.required_id("attid"), self.text_of("name"), self.tag.origin);
        self.content()?;
        Ok(id.map(|id| Attribute { id, name, value: self.string(), origin }))
    }

    fn attribute_group(&mut self) -> Result<Option<AttributeGroup>, ReadError> {
        let (id, name, origin) = (self.required_id("attid"), self.text_of("name"), self.tag.origin);
        let members = self.id_list("AttributeGroup")?;
        Ok(id.map(|id| AttributeGroup { id, name, members, origin }))
    }

    fn geometry_file(&mut self) -> Result<GeometryFile, ReadError> {
        let mut file = GeometryFile {
            filename: self.required("filename"),
            aref: self.optional_id("aref"),
            references: Vec::new(),
            origin: self.tag.origin,
        };
        while let Some(element) = self.child()? {
            match element {
                Element::GeometryReference => file.references.extend(self.geometry_reference()?),
                _ => self.unknown()?,
            }
        }
        Ok(file)
    }

    fn geometry_reference(&mut self) -> Result<Option<GeometryReference>, ReadError> {
        let (id, origin) = (self.required_id("gid"), self.tag.origin);
        let (reference, name, aref) = (self.required("ref"), self.text_of("name"), self.optional_id("aref"));
        self.nothing_inside()?;
        Ok(id.map(|id| GeometryReference { id, reference, name, aref, origin }))
    }

    fn geometry_group(&mut self) -> Result<Option<GeometryGroup>, ReadError> {
        let (id, origin) = (self.required_id("gid"), self.tag.origin);
        let (name, aref) = (self.text_of("name"), self.optional_id("aref"));
        let members = self.id_list("GeometryGroup")?;
        Ok(id.map(|id| GeometryGroup { id, name, aref, members, origin }))
    }

    fn transform(&mut self) -> Result<Option<Transform>, ReadError> {
        let (id, origin) = (self.required_id("xid"), self.tag.origin);
        let (name, aref) = (self.text_of("name"), self.optional_id("aref"));
        self.content()?;
        Ok(id.map(|id| Transform { id, name, aref, content: self.string(), origin }))
    }

    /// `None` where it does not say what it links.
    fn linkage(&mut self) -> Result<Option<ElementLinkage>, ReadError> {
        let [source, target] = ["sourceEntityRef", "targetEntityRef"].map(|name| self.required(name));
        let is_whole = ["sourceEntityRef", "targetEntityRef"].iter().all(|name| self.tag.get(name).is_some());
        let linkage = ElementLinkage {
            source,
            target,
            transform: self.optional_id("xref"),
            aref: self.optional_id("aref"),
            name: self.text_of("name"),
            origin: self.tag.origin,
        };
        self.nothing_inside()?;
        Ok(Some(linkage).filter(|_| is_whole))
    }
}

/// Attributes of the tag at which the cursor stands.
impl<R: BufRead> Cursor<R> {
    fn missing(&mut self, name: &str) {
        let element = self.tag.element().name();
        self.findings.push(Code::MissingAttribute, self.tag.origin, || format!("{element} has no {name}"));
    }

    fn text_of(&self, name: &str) -> Option<String> {
        self.tag.get(name).map(str::to_owned)
    }

    fn required(&mut self, name: &str) -> String {
        self.text_of(name).unwrap_or_else(|| {
            self.missing(name);
            String::new()
        })
    }

    fn optional_id<I: Id>(&mut self, name: &str) -> Option<I> {
        let text = self.tag.get(name)?;
        let id = positive(text).and_then(|number| u32::try_from(number).ok()).and_then(NonZeroU32::new);
        if id.is_none() {
            let element = self.tag.element().name();
            self.findings
                .push(Code::BadAttribute, self.tag.origin, || format!("{name} of {element} is {:?}", shorten(text)));
        }
        id.map(I::from_number)
    }

    fn required_id<I: Id>(&mut self, name: &str) -> Option<I> {
        if self.tag.get(name).is_none() {
            self.missing(name);
        }
        self.optional_id(name)
    }
}

/// A positive whole number as XML Schema has it: blanks around it, a plus sign, leading zeros. Saturates.
fn positive(text: &str) -> Option<u64> {
    let text = text.trim_matches([' ', '\t', '\n', '\r']);
    let digits = text.strip_prefix('+').unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let number = digits.bytes().fold(0_u64, |n, byte| n.saturating_mul(10).saturating_add(u64::from(byte - b'0')));
    (number > 0).then_some(number)
}

/// The beginning of a text, for messages.
fn shorten(text: &str) -> String {
    let mut short: String = text.chars().take(40).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}
