//! Cells of formats that have faces only, each with the cells on its two sides.

use crate::element::Cell;
use crate::mesh::{FaceKey, NodeId};

/// The faces round a cell: their corners, in an order in which the normal points out of the cell.
pub(super) type Faces = Vec<Vec<NodeId>>;

/// The standard cell that faces enclose, and its corners in internal order.
///
/// `None` where they enclose none: another polyhedron, or faces that do not close.
pub(super) fn cell(faces: &Faces) -> Option<(Cell, Vec<NodeId>)> {
    let count = |corners: usize| faces.iter().filter(|face| face.len() == corners).count();
    let (cell, base) = match (faces.len(), count(3), count(4)) {
        (4, 4, 0) => (Cell::Tet, 3),
        (5, 4, 1) => (Cell::Pyramid, 4),
        (5, 2, 3) => (Cell::Prism, 3),
        (6, 0, 6) => (Cell::Hex, 4),
        _ => return None,
    };
    let first = faces.iter().position(|face| face.len() == base)?;
    // The first face of a cell has its normal inside.
    let mut corners: Vec<NodeId> = faces[first].iter().rev().copied().collect();
    let mut above = Vec::new();
    for &corner in &corners {
        let beside = faces.iter().enumerate().filter(|(n, _)| *n != first).flat_map(|(_, face)| {
            let at = face.iter().position(|node| *node == corner);
            at.map(|at| [face[(at + 1) % face.len()], face[(at + face.len() - 1) % face.len()]]).into_iter().flatten()
        });
        let mut up = beside.filter(|node| !corners.contains(node));
        let own = up.next()?;
        if up.any(|other| other != own) {
            return None;
        }
        above.push(own);
    }
    // The apex is above all corners of the base.
    above.dedup();
    corners.extend(above);
    let of_cell: Vec<FaceKey> = cell.faces().iter().map(|face| key(&corners, face.corners)).collect::<Option<_>>()?;
    let closes = corners.len() == cell.corner_count() && faces.iter().all(|face| of_cell.contains(&FaceKey::new(face)));
    closes.then_some((cell, corners))
}

fn key(corners: &[NodeId], places: &[u8]) -> Option<FaceKey> {
    let own: Option<Vec<NodeId>> = places.iter().map(|&place| corners.get(usize::from(place)).copied()).collect();
    own.map(|own| FaceKey::new(&own))
}

/// What faces there are, for messages: `6 faces (4 of 4 corners, 2 of 5)`.
pub(super) fn told(faces: &Faces) -> String {
    let mut counts = std::collections::BTreeMap::new();
    faces.iter().for_each(|face| *counts.entry(face.len()).or_insert(0) += 1);
    let kinds: Vec<String> = counts.iter().map(|(corners, count)| format!("{count} of {corners} corners")).collect();
    format!("{} faces ({})", faces.len(), kinds.join(", "))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Whichever face comes first and wherever it begins, the cell is the one whose faces were taken.
    #[test]
    fn cells_are_found_from_their_faces() {
        for cell in Cell::VOLUME {
            let outward: Faces = cell
                .faces()
                .iter()
                .map(|face| {
                    let mut own: Vec<NodeId> =
                        face.corners.iter().map(|&c| NodeId::new(10 + usize::from(c)).unwrap()).collect();
                    if !face.outward {
                        own.reverse();
                    }
                    own
                })
                .collect();
            for turn in 0..outward.len() {
                let mut faces = outward.clone();
                faces.rotate_left(turn);
                faces.iter_mut().enumerate().for_each(|(n, face)| {
                    let by = (n + turn) % face.len();
                    face.rotate_left(by);
                });
                let (found, corners) = super::cell(&faces).unwrap();
                assert_eq!(found, cell);
                let at: Vec<glam::DVec3> = corners
                    .iter()
                    .map(|node| glam::DVec3::from(cell.corners()[node.index() - 10].map(f64::from)))
                    .collect();
                assert!(crate::element::signed_volume(cell, &at) > 0.0, "{cell}");
                let mut open = faces.clone();
                open[0][0] = NodeId::new(99).unwrap();
                assert_eq!(super::cell(&open), None, "{cell}");
                assert_eq!(super::cell(&faces[1..].to_vec()), None, "{cell}");
            }
        }
    }
}
