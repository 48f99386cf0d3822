//! Faces and edges by their corners.

use super::NodeId;
use crate::element::canonical;

/// A face or edge by the nodes at its corners: the same whichever corner and direction an element begins with.
///
/// The smallest corner comes first, then the way to its smaller neighbour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FaceKey([NodeId; 4]);

impl FaceKey {
    /// The key of a loop of two to four corners.
    #[must_use]
    pub fn new(corners: &[NodeId]) -> FaceKey {
        FaceKey::seen(corners).0
    }

    /// The key of a loop of corners, and which corner of the loop stands at each place of the key.
    #[must_use]
    pub fn seen(corners: &[NodeId]) -> (FaceKey, [u8; 4]) {
        let order = canonical(corners);
        let mut key = [NodeId::NONE; 4];
        key.iter_mut().zip(&order[..corners.len()]).for_each(|(slot, &q)| *slot = corners[usize::from(q)]);
        (FaceKey(key), order)
    }

    /// The key of a face of an element with these nodes, by the positions of its corners among them.
    #[must_use]
    pub(super) fn picked(nodes: &[NodeId], places: &[u8]) -> FaceKey {
        let mut corners = [NodeId::NONE; 4];
        corners.iter_mut().zip(places).for_each(|(slot, &q)| *slot = nodes[usize::from(q)]);
        FaceKey::new(&corners[..places.len()])
    }

    /// The corners, in the order of the key.
    #[must_use]
    pub fn corners(&self) -> &[NodeId] {
        let count = self.0.iter().position(|&node| node == NodeId::NONE).unwrap_or(self.0.len());
        &self.0[..count]
    }
}
