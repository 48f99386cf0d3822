//! What is wrong with a document: code, place, message, remedy.

use std::collections::BTreeMap;
use std::fmt;

use crate::{Origin, Position};

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The document can be used, but it deviates from the format or is suspicious.
    Warning,
    /// What the document says is lost or contradicts itself; it must not be used.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

macro_rules! codes {
    ($($(#[$doc:meta])* $variant:ident = $id:literal, $severity:ident, $remedy:literal;)*) => {
        /// Kind of a finding. Names and numbers are stable.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code { $($(#[$doc])* $variant,)* }

        impl Code {
            /// All kinds, in the order of their ids.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The stable id.
            pub fn id(self) -> &'static str {
                match self { $(Self::$variant => $id,)* }
            }

            /// How bad such a finding is.
            pub fn severity(self) -> Severity {
                match self { $(Self::$variant => Severity::$severity,)* }
            }

            /// How to mend it.
            pub fn remedy(self) -> &'static str {
                match self { $(Self::$variant => $remedy,)* }
            }
        }
    };
}

codes! {
    /// The elements are in another namespace than MeshLink's; they are read by their local names.
    ForeignNamespace = "ML101", Warning, "put xmlns=\"https://cadence.com\" on the root element";
    /// An element that the format does not have at this place; it is skipped.
    UnknownElement = "ML102", Warning, "remove it or move it to where the format has it";
    /// An attribute that the format does not have on this element; it is ignored.
    UnknownAttribute = "ML103", Warning, "remove it";
    /// A required attribute is missing.
    MissingAttribute = "ML104", Error, "add the attribute";
    /// The value of an attribute has the wrong form.
    BadAttribute = "ML105", Error, "write a whole number from 1 to 4294967295";
    /// Text where the format has only elements; it is ignored.
    StrayText = "ML106", Warning, "remove the text or make it a comment";
    /// An element stands behind one that it must precede; it is read all the same.
    OutOfOrder = "ML107", Warning, "put all ParamVertex elements before the faces or edges";
    /// A container without what it must contain.
    EmptyElement = "ML108", Warning, "remove the element or give it its contents";
    /// A document type declaration; it is ignored, and entities that it defines are refused.
    Doctype = "ML109", Warning, "remove the DOCTYPE";
    /// Point indices and references in one sheet or string; only the kind that came first is kept.
    MixedContents = "ML110", Error, "split the element in two, one for each kind";
    /// A face or edge type that cannot be read; its cells are dropped.
    UnknownType = "ML201", Error, "write Tri3 or Quad4 for faces, Edge2 for edges";
    /// A content format that cannot be read; the content is dropped.
    UnknownFormat = "ML202", Error, "write format=\"text\" or format=\"base64\"";
    /// Something that is not the index of a point or an id.
    BadIndex = "ML203", Error, "write whole numbers that count from 1";
    /// The count promises more than the content holds.
    CountTooLarge = "ML204", Error, "correct the count or complete the content";
    /// The content holds more than the count promises; the rest is ignored.
    ExtraContent = "ML205", Warning, "correct the count or shorten the content";
    /// Content that is not base64, or not of whole 32-bit integers.
    BadBase64 = "ML206", Error, "write little-endian 32-bit integers in base64 with the standard alphabet";
    /// A parameter that is not a finite number, or too few of them; the vertex is dropped.
    BadNumber = "ML207", Error, "write as many finite decimal numbers as dim says";
    /// Parameters that are neither one nor two; the vertex is dropped.
    BadDimension = "ML208", Error, "write dim=\"1\" on a curve, dim=\"2\" on a surface";
    /// Base64 where other readers know only text.
    UnusualBase64 = "ML209", Warning, "write format=\"text\" for edges and points";
    /// An id that is given twice; the first holds.
    DuplicateId = "ML301", Error, "give every element an id of its own";
    /// A reference to an id that nothing defines.
    DanglingReference = "ML302", Error, "define the id or correct the reference";
    /// A geometry group that contains a geometry group; its members are taken.
    NestedGroup = "ML303", Error, "list the members of the inner group instead";
    /// A group where a single entity is needed.
    GroupAsEntity = "ML304", Error, "refer to the one member on which the point lies";
    /// An attribute group that contains itself.
    CyclicGroup = "ML305", Error, "remove the group from among its own members";
    /// A group that lists a member twice.
    RepeatedMember = "ML306", Warning, "list it once";
    /// A face or edge that has a corner twice.
    DegenerateCell = "ML307", Warning, "remove it, or write a collapsed quad as Tri3";
    /// A point with two parameter vertices in one container; the first holds.
    RepeatedVertex = "ML308", Warning, "keep the one on the entity of its container";
    /// A parameter vertex of a point that no face or edge of its container has.
    StrayVertex = "ML309", Warning, "move it to the sheet or string that has the point";
    /// A transform that is not 16 finite numbers.
    BadTransform = "ML310", Warning, "write a 4x4 matrix, row by row";
    /// A linkage whose source or target is neither the name nor the mid of a mesh element.
    UnknownMeshElement = "ML311", Warning, "write the name or the mid of a sheet or string of this document";
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id())
    }
}

/// Something wrong at a place of the document.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Its kind.
    pub code: Code,
    /// Its place.
    pub origin: Origin,
    /// What is wrong, in one sentence without its end.
    pub message: String,
}

impl Finding {
    /// How bad it is.
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }

    /// The place, where the document was read from a file.
    pub fn position(&self) -> Option<Position> {
        self.origin.position()
    }
}

/// `12:5: error ML302: MeshSheet "wall" refers to gid 7, ...: define the id or correct the reference`
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(position) = self.position() {
            write!(f, "{position}: ")?;
        }
        write!(f, "{} {}: {}: {}", self.severity(), self.code, self.message, self.code.remedy())
    }
}

/// Findings in the order in which they were made. Of each kind the first [`Findings::KEPT`] are kept, the rest counted:
/// a million dangling references must not fill the memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    list: Vec<Finding>,
    counts: BTreeMap<Code, usize>,
}

impl Findings {
    /// How many findings of one kind are kept.
    pub const KEPT: usize = 200;

    pub(crate) fn push(&mut self, code: Code, origin: Origin, message: impl FnOnce() -> String) {
        let count = self.counts.entry(code).or_default();
        *count += 1;
        if *count <= Self::KEPT {
            self.list.push(Finding { code, origin, message: message() });
        }
    }

    /// Those that were kept.
    pub fn iter(&self) -> std::slice::Iter<'_, Finding> {
        self.list.iter()
    }

    /// How many there were of a kind, kept or not.
    pub fn count(&self, code: Code) -> usize {
        self.counts.get(&code).copied().unwrap_or(0)
    }

    /// How many there were, kept or not.
    pub fn total(&self) -> usize {
        self.counts.values().sum()
    }

    /// Whether there were none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// How many errors there were, kept or not.
    pub fn errors(&self) -> usize {
        self.counts.iter().filter(|(code, _)| code.severity() == Severity::Error).map(|(_, count)| count).sum()
    }

    /// The first error.
    pub fn first_error(&self) -> Option<&Finding> {
        self.list.iter().find(|finding| finding.severity() == Severity::Error)
    }
}

impl<'a> IntoIterator for &'a Findings {
    type Item = &'a Finding;
    type IntoIter = std::slice::Iter<'a, Finding>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
