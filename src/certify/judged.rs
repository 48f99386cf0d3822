//! An element and what was found of it.

use glam::DVec3;

use super::Finding;
use crate::element::{Cell, Order};
use crate::mesh::ElementId;

/// A finding with its element and place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// The element.
    pub element: ElementId,
    /// Its kind.
    pub cell: Cell,
    /// Its order.
    pub order: Order,
    /// What was found.
    pub finding: Finding,
    /// Where its smallest known determinant is attained (relative to `J_c` where that is positive).
    pub place: DVec3,
}
