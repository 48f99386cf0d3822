//! What is wrong with a UGRID file's content.

/// What can be wrong with a UGRID file beside what can be wrong with any file.
#[derive(Debug, thiserror::Error)]
pub(super) enum UgridFault {
    #[error("the header counts no nodes: an empty or damaged file")]
    NoNodes,
    #[error("more cells follow than the header counts: it is damaged")]
    MoreCells,
}

crate::formats::error::own!(UgridFault);
