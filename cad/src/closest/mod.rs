//! The closest point of a group of CAD entities: the search, its proof and its memory.

mod duplicate;
mod finish;
pub(crate) mod foot;
pub(crate) mod group;
pub(crate) mod hint;
mod search;
