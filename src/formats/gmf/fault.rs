//! What is wrong with a GMF file's content.

use crate::element::{Cell, Order};

/// What can be wrong with a GMF file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum GmfFault {
    #[error("MeshVersionFormatted {0} is not read; versions 1 to 4 are")]
    Version(i64),
    #[error("Dimension {0} is not read; 2 and 3 are")]
    Dimension(i64),
    #[error("{0} stands before Dimension: the file is damaged")]
    NoDimension(String),
    #[error("Vertices is missing")]
    NoVertices,
    #[error("Vertices is given twice: the file is damaged")]
    TwoVertices,
    #[error("the next keyword is said to be at byte {0}, which is not behind this one: the file is damaged")]
    Next(u64),
    #[error("the ordering of {order} {cell} elements does not name each node of the lattice once")]
    Ordering { cell: Cell, order: Order },
}

crate::formats::error::own!(GmfFault);
