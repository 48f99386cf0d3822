//! A walk through the elements of an XML stream: child by child, with places, never deeper than the format is.

use std::io::{self, BufRead, Read};
use std::path::{Path, PathBuf};
use std::str;

use quick_xml::events::{BytesRef, BytesStart, Event};
use quick_xml::name::{Namespace, ResolveResult};
use quick_xml::{NsReader, XmlVersion};

use crate::vocabulary::Element;
use crate::{Code, Findings, NAMESPACE, Origin, Position, ReadError};

/// Longest attribute that is read.
const ATTRIBUTE_LIMIT: usize = 64 * 1024;
/// Deepest nesting that is read; the format needs five.
const DEPTH_LIMIT: usize = 32;

/// A stream that knows where in the text it is.
pub(crate) struct Located<R> {
    inner: R,
    line: u64,
    column: u64,
}

impl<R: BufRead> Located<R> {
    fn position(&self) -> Position {
        Position::new(self.line, self.column)
    }
}

impl<R: BufRead> Read for Located<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(into)?;
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for Located<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.inner.fill_buf()
    }

    fn consume(&mut self, amount: usize) {
        // What is consumed was filled before, so this does not read.
        let taken = self.inner.fill_buf().ok().and_then(|buffer| buffer.get(..amount)).unwrap_or_default();
        match taken.iter().rposition(|&byte| byte == b'\n') {
            None => self.column += amount as u64,
            Some(last) => {
                self.line += taken.iter().map(|&byte| u64::from(byte == b'\n')).sum::<u64>();
                self.column = (amount - last) as u64;
            }
        }
        self.inner.consume(amount);
    }
}

/// The start tag at which the cursor stands.
#[derive(Default)]
pub(crate) struct Tag {
    element: Option<Element>,
    name: String,
    values: String,
    attributes: Vec<(&'static str, usize, usize)>,
    pub(crate) origin: Origin,
}

impl Tag {
    pub(crate) fn element(&self) -> Element {
        self.element.unwrap_or(Element::Unknown)
    }

    /// The local name as the file has it.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// An attribute's value, unescaped and normalised.
    pub(crate) fn get(&self, name: &str) -> Option<&str> {
        let (_, from, to) = self.attributes.iter().find(|(key, _, _)| *key == name)?;
        self.values.get(*from..*to)
    }
}

/// The walk itself. `child` and `content` are always called with the cursor inside an element, and leave it there or behind it.
pub(crate) struct Cursor<R> {
    reader: NsReader<Located<R>>,
    file: PathBuf,
    scratch: Vec<u8>,
    pub(crate) tag: Tag,
    /// What `content` found, and where it began.
    pub(crate) text: Vec<u8>,
    pub(crate) text_at: Position,
    pub(crate) findings: Findings,
    /// Start tags whose end was not seen yet.
    open: Vec<(Element, Position)>,
}

impl<R: BufRead> Cursor<R> {
    pub(crate) fn new(inner: R, file: &Path) -> Self {
        let mut reader = NsReader::from_reader(Located { inner, line: 1, column: 1 });
        reader.config_mut().expand_empty_elements = true;
        Self {
            reader,
            file: file.to_owned(),
            scratch: Vec::new(),
            tag: Tag::default(),
            text: Vec::new(),
            text_at: Position::START,
            findings: Findings::default(),
            open: Vec::new(),
        }
    }

    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// The place behind all that was read so far.
    pub(crate) fn position(&self) -> Position {
        self.reader.get_ref().position()
    }

    /// Refuses at once what cannot be XML in UTF-8, before any of it is buffered.
    pub(crate) fn sniff(&mut self) -> Result<(), ReadError> {
        let file = self.file.clone();
        let stream = self.reader.get_mut();
        let head =
            stream.fill_buf().map_err(|source| ReadError::Io { file: file.clone(), at: Position::START, source })?;
        let wide = [&[0xff, 0xfe][..], &[0xfe, 0xff], &[b'<', 0], &[0, b'<']];
        if wide.iter().any(|mark| head.starts_with(mark)) {
            return Err(ReadError::Encoding { file, at: Position::START });
        }
        let body = head.strip_prefix(b"\xef\xbb\xbf").unwrap_or(head);
        match body.iter().find(|byte| !byte.is_ascii_whitespace()) {
            Some(b'<') => Ok(()),
            None if head.is_empty() => Err(ReadError::NotXml { file, found: "it is empty".into() }),
            None => Err(ReadError::NotXml { file, found: "it begins with blanks only".into() }),
            Some(&byte) => Err(ReadError::NotXml { file, found: format!("it begins with {:?}", char::from(byte)) }),
        }
    }

