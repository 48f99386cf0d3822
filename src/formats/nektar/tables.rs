//! The sections of a file, as they stand there.

use glam::DVec3;

/// A face or element: what bounds it.
pub(super) struct Row {
    pub(super) letter: String,
    pub(super) id: i64,
    pub(super) bounds: Vec<i64>,
}

/// A curved edge or face.
pub(super) struct Points {
    /// The edge or face.
    pub(super) id: i64,
    /// How its points are distributed.
    pub(super) kind: String,
    pub(super) points: Vec<DVec3>,
}

/// A composite.
pub(super) struct Listed {
    pub(super) id: i64,
    pub(super) name: Option<String>,
    /// What it holds, as text.
    pub(super) members: String,
}

/// What a file holds.
#[derive(Default)]
pub(super) struct Tables {
    /// Dimension of the elements.
    pub(super) dimension: usize,
    pub(super) vertices: Vec<(i64, DVec3)>,
    pub(super) edges: Vec<(i64, [i64; 2])>,
    pub(super) faces: Vec<Row>,
    pub(super) elements: Vec<Row>,
    pub(super) curved_edges: Vec<Points>,
    pub(super) curved_faces: Vec<Points>,
    pub(super) composites: Vec<Listed>,
}
