//! What is wrong with an SU2 file's content.

/// What can be wrong with an SU2 file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum Su2Fault {
    #[error("{0}= is missing")]
    Missing(&'static str),
    #[error("{later}= must follow {earlier}=")]
    Order { earlier: &'static str, later: &'static str },
    #[error("element type {0} is not one of SU2's: 1, 3, 5, 9, 10, 12, 13, 14")]
    UnknownElementType(i64),
}

crate::formats::error::own!(Su2Fault);
