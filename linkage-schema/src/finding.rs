//! What is wrong with a document: code, place, message, remedy.
//!
//! This crate finds `ML1..` (structure), `ML2..` (contents) and `ML3..` (references). The codes of what only a mesh (`ML4..`) or a CAD
//! file (`ML5..`) can tell stand in the same table, so that every code has one meaning; the program that has both finds them.

use std::collections::BTreeMap;
use std::fmt;

use crate::{Origin, Position};

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Nothing is wrong; something was not, or could not be, looked at.
    Note,
    /// The document can be used, but it deviates from the format or is suspicious.
    Warning,
    /// What the document says is lost or contradicts itself; it must not be used.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        })
    }
}

macro_rules! codes {
    ($($(#[doc = $doc:literal])* $variant:ident = $id:literal, $severity:ident, $remedy:literal;)*) => {
        /// Kind of a finding. Names and numbers are stable.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code { $($(#[doc = $doc])* $variant,)* }

        impl Code {
            /// All kinds, in the order of their ids.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The stable id.
            pub fn id(self) -> &'static str {
                match self { $(Self::$variant => $id,)* }
            }

            /// The kind with this id, in letters of either case.
            pub fn from_id(id: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|code| code.id().eq_ignore_ascii_case(id))
            }

            /// What it means, in one or two sentences.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => concat!($($doc),*).trim_ascii_start(),)* }
            }

            /// How bad such a finding is.
            pub fn severity(self) -> Severity {
                match self { $(Self::$variant => Severity::$severity,)* }
            }

            /// How to fix it.
            pub fn remedy(self) -> &'static str {
                match self { $(Self::$variant => $remedy,)* }
            }
        }
    };
}

