//! What is wrong with a HOPR file.

/// What can be wrong with a HOPR file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum HoprFault {
    #[error("Ngeo is {0}; elements of order 1 to 4 are read: set NGeo in HOPR's parameters")]
    Order(i64),
    #[error("{found} coordinates for {numbers} numbers of nodes: the file is damaged")]
    Nodes { found: usize, numbers: usize },
    #[error("node {0} is at two places: the file is damaged")]
    Apart(i64),
    #[error("{found} numbers are no rows of {width}: the file is damaged")]
    Rows { found: usize, width: usize },
    #[error(
        "element {element} is of type {kind}, which is no tet, pyramid, prism or hex (HOPR's table of types ends in 4, 5, 6, 8)"
    )]
    Kind { element: usize, kind: i64 },
    #[error("element {element} has the nodes {first} to {last}, and its order asks for {wanted} that are there")]
    Range { element: usize, first: i64, last: i64, wanted: usize },
    #[error("element {element} has the sides {first} to {last}, and its kind asks for {wanted} that are there")]
    Sides { element: usize, first: i64, last: i64, wanted: usize },
    #[error("{names} names of conditions for {kinds} types: the file is damaged")]
    Conditions { names: usize, kinds: usize },
    #[error("a side of element {element} has condition {condition}, and there are {count}")]
    Condition { element: usize, condition: i64, count: usize },
}

crate::formats::error::own!(HoprFault);
