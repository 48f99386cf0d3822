//! What is wrong with a GMF file's content.

/// What can be wrong with a GMF file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum GmfFault {
    #[error("GMF version {0} is not read; versions 1 to 4 are")]
    Version(i64),
    #[error(
        "the keyword behind keyword {code} is at byte {next}, which lies before it or beyond the file: it is cut off or damaged"
    )]
    Position { code: i32, next: u64 },
    #[error("the keyword {0} is missing")]
    Missing(&'static str),
    #[error("the keyword {0} occurs twice")]
    Repeated(&'static str),
    #[error("{later} come before {earlier}; write {earlier} first")]
    Order { earlier: &'static str, later: String },
    #[error("dimension {0} is not read; 2 and 3 are")]
    Dimension(i64),
    #[error("precision of {0} bits is not read; 32 and 64 are")]
    Precision(i64),
    #[error("{0} cannot be curved and are not read; write tets, pyramids, prisms and hexes with all nodes")]
    Elements(&'static str),
    #[error("{0} is not an order of the element's {1} nodes: the file is damaged")]
    Ordering(String, usize),
    #[error("the vertices are control points (BezierBasis), not nodes; write nodes")]
    Bezier,
    #[error("reference {0} is larger than {max}, the limit of this program", max = i32::MAX)]
    Reference(i64),
}

crate::formats::error::own!(GmfFault);
