//! What is wrong with a VTK file's content.

/// What can be wrong with a VTK file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum VtkFault {
    #[error(
        "cell {tag} is of type {code}, which leaves out interior nodes or is not a Lagrange cell; write Lagrange or linear cells"
    )]
    IncompleteCell { tag: u64, code: i64 },
    #[error(
        "cell {tag} is of type {code}: polygons, polyhedra, strips and voxels are not read; write tets, pyramids, prisms, hexes"
    )]
    UnknownCell { tag: u64, code: i64 },
    #[error(
        "cell {tag} of type {code} has {found} nodes, which fits no order from 1 to 4; its writer does not support such cells: export the mesh as MSH or CGNS"
    )]
    CellNodes { tag: u64, code: i64, found: usize },
    #[error("an array cannot be decoded ({0}): the file is damaged")]
    Compressed(String),
    #[error("the array {name} has {found} values for {cells} cells: the file is damaged")]
    ArrayLength { name: String, found: usize, cells: usize },
    #[error("the section {0} is missing: the file was cut off, or its keyword is damaged")]
    Missing(&'static str),
    #[error("the section {0} occurs twice")]
    Repeated(&'static str),
    #[error(
        "an array's blocks hold {announced} bytes when expanded, but no more than {limit} can be of use here: the file is damaged or hostile"
    )]
    Expanded { announced: u64, limit: u64 },
    #[error("{0} bytes follow the values of an array that stands in place: the file is damaged")]
    Leftover(usize),
    #[error("an array is of bytes, and the file does not say their order (byte_order of VTKFile)")]
    ByteOrder,
    #[error(
        "cell {tag} is a Lagrange hex, whose order of nodes depends on the version, and the file says none (version of VTKFile)"
    )]
    NoVersion { tag: u64 },
}

crate::formats::error::own!(VtkFault);
