//! What is wrong with an MFEM mesh.

use crate::element::Cell;

/// What can be wrong with an MFEM mesh beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum MfemFault {
    #[error("version {0:?} is not 1.0, 1.2 or 1.3")]
    Version(String),
    #[error("the mesh is of dimension {0}; 2 and 3 are read")]
    Dimension(usize),
    #[error("geometry {0} is not one of 0 (point) to 7 (pyramid)")]
    Geometry(i64),
    #[error("a {cell} among {what} of a mesh of dimension {dimension}: the file is damaged")]
    Misplaced { cell: Cell, what: &'static str, dimension: usize },
    #[error("the attribute {0} is not a positive number")]
    Attribute(i64),
    #[error("the nodes are values of {0:?}, which is not read; in MFEM call SetCurvature(order) and save the mesh")]
    Collection(String),
    #[error("the nodes have {0} coordinates; 2 and 3 are read")]
    VectorDimension(usize),
    #[error("the nodes have {axes} coordinates, and the mesh is of dimension {dimension}: the file is damaged")]
    Flat { axes: usize, dimension: usize },
    #[error("the ordering of the nodes is {0}, not 0 or 1")]
    Ordering(i64),
    #[error("an element has vertex {0} at two corners: remove the element, or write it as one with fewer corners")]
    Collapsed(usize),
    #[error("boundary element {0} is no side of any element: its nodes are not known")]
    Stray(u64),
}

crate::formats::error::own!(MfemFault);