    /// Goes to the next child of the current element and reports it; `None` where the element ends (or, outside all
    /// elements, the file).
    pub(crate) fn child(&mut self) -> Result<Option<Element>, ReadError> {
        loop {
            self.scratch.clear();
            let at = self.position();
            let (namespace, event) = match self.reader.read_resolved_event_into(&mut self.scratch) {
                Ok(pair) => pair,
                Err(error) => return Err(self.broken(error)),
            };
            match event {
                Event::Start(start) => {
                    note_namespace(&namespace, at, &mut self.findings);
                    fill(&mut self.tag, &start, at, &mut self.findings)
                        .map_err(|fault| fault.locate(&self.file, at))?;
                    return self.enter(at).map(Some);
                }
                Event::End(_) => {
                    self.open.pop();
                    return Ok(None);
                }
                Event::Eof if self.open.is_empty() => return Ok(None),
                Event::Eof => return Err(self.truncated()),
                Event::Text(text) if text.bytes().all(|byte| byte.is_ascii_whitespace()) => {}
                Event::Text(_) | Event::CData(_) | Event::GeneralRef(_) if self.open.is_empty() => {
                    let cause = "text outside the root element".to_owned();
                    return Err(ReadError::Xml { file: self.file.clone(), at, cause });
                }
                Event::Text(_) | Event::CData(_) | Event::GeneralRef(_) => {
                    let parent = self.open.last().map_or("the file", |(element, _)| element.name());
                    self.findings.push(Code::StrayText, at.into(), || format!("text directly inside {parent}"));
                }
                Event::DocType(_) => {
                    self.findings.push(Code::Doctype, at.into(), || "a document type declaration".into());
                }
                Event::Decl(declaration) => {
                    let utf8 = declaration.encoding().and_then(Result::ok).is_none_or(|name| is_utf8(&name));
                    if !utf8 {
                        return Err(ReadError::Encoding { file: self.file.clone(), at });
                    }
                }
                Event::Comment(_) | Event::PI(_) | Event::Empty(_) => {}
            }
        }
    }

    fn enter(&mut self, at: Position) -> Result<Element, ReadError> {
        let element = self.tag.element();
        self.open.push((element, at));
        if self.open.len() > DEPTH_LIMIT {
            return Err(ReadError::Depth { file: self.file.clone(), at, limit: DEPTH_LIMIT });
        }
        Ok(element)
    }

    /// Collects the text of the current element into `self.text` and leaves the element. Children are skipped with a finding.
    pub(crate) fn content(&mut self) -> Result<(), ReadError> {
        let mut text = std::mem::take(&mut self.text);
        text.clear();
        self.text_at = self.position();
        let result = self.collect(&mut text);
        self.text = text;
        result
    }

    /// Every event is read straight behind the text so far, so that a content of 100 MB stands in memory once.
    fn collect(&mut self, text: &mut Vec<u8>) -> Result<(), ReadError> {
        loop {
            let at = self.position();
            let mark = text.len();
            let event = match self.reader.read_event_into(text) {
                Ok(event) => event,
                Err(error) => return Err(self.broken(error)),
            };
            let piece = match event {
                Event::Text(piece) if !piece.contains('\r') => continue,
                Event::Text(piece) => piece.xml10_content().into_owned(),
                Event::CData(piece) => piece.xml10_content().into_owned(),
                Event::GeneralRef(reference) => {
                    resolve_reference(&reference).map_err(|fault| fault.locate(&self.file, at))?.to_string()
                }
                Event::End(_) => {
                    self.open.pop();
                    text.truncate(mark);
                    return Ok(());
                }
                Event::Eof => return Err(self.truncated()),
                Event::Start(start) => {
                    fill(&mut self.tag, &start, at, &mut self.findings)
                        .map_err(|fault| fault.locate(&self.file, at))?;
                    text.truncate(mark);
                    self.enter(at)?;
                    self.unknown()?;
                    continue;
                }
                Event::Comment(_) | Event::PI(_) | Event::DocType(_) | Event::Decl(_) | Event::Empty(_) => {
                    String::new()
                }
            };
            text.truncate(mark);
            text.extend_from_slice(piece.as_bytes());
        }
    }

    /// Reports the current element as one that does not belong here, and skips it.
    pub(crate) fn unknown(&mut self) -> Result<(), ReadError> {
        let parent = self.open.iter().rev().nth(1).map_or("the file", |(element, _)| element.name());
        let name = &self.tag.name;
        self.findings.push(Code::UnknownElement, self.tag.origin, || format!("{name} inside {parent}"));
        self.skip()
    }

    /// Leaves the current element without looking at what is in it.
    fn skip(&mut self) -> Result<(), ReadError> {
        let depth = self.open.len();
        while self.open.len() >= depth {
            self.scratch.clear();
            let at = self.position();
            match self.reader.read_event_into(&mut self.scratch) {
                Ok(Event::Start(_)) => {
                    self.tag.element = Some(Element::Unknown);
                    self.enter(at)?;
                }
                Ok(Event::End(_)) => {
                    self.open.pop();
                }
                Ok(Event::Eof) => return Err(self.truncated()),
                Ok(_) => {}
                Err(error) => return Err(self.broken(error)),
            }
        }
        Ok(())
    }

