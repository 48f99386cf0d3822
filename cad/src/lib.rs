//! CAD models, groups, closest points.
mod boxes;
pub use boxes::{Aabb, BoxTree, Nearest};
