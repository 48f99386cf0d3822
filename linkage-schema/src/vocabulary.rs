//! The words of the format: one table of elements with the attributes each may have.

/// An element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    MeshLink,
    Attribute,
    AttributeGroup,
    GeometryFile,
    GeometryReference,
    GeometryGroup,
    MeshFile,
    MeshModelReference,
    MeshSheet,
    MeshSheetReference,
    MeshFace,
    MeshFaceReference,
    MeshString,
    MeshStringReference,
    MeshEdge,
    MeshEdgeReference,
    MeshPointReference,
    ParamVertex,
    Transform,
    MeshElementLinkage,
    /// Anything else.
    Unknown,
}

const MESH: &[&str] = &["mid", "name", "aref", "gref"];
const MESH_REF: &[&str] = &["mid", "name", "aref", "gref", "ref"];
const RUN: &[&str] = &["mid", "name", "aref", "gref", "etype", "format", "count"];
const POINTS: &[&str] = &["mid", "name", "aref", "gref", "format", "count"];

/// The only place where the words are spelled out.
const ELEMENTS: [(Element, &str, &[&str]); 20] = [
    (Element::ParamVertex, "ParamVertex", &["mid", "vref", "gref", "dim"]),
    (Element::MeshFace, "MeshFace", RUN),
    (Element::MeshEdge, "MeshEdge", RUN),
    (Element::MeshPointReference, "MeshPointReference", POINTS),
    (Element::MeshSheet, "MeshSheet", MESH),
    (Element::MeshString, "MeshString", MESH),
    (Element::GeometryReference, "GeometryReference", &["gid", "ref", "aref", "name"]),
    (Element::GeometryGroup, "GeometryGroup", &["gid", "aref", "name"]),
    (Element::MeshFaceReference, "MeshFaceReference", RUN),
    (Element::MeshEdgeReference, "MeshEdgeReference", RUN),
    (Element::MeshSheetReference, "MeshSheetReference", MESH_REF),
    (Element::MeshStringReference, "MeshStringReference", MESH_REF),
    (Element::MeshModelReference, "MeshModelReference", MESH_REF),
    (Element::MeshFile, "MeshFile", &["filename", "aref"]),
    (Element::GeometryFile, "GeometryFile", &["filename", "aref"]),
    (Element::Attribute, "Attribute", &["attid", "name"]),
    (Element::AttributeGroup, "AttributeGroup", &["attid", "name"]),
    (Element::Transform, "Transform", &["xid", "aref", "name"]),
    (
        Element::MeshElementLinkage,
        "MeshElementLinkage",
        &["sourceEntityRef", "targetEntityRef", "xref", "aref", "name"],
    ),
    (Element::MeshLink, "MeshLink", &["version"]),
];

impl Element {
    /// The element with this local name.
    pub(crate) fn from_name(name: &str) -> Self {
        ELEMENTS.iter().find(|(_, word, _)| *word == name).map_or(Self::Unknown, |(element, _, _)| *element)
    }

    fn row(self) -> Option<&'static (Self, &'static str, &'static [&'static str])> {
        ELEMENTS.iter().find(|(element, _, _)| *element == self)
    }

    /// Its local name.
    pub(crate) fn name(self) -> &'static str {
        self.row().map_or("an unknown element", |(_, name, _)| name)
    }

    /// The attributes it may have.
    pub(crate) fn attributes(self) -> &'static [&'static str] {
        self.row().map_or(&[], |(_, _, attributes)| attributes)
    }
}
