//! The linear mesh that a curved one was made from, matched by node numbers.

use glam::DVec3;
use rustc_hash::FxHashMap;

use super::Mesh;

/// Why a mesh is not the linear mesh of another.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotItsLinear {
    /// Their elements differ in number.
    #[error("it has {linear} {what}, the curved mesh has {curved}")]
    Count {
        /// Cells, or elements on the boundary.
        what: &'static str,
        /// Number in the linear mesh.
        linear: usize,
        /// Number in the curved mesh.
        curved: usize,
    },
    /// A corner of the curved mesh has a number that is none of the linear mesh's.
    #[error("it has no node {0}")]
    Node(u64),
}

/// Positions by the nodes of the curved mesh: at corners of cells those of the linear mesh's nodes of the same numbers, else its own.
///
/// # Errors
/// [`NotItsLinear`].
pub fn linear_positions(curved: &Mesh, linear: &Mesh) -> Result<Vec<DVec3>, NotItsLinear> {
    let counts = |mesh: &Mesh| [("cells", mesh.cells().len()), ("elements on the boundary", mesh.sides().len())];
    for ((what, curved), (_, linear)) in counts(curved).into_iter().zip(counts(linear)) {
        if curved != linear {
            return Err(NotItsLinear::Count { what, linear, curved });
        }
    }
    let by_tag: FxHashMap<u64, usize> = linear.node_tags().iter().enumerate().map(|(n, &tag)| (tag, n)).collect();
    let mut points = curved.points().to_vec();
    for corner in curved.cells().iter().flat_map(|cell| cell.corners()) {
        let tag = curved.node_tags()[corner.index()];
        let known = by_tag.get(&tag).ok_or(NotItsLinear::Node(tag))?;
        points[corner.index()] = linear.points()[*known];
    }
    Ok(points)
}
