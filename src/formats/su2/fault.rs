//! What is wrong with an SU2 file's content.

use crate::element::Cell;

/// What can be wrong with an SU2 file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum Su2Fault {
    #[error("{0}= is missing")]
    Missing(&'static str),
    #[error("{later}= must follow {earlier}=")]
    Order { earlier: &'static str, later: &'static str },
    #[error("{0}= stands twice in one zone")]
    Repeated(&'static str),
    #[error(
        "element type {0} is not one of SU2's: 1, 3, 5, 9, 10, 12, 13, 14, with 100 more for each order from 2 to 4"
    )]
    UnknownElementType(i64),
    #[error("a {cell} among the elements of {key}, whose dimension is {dimension}: the file is damaged")]
    Dimension { cell: Cell, key: &'static str, dimension: usize },
    #[error("{found} numbers follow what is read, and {before} on the lines before: a number is missing or too many")]
    LineLength { found: usize, before: usize },
}

crate::formats::error::own!(Su2Fault);