codes! {
    /// The file is not XML, is broken or cut off, or is not a MeshLink document; nothing else was checked.
    Unreadable = "ML001", Error, "then validate again, as nothing else was checked";
    /// The elements are in another namespace than MeshLink's; they are read by their local names.
    ForeignNamespace = "ML101", Warning, "put xmlns=\"https://cadence.com\" on the root element";
    /// An element that the format does not have at this place; it is skipped.
    UnknownElement = "ML102", Warning, "remove it, or move it to where the format allows it";
    /// An attribute that the format does not have on this element; it is ignored.
    UnknownAttribute = "ML103", Warning, "remove it";
    /// A required attribute is missing.
    MissingAttribute = "ML104", Error, "add the attribute";
    /// The value of an attribute has the wrong form.
    BadAttribute = "ML105", Error, "write a whole number from 1 to 4294967295";
    /// Text where the format has only elements; it is ignored.
    StrayText = "ML106", Warning, "remove the text or make it a comment";
    /// An element follows one that it must precede; it is read nevertheless.
    OutOfOrder = "ML107", Warning, "put all ParamVertex elements before the faces or edges";
    /// A container without its required content.
    EmptyElement = "ML108", Warning, "remove the element or give it its contents";
    /// A document type declaration; it is ignored, and entities that it defines are refused.
    Doctype = "ML109", Warning, "remove the DOCTYPE";
    /// Point indices and references in one sheet or string; only the kind that came first is kept.
    MixedContents = "ML110", Error, "split the element in two, one for each kind";
    /// A face or edge type that cannot be read; its cells are dropped.
    UnknownType = "ML201", Error, "write Tri3 or Quad4 for faces, Edge2 for edges";
    /// A content format that cannot be read; the content is dropped.
    UnknownFormat = "ML202", Error, "write format=\"text\" or format=\"base64\"";
    /// A word that is neither the index of a point nor an id.
    BadIndex = "ML203", Error, "write whole numbers that count from 1";
    /// The content is shorter than the count says.
    CountTooLarge = "ML204", Error, "correct the count or complete the content";
    /// The content is longer than the count says; the rest is ignored.
    ExtraContent = "ML205", Warning, "correct the count or shorten the content";
    /// Content that is not base64, or not of whole 32-bit integers.
    BadBase64 = "ML206", Error, "write little-endian 32-bit integers in base64 with the standard alphabet";
    /// A parameter that is not a finite number, or too few of them; the vertex is dropped.
    BadNumber = "ML207", Error, "write as many finite decimal numbers as dim says";
    /// A vertex with neither one nor two parameters; it is dropped.
    BadDimension = "ML208", Error, "write dim=\"1\" on a curve, dim=\"2\" on a surface";
    /// Base64 where other readers understand text only.
    UnusualBase64 = "ML209", Warning, "write format=\"text\" for edges and points";
    /// An id that is defined twice; the first counts.
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
    /// A point with two parameter vertices in one container; the first counts.
    RepeatedVertex = "ML308", Warning, "keep the one on the entity of its container";
    /// A parameter vertex of a point that no face or edge of its container has.
    StrayVertex = "ML309", Warning, "move it to the sheet or string that has the point";
    /// A transform that is not 16 finite numbers.
    BadTransform = "ML310", Warning, "write a 4x4 matrix, row by row";
    /// A linkage whose source or target is neither the name nor the mid of a mesh element.
    UnknownMeshElement = "ML311", Warning, "write the name or the mid of a sheet or string of this document";
    /// A linkage whose source and target are of different kinds.
    UnequalPair = "ML312", Warning, "link a sheet with a sheet, a string with a string";
    /// A point index that is beyond the mesh's nodes.
    IndexBeyondMesh = "ML401", Error, "correct the index, or give the mesh that the linkage was written for";
    /// All indices are off by one: the file counts points from 0, or from 2, where the format counts from 1.
    IndexBase = "ML402", Error, "count points from 1";
    /// Most of what is linked is not in the mesh: it is of another case, or was renumbered.
    OtherMesh = "ML403", Error, "give the mesh that the linkage was written for";
    /// A linked face that the mesh does not have.
    NotInMesh = "ML404", Error, "correct the indices, or remove the face";
    /// A linked face that is not on the mesh's boundary: it lies inside the volume.
    InteriorFace = "ML405", Warning, "remove it, unless something is meant to lie inside the volume";
    /// A face that is linked twice.
    RepeatedFace = "ML406", Error, "link every face once";
    /// The edges of a string do not form one path or loop.
    BrokenString = "ML407", Error, "close the gap, remove the branch, or split the string in two";
    /// An edge of a string that no face of the mesh has.
    EdgeNotInMesh = "ML408", Error, "correct the indices, or remove the edge";
    /// A string that bounds no sheet: no linked face has its edges.
    StringWithoutSheet = "ML409", Warning, "remove the string, or link the faces beside it";
    /// A boundary patch some of whose faces are linked and some are not.
    PartlyCovered = "ML410", Warning, "link the patch's other faces too; otherwise they stay straight or planar";
    /// A reference by a name that the mesh file does not have, or that is not looked up in meshes of this format.
    UnknownMeshName = "ML411", Note, "write point indices in place of names, so that it can be checked";
    /// The mesh that was given is not the file that the linkage names.
    OtherMeshFile = "ML412", Note, "make sure that the linkage was written for this mesh";
    /// Two sides of a periodic pair whose points do not correspond under the transform.
    NotPeriodic = "ML413", Error, "correct the transform, or the elements that it pairs";
    /// A linked point that is on no boundary face.
    StrayPoint = "ML414", Warning, "correct the index";
    /// A mesh model with the name of no zone of the mesh file; what it links is not checked.
    UnknownZone = "ML415", Error, "give the model the name of the zone whose points it counts: /Base/zone, or the zone's name";
    /// A reference to nothing in the CAD file, or to several entities of it.
    UnknownReference = "ML501", Error, "write face-N, edge-N, vertex-N, step:#N, iges:DN or name:NAME as the CAD file has it";
    /// A reference to an entity of the wrong kind: sheets lie on faces, strings on edges or faces.
    WrongKind = "ML502", Error, "refer to a face from sheets, to an edge from strings";
    /// Points that are farther from the CAD entities they are linked to than the tolerance.
    OffGeometry = "ML503", Error, "link them to the entity on which they lie, or raise --tolerance if the mesh is this far off";
    /// Faces that do not run along the surface they are linked to, or lie on its other side.
    WrongSide = "ML504", Error, "link them to the surface of their own side";
    /// A parameter vertex that, where most of its kind evaluate to their points, evaluates elsewhere.
    WrongParameters = "ML505", Warning, "write the parameters again, or leave them out: they are hints only";
    /// Parameter vertices whose parameters are not this CAD kernel's; they are not compared.
    ForeignParameters = "ML506", Note, "nothing needs to be done: parameters are hints, points are projected again";
    /// Faces of one sheet that cross a sharp edge of the CAD, which curving would round off or fold.
    SharpEdgeCrossed = "ML507", Warning, "mesh up to the edge, and link the mesh edges on it by a string";
    /// Mesh edges inside one sheet that lie on a sharp edge of the CAD, with no string that holds them there.
    SharpEdgeFree = "ML508", Warning, "link the mesh edges on it by a string";
    /// Geometry in a format that OpenCASCADE cannot read, or in another file than the given one; what is linked to it is not compared with CAD.
    UnreadableGeometry = "ML509", Note, "give the same geometry in one file of STEP, IGES or BREP, with references that it has";
    /// The CAD file that was given is not the one that the linkage names.
    OtherCadFile = "ML510", Warning, "make sure that the references mean the same entities in this file";
    /// CAD and mesh differ in size by a ratio of units, or lie apart.
    OtherScale = "ML511", Error, "bring both to the same unit and position";
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
    /// The word of the element's content that it is about, from 0, where it stands at the element.
    pub(crate) word: Option<usize>,
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
    pub(crate) list: Vec<Finding>,
    counts: BTreeMap<Code, usize>,
}

impl Findings {
    /// How many findings of one kind are kept.
    pub const KEPT: usize = 200;

    /// Adds a finding; the message is made only if it is kept.
    pub fn push(&mut self, code: Code, origin: Origin, message: impl FnOnce() -> String) {
        self.add(code, origin, None, message);
    }

    /// Adds a finding about one word of the content of the element at `origin`, from 0: [`Findings::place_words`] finds its place.
    pub fn push_word(&mut self, code: Code, origin: Origin, word: Option<usize>, message: impl FnOnce() -> String) {
        self.add(code, origin, word, message);
    }

    fn add(&mut self, code: Code, origin: Origin, word: Option<usize>, message: impl FnOnce() -> String) {
        let count = self.counts.entry(code).or_default();
        *count += 1;
        if *count <= Self::KEPT {
            self.list.push(Finding { code, origin, word, message: message() });
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
        self.of(Severity::Error)
    }

    /// How many there were of a severity, kept or not.
    pub fn of(&self, severity: Severity) -> usize {
        self.counts.iter().filter(|(code, _)| code.severity() == severity).map(|(_, count)| count).sum()
    }

    /// Appends those of another list.
    pub fn append(&mut self, other: &Self) {
        for (&code, &count) in &other.counts {
            let own = self.counts.entry(code).or_default();
            let room = Self::KEPT.saturating_sub(*own);
            *own += count;
            self.list.extend(other.list.iter().filter(|finding| finding.code == code).take(room).cloned());
        }
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
