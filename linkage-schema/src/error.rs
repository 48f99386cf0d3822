//! Why a document could not be read, used or written at all.

use std::io;
use std::path::{Path, PathBuf};

use crate::{Finding, Findings, Position};

/// What stops reading. Everything that lets reading go on is a [`Finding`] instead.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file cannot be opened.
    #[error("{file}: cannot open the linkage file: {source}", file = file.display())]
    Open {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The stream broke.
    #[error("{file}:{at}: cannot read on: {source}", file = file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// How far it was read.
        at: Position,
        /// Why.
        source: io::Error,
    },
    /// The first byte that is not blank is not `<`.
    #[error("{file}:1:1: not an XML file ({found}): give a MeshLink file, which begins with <", file = file.display())]
    NotXml {
        /// The file.
        file: PathBuf,
        /// What it is instead, as far as the first bytes tell.
        found: String,
    },
    /// Text in another encoding than UTF-8.
    #[error("{file}:{at}: not UTF-8 text: convert the file, e.g. with iconv -t UTF-8", file = file.display())]
    Encoding {
        /// The file.
        file: PathBuf,
        /// The place.
        at: Position,
    },
    /// Not well-formed XML.
    #[error("{file}:{at}: the XML is broken: {cause}: write the file again or correct this position", file = file.display())]
    Xml {
        /// The file.
        file: PathBuf,
        /// The place.
        at: Position,
        /// What is wrong.
        cause: String,
    },
    /// The file ends inside an element.
    #[error("{file}:{at}: the file ends inside {element}, which began at {opened}: it is truncated; copy or write it again", file = file.display())]
    Truncated {
        /// The file.
        file: PathBuf,
        /// Its end.
        at: Position,
        /// The innermost open element.
        element: String,
        /// Where that began.
        opened: Position,
    },
    /// Well-formed, but the root element is another.
    #[error("{file}:{at}: the root element is {root}, not MeshLink: give a MeshLink file", file = file.display())]
    NotMeshLink {
        /// The file.
        file: PathBuf,
        /// The root element, or the end of the file.
        at: Position,
        /// What stands there.
        root: String,
    },
    /// An entity other than the five of XML. None is ever expanded, so none can explode.
    #[error("{file}:{at}: entity &{name}; is not one of XML's own: write its text instead", file = file.display())]
    Entity {
        /// The file.
        file: PathBuf,
        /// The place.
        at: Position,
        /// The entity.
        name: String,
    },
    /// An attribute of an absurd size.
    #[error("{file}:{at}: an attribute of {element} has {bytes} bytes, more than {limit}: shorten it", file = file.display())]
    AttributeSize {
        /// The file.
        file: PathBuf,
        /// The element.
        at: Position,
        /// Its name.
        element: String,
        /// Size of the attribute.
        bytes: usize,
        /// The limit.
        limit: usize,
    },
    /// Elements within elements without end.
    #[error("{file}:{at}: elements are nested deeper than {limit}: this is no MeshLink file", file = file.display())]
    Depth {
        /// The file.
        file: PathBuf,
        /// The place.
        at: Position,
        /// The limit.
        limit: usize,
    },
}

impl ReadError {
    /// The place that the message names; none where the file could not be opened.
    pub fn position(&self) -> Option<Position> {
        match self {
            Self::Open { .. } => None,
            Self::NotXml { .. } => Some(Position::START),
            Self::Io { at, .. }
            | Self::Encoding { at, .. }
            | Self::Xml { at, .. }
            | Self::Entity { at, .. }
            | Self::Truncated { at, .. }
            | Self::NotMeshLink { at, .. }
            | Self::AttributeSize { at, .. }
            | Self::Depth { at, .. } => Some(*at),
        }
    }
}

/// A document that has errors and is to be used all the same.
#[derive(Debug, thiserror::Error)]
#[error("{}:{first}{}", file.display(), more(*others))]
pub struct Refused {
    /// The file.
    pub file: PathBuf,
    /// The first error.
    pub first: Box<Finding>,
    /// How many more errors there are.
    pub others: usize,
}

fn more(others: usize) -> String {
    match others {
        0 => String::new(),
        n => format!(" (and {n} more: `sagitta validate` lists them)"),
    }
}

impl Refused {
    /// An error if there is one among the findings.
    pub(crate) fn check(file: &Path, findings: &Findings) -> Result<(), Self> {
        match findings.first_error() {
            None => Ok(()),
            Some(first) => Err(Self {
                file: file.to_owned(),
                first: Box::new(first.clone()),
                others: findings.errors().saturating_sub(1),
            }),
        }
    }
}

/// Why a document cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The stream broke.
    #[error("cannot write the linkage file: {0}")]
    Io(#[from] io::Error),
    /// The file cannot be made.
    #[error("{file}: cannot write the linkage file: {source}", file = file.display())]
    Create {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The document holds something that the format cannot say.
    #[error("{what} cannot be written as MeshLink: {why}")]
    Unwritable {
        /// The element.
        what: String,
        /// Why not.
        why: String,
    },
}
