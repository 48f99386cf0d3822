//! What is wrong with an MSH file's content.

use crate::mesh::EntityKey;

/// What can be wrong with an MSH file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum MshFault {
    #[error("MSH version {0} is not read; save as version 4.1 or 2.2 (Gmsh: Mesh.MshFileVersion = 4.1)")]
    Version(String),
    #[error("data size {0}, but Gmsh's files have 8; the header is damaged")]
    DataSize(i32),
    #[error("the byte-order mark is {0:#010x}, not 1 in either byte order: the header is damaged")]
    ByteOrder(u32),
    #[error("section ${0} is missing")]
    MissingSection(&'static str),
    #[error("section ${0} occurs twice")]
    RepeatedSection(&'static str),
    #[error("section ${later} must follow ${earlier}")]
    SectionOrder { earlier: &'static str, later: &'static str },
    #[error("section ${section} should end here, found {found:?}")]
    SectionEnd { section: String, found: String },
    #[error("node number 0; numbers must be positive")]
    ZeroNode,
    #[error("node {0} occurs twice; renumber the nodes (Gmsh: Mesh.Renumber)")]
    RepeatedNode(u64),
    #[error("{what} {by} refers to node {node}, which the file does not have")]
    UnknownNode { what: &'static str, by: u64, node: u64 },
    #[error(
        "element type {0} is unknown; points, lines, triangles, quadrilaterals, tets, pyramids, prisms and hexes are read"
    )]
    UnknownElementType(i32),
    #[error(
        "element type {0} leaves out interior nodes (serendipity); write complete elements (Gmsh: Mesh.SecondOrderIncomplete = 0)"
    )]
    IncompleteElementType(i32),
    #[error("element type {0} is of order 5 or more; orders 1 to 4 are read")]
    OrderTooHigh(i32),
    #[error("elements of dimension {found} on {entity}: the file is damaged")]
    ElementDimension { entity: EntityKey, found: usize },
    #[error("entity dimension {0} is outside 0 to 3")]
    EntityDimension(i32),
}

crate::formats::error::own!(MshFault);
