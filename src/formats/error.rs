//! What can be wrong with a mesh file: one error that names file, place, thing and remedy.

use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::element::Order;
use crate::mesh::{Inconsistent, TooMany};

/// A mesh file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The operating system refused.
    #[error("{}: cannot {action}: {source}", file.display())]
    Io {
        /// The file in question.
        file: PathBuf,
        /// What was tried, as a verb.
        action: &'static str,
        /// The system's answer.
        source: io::Error,
    },
    /// The file is not what it should be.
    #[error("{}, {place}: {fault}", file.display())]
    Content {
        /// The file in question.
        file: PathBuf,
        /// Where in the file.
        place: Place,
        /// What is wrong there.
        fault: Box<Fault>,
    },
    /// The file is in no format that can be read, or its name asks for none that can be written.
    #[error("{}: {reason}", file.display())]
    Format {
        /// The file in question.
        file: PathBuf,
        /// What it seems to be, and what to do.
        reason: String,
    },
    /// The mesh holds something that the format cannot express.
    #[error("{}: cannot be written: {reason}", file.display())]
    Inexpressible {
        /// The file in question.
        file: PathBuf,
        /// What cannot be expressed, and what to do.
        reason: String,
    },
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// A line of text, counted from 1.
    Line(u64),
    /// An offset in binary data, counted from 0.
    Byte(u64),
    /// A node of a CGNS file, by its path.
    Node(String),
    /// An element, by its number.
    Element(u64),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Place::Line(line) => write!(f, "line {line}"),
            Place::Byte(offset) => write!(f, "byte {offset}"),
            Place::Node(path) => write!(f, "node {path}"),
            Place::Element(tag) => write!(f, "element {tag}"),
        }
    }
}

/// A fault and its place, on the way to the caller who knows the file's name.
#[derive(Debug)]
pub struct Flaw {
    /// Where.
    pub place: Place,
    /// What.
    pub fault: Box<Fault>,
}

impl Flaw {
    /// A fault at a place.
    #[must_use]
    pub fn new(place: Place, fault: impl Into<Fault>) -> Flaw {
        Flaw { place, fault: Box::new(fault.into()) }
    }

    /// The error, now that the file's name is known.
    #[must_use]
    pub fn of(self, file: impl Into<PathBuf>) -> Error {
        Error::Content { file: file.into(), place: self.place, fault: self.fault }
    }
}

/// What is wrong with a mesh file's content.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the message of each says what it is
pub enum Fault {
    #[error("reading failed: {0}")]
    Io(#[from] io::Error),
    #[error("the file ends inside {0}: it was cut off; copy or write it again")]
    Truncated(&'static str),
    #[error("expected {what}, found {found:?}")]
    Unexpected { what: &'static str, found: String },
    #[error("reading {what}: {found:?} is not a valid number here")]
    Number { what: &'static str, found: String },
    #[error("{count} {what} do not fit into the {rest} bytes that follow: the file is cut off or damaged")]
    Count { what: &'static str, count: u64, rest: u64 },
    #[error("the file announces {announced} {what}, but has {found}: it is damaged")]
    Miscounted { what: &'static str, announced: u64, found: u64 },
    #[error("{0} does not take one line: a number is missing or too many")]
    Row(&'static str),
    #[error("{0} bytes follow that belong to nothing: a count is wrong, or the file is damaged")]
    Leftover(u64),
    #[error("the number stands twice among the elements of one dimension; renumber the elements")]
    RepeatedElement,
    #[error("has the same corners as element {0}: the element is there twice; remove one of them")]
    Doubled(u64),
    #[error("{0} is not UTF-8 text: the file is damaged, or in another encoding")]
    NotUtf8(&'static str),
    #[error("node {0}: a coordinate or parameter is not a finite number; correct it in the mesh generator")]
    NotFinite(u64),
    #[error("element {by} refers to node {node}, but the nodes are numbered {first} to {last}")]
    NodeRange { by: u64, node: i64, first: i64, last: i64 },
    #[error("elements of {here} in a mesh of {order}; set one order for the whole mesh (Gmsh: Mesh > Set order)")]
    MixedOrders { order: Order, here: Order },
    #[error("{0}: the limit of this program")]
    TooMany(#[from] TooMany),
    #[error("the XML is damaged: {0}")]
    Xml(String),
    #[error("{0}: the file is damaged")]
    Inconsistent(#[from] Inconsistent),
    /// A fault that only files of one format can have.
    #[error("{0}")]
    Own(Box<dyn std::error::Error + Send + Sync>),
}

/// Makes the faults of a format faults of mesh files.
macro_rules! own {
    ($fault:ty) => {
        impl From<$fault> for $crate::formats::error::Fault {
            fn from(fault: $fault) -> $crate::formats::error::Fault {
                $crate::formats::error::Fault::Own(Box::new(fault))
            }
        }
    };
}
pub(super) use own;