    /// Leaves the current element, in which nothing is allowed.
    pub(crate) fn nothing_inside(&mut self) -> Result<(), ReadError> {
        while self.child()?.is_some() {
            self.unknown()?;
        }
        Ok(())
    }

    fn truncated(&self) -> ReadError {
        let (element, opened) = self.open.last().map_or(("the file", Position::START), |(e, at)| (e.name(), *at));
        ReadError::Truncated { file: self.file.clone(), at: self.position(), element: element.into(), opened }
    }

    fn broken(&self, error: quick_xml::Error) -> ReadError {
        use quick_xml::errors::{Error, SyntaxError};
        let (file, at) = (self.file.clone(), self.position());
        match error {
            Error::Io(source) => ReadError::Io { file, at, source: io::Error::new(source.kind(), source) },
            Error::Encoding(_) => ReadError::Encoding { file, at },
            // A construct that runs to the end of the file: the file was cut there.
            Error::Syntax(SyntaxError::InvalidBangMarkup) => {
                ReadError::Xml { file, at, cause: "unknown <! markup".into() }
            }
            Error::Syntax(_) if !self.open.is_empty() => self.truncated(),
            other => ReadError::Xml { file, at, cause: other.to_string() },
        }
    }
}

/// What can be wrong inside one event, before its file and place are added.
enum Fault {
    Xml(String),
    Entity(String),
    AttributeSize { element: String, bytes: usize },
}

impl Fault {
    fn locate(self, file: &Path, at: Position) -> ReadError {
        let file = file.to_owned();
        match self {
            Self::Xml(cause) => ReadError::Xml { file, at, cause },
            Self::Entity(name) => ReadError::Entity { file, at, name },
            Self::AttributeSize { element, bytes } => {
                ReadError::AttributeSize { file, at, element, bytes, limit: ATTRIBUTE_LIMIT }
            }
        }
    }
}

fn is_utf8(encoding: &str) -> bool {
    ["utf-8", "utf8", "us-ascii", "ascii"].iter().any(|name| encoding.eq_ignore_ascii_case(name))
}

fn note_namespace(namespace: &ResolveResult<'_>, at: Position, findings: &mut Findings) {
    let found = match namespace {
        ResolveResult::Bound(Namespace(name)) if *name == NAMESPACE => return,
        ResolveResult::Bound(Namespace(name)) => format!("namespace {name:?}"),
        ResolveResult::Unbound => "no namespace".to_owned(),
        ResolveResult::Unknown(prefix) => format!("the undeclared prefix {prefix:?}"),
    };
    if findings.count(Code::ForeignNamespace) == 0 {
        findings.push(Code::ForeignNamespace, at.into(), || format!("elements are in {found}, not in {NAMESPACE:?}"));
    }
}

/// Copies a start tag out of the reader's buffer.
fn fill(tag: &mut Tag, start: &BytesStart<'_>, at: Position, findings: &mut Findings) -> Result<(), Fault> {
    let local = start.local_name();
    let name: &str = local.as_ref();
    let element = Element::from_name(name);
    tag.element = Some(element);
    tag.origin = at.into();
    tag.name.clear();
    tag.name.push_str(&name.chars().take(80).collect::<String>());
    tag.values.clear();
    tag.attributes.clear();
    for attribute in start.attributes() {
        let attribute = attribute.map_err(|error| Fault::Xml(format!("attribute of {name}: {error}")))?;
        if attribute.value.len() > ATTRIBUTE_LIMIT {
            return Err(Fault::AttributeSize { element: tag.name.clone(), bytes: attribute.value.len() });
        }
        let key: &str = attribute.key.as_ref();
        if let Some(known) = element.attributes().iter().find(|known| **known == key) {
            let from = tag.values.len();
            let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|error| escape_fault(&error))?;
            tag.values.push_str(&value);
            tag.attributes.push((known, from, tag.values.len()));
        } else if element != Element::Unknown && key != "xmlns" && !key.contains(':') {
            let key = key.chars().take(80).collect::<String>();
            findings.push(Code::UnknownAttribute, at.into(), || format!("attribute {key} of {name}"));
        }
    }
    Ok(())
}

fn escape_fault(error: &quick_xml::Error) -> Fault {
    match error {
        quick_xml::Error::Escape(quick_xml::escape::EscapeError::UnrecognizedEntity(_, name)) => {
            Fault::Entity(name.clone())
        }
        other => Fault::Xml(other.to_string()),
    }
}

fn resolve_reference(reference: &BytesRef<'_>) -> Result<char, Fault> {
    match reference.resolve_char_ref() {
        Ok(Some(character)) => return Ok(character),
        Ok(None) => {}
        Err(error) => return Err(Fault::Xml(error.to_string())),
    }
    match &**reference {
        "lt" => Ok('<'),
        "gt" => Ok('>'),
        "amp" => Ok('&'),
        "apos" => Ok('\''),
        "quot" => Ok('"'),
        name => Err(Fault::Entity(name.chars().take(80).collect())),
    }
}
