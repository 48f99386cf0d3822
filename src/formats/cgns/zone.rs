//! A zone of a CGNS file.

use glam::DVec3;

use super::sections::Section;
use super::structured::Grid;
use super::tree::Tree;
use crate::formats::assembly::node_of;
use crate::formats::error::Fault;

/// A zone and its place among all.
pub(super) struct Zone<'a> {
    pub(super) tree: &'a Tree<'a>,
    /// Points of the zones before it.
    pub(super) start: usize,
    pub(super) points: Vec<DVec3>,
    /// Number of its cells, as it says.
    pub(super) cells: Option<u64>,
    pub(super) sections: Vec<Section<'a>>,
    /// Its indices, where it is structured.
    pub(super) grid: Option<Grid>,
}

impl Zone<'_> {
    /// The place among the points of all zones of the zone's own point number.
    pub(super) fn point(&self, number: i64) -> Result<usize, Fault> {
        Ok(self.start + node_of(self.points.len(), number, 1, 0)?.index())
    }
}
