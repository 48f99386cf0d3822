//! The mesh side of a document: files, models, sheets of faces, strings of edges, points, parameter vertices.

use crate::{AttributeId, GeometryId, MeshId, Origin};

/// A mesh file and its models.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile {
    /// The path as written: possibly absolute, possibly of another machine, possibly without its extension.
    pub filename: String,
    /// Attributes of the file; `mesh format` tells how to read it.
    pub aref: Option<AttributeId>,
    /// Its models.
    pub models: Vec<MeshModel>,
    /// Its place.
    pub origin: Origin,
}

/// One block, zone or volume of a mesh file: the space in which point indices count.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshModel {
    /// What the mesh file calls it.
    pub reference: String,
    /// Id, name, attributes and geometry. Sheets and strings do *not* inherit this `gref`.
    pub common: Common,
    /// Sets of faces.
    pub sheets: Vec<Sheet>,
    /// Sets of edges.
    pub strings: Vec<MeshString>,
    /// Single points.
    pub points: Vec<PointRun>,
    /// Parameters of points that hold wherever no sheet or string gives its own.
    pub parameters: Vec<ParamVertex>,
    /// Its place.
    pub origin: Origin,
}

/// What every mesh element may carry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Common {
    /// Its id.
    pub mid: Option<MeshId>,
    /// Its name.
    pub name: Option<Box<str>>,
    /// Its attributes.
    pub aref: Option<AttributeId>,
    /// The CAD entity, or the group of them, on which it lies.
    pub gref: Option<GeometryId>,
}

/// A set of wall faces (`MeshSheet`, `MeshSheetReference`).
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Id, name, attributes, and the geometry of all faces that name none.
    pub common: Common,
    /// The faces.
    pub body: SheetBody,
    /// Surface parameters of points.
    pub parameters: Vec<ParamVertex>,
    /// Its place.
    pub origin: Origin,
}

/// How a sheet tells its faces.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetBody {
    /// By point indices.
    Faces(Vec<FaceRun>),
    /// By names that the mesh file gives to faces.
    FaceReferences(Vec<EntityRun>),
    /// By the name that the mesh file gives to the whole set (`MeshSheetReference`).
    Reference(String),
}

/// A chain of wall edges (`MeshString`, `MeshStringReference`).
#[derive(Clone, Debug, PartialEq)]
pub struct MeshString {
    /// Id, name, attributes, and the geometry of all edges that name none.
    pub common: Common,
    /// The edges.
    pub body: StringBody,
    /// Curve parameters of points.
    pub parameters: Vec<ParamVertex>,
    /// Its place.
    pub origin: Origin,
}

/// How a string tells its edges.
#[derive(Clone, Debug, PartialEq)]
pub enum StringBody {
    /// By point indices.
    Edges(Vec<EdgeRun>),
    /// By names that the mesh file gives to edges.
    EdgeReferences(Vec<EntityRun>),
    /// By the name that the mesh file gives to the whole chain (`MeshStringReference`).
    Reference(String),
}

/// Shape of the faces of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FaceShape {
    /// `Tri3`
    Triangle,
    /// `Quad4`
    Quad,
}

impl FaceShape {
    /// Points of one face.
    pub fn corners(self) -> usize {
        match self {
            Self::Triangle => 3,
            Self::Quad => 4,
        }
    }

    /// The word in the file's `etype`.
    pub fn etype(self) -> &'static str {
        match self {
            Self::Triangle => "Tri3",
            Self::Quad => "Quad4",
        }
    }

    /// The shape that this `etype` names.
    pub fn from_etype(word: &str) -> Option<Self> {
        [Self::Triangle, Self::Quad].into_iter().find(|shape| shape.etype() == word)
    }
}

/// How indices are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// Decimal numbers between blanks.
    #[default]
    Text,
    /// Little-endian 32-bit integers in base64.
    Base64,
}

impl Encoding {
    /// The word of a content that is its index of this number, both from 0; base64 has no words.
    pub fn word(self, index: usize) -> Option<usize> {
        (self == Self::Text).then_some(index)
    }
}

/// Faces of one shape on one piece of geometry (`MeshFace`).
#[derive(Clone, Debug, PartialEq)]
pub struct FaceRun {
    /// Id, name, attributes, geometry.
    pub common: Common,
    /// Shape of all its faces.
    pub shape: FaceShape,
    /// How the indices are written.
    pub encoding: Encoding,
    /// Corner indices of all faces, as in the file: counted from 1. A 0 in them is an error that reading finds.
    pub indices: Box<[u32]>,
    /// Its place.
    pub origin: Origin,
}

impl FaceRun {
    /// Face by face, 3 or 4 indices each.
    pub fn faces(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        self.indices.chunks_exact(self.shape.corners())
    }
}

/// Edges on one piece of geometry (`MeshEdge`).
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeRun {
    /// Id, name, attributes, geometry.
    pub common: Common,
    /// How the indices are written.
    pub encoding: Encoding,
    /// Two indices an edge, as in the file: counted from 1.
    pub indices: Box<[u32]>,
    /// Its place.
    pub origin: Origin,
}

impl EdgeRun {
    /// The only edge type.
    pub const ETYPE: &str = "Edge2";

    /// Edge by edge.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = [u32; 2]> {
        self.indices.as_chunks::<2>().0.iter().copied()
    }
}

/// Faces or edges by names of the mesh file (`MeshFaceReference`, `MeshEdgeReference`).
#[derive(Clone, Debug, PartialEq)]
pub struct EntityRun {
    /// Id, name, attributes, geometry.
    pub common: Common,
    /// Type of the entities, in the words of the writing program.
    pub etype: String,
    /// The names. Base64 contents are read as integers and kept in decimal.
    pub references: Vec<String>,
    /// Its place.
    pub origin: Origin,
}

/// Points on one piece of geometry (`MeshPointReference`).
#[derive(Clone, Debug, PartialEq)]
pub struct PointRun {
    /// Id, name, attributes, geometry.
    pub common: Common,
    /// How the indices are written.
    pub encoding: Encoding,
    /// The points, as in the file: counted from 1.
    pub indices: Box<[u32]>,
    /// Its place.
    pub origin: Origin,
}

/// Parameters of a point on a single CAD entity. They are hints: every CAD kernel parametrises in its own way.
#[derive(Clone, Debug, PartialEq)]
pub struct ParamVertex {
    /// Its id.
    pub mid: Option<MeshId>,
    /// The point.
    pub vertex: VertexRef,
    /// The entity; never a group.
    pub gref: GeometryId,
    /// The parameters.
    pub parameters: Parameters,
    /// Its place.
    pub origin: Origin,
}

/// The point that a parameter vertex speaks of.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum VertexRef {
    /// The index of a mesh point, counted from 1.
    Index(u32),
    /// Anything that is not the plain decimal form of an index. Make it by [`VertexRef::from`], which tells the two apart.
    Name(Box<str>),
}

impl From<&str> for VertexRef {
    fn from(text: &str) -> Self {
        let plain = text.bytes().all(|byte| byte.is_ascii_digit()) && !text.starts_with('0');
        match text.parse() {
            Ok(index) if plain => Self::Index(index),
            _ => Self::Name(text.into()),
        }
    }
}

/// Parameters on a curve or on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Parameters {
    /// One number, `dim="1"`.
    Curve(f64),
    /// Two numbers, `dim="2"`. Some writers use this for curves too, with 0 as second number.
    Surface(f64, f64),
}

impl std::fmt::Display for VertexRef {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Index(index) => index.fmt(f),
            Self::Name(name) => name.fmt(f),
        }
    }
}
