//! What is wrong with a Fluent mesh.

/// What can be wrong with a Fluent mesh beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum FluentFault {
    #[error(
        "section {0} is binary, which is not read; in Fluent or TGrid write the mesh as text (file/binary-files no)"
    )]
    Binary(i64),
    #[error("the mesh is of dimension {0}; 2 and 3 are read")]
    Dimension(i64),
    #[error("section {section} tells of {first} to {last}, which is no range")]
    Range { section: i64, first: i64, last: i64 },
    #[error("{what} {number} is told of twice, or not at all: the file is damaged")]
    Gap { what: &'static str, number: usize },
    #[error("a face of zone {zone} names cell {cell}, and there are {count}")]
    Cell { zone: i64, cell: i64, count: usize },
    #[error(
        "a face of zone {zone} has {corners} corners; a cell of such faces is a polyhedron, which cannot be curved: mesh with standard cells"
    )]
    Face { zone: i64, corners: i64 },
    #[error("the file has hanging nodes (section {0}), which cannot be curved as they are: mesh without adaption")]
    Hanging(i64),
    #[error(
        "cell {cell} near {at} has {faces}: it is none of the standard cells, and {others} more are none; polyhedra cannot be curved: mesh with standard cells"
    )]
    Polyhedron { cell: usize, at: String, faces: String, others: usize },
}

crate::formats::error::own!(FluentFault);
