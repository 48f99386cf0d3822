//! The way of the wall nodes from the fallback to the CAD, and how far they are on it.

use glam::DVec3;

use crate::curve::recover::backtrack::Fallback;
use crate::curve::wall::CadConstraint;
use crate::mesh::NodeId;
use crate::smooth::{Anchor, Constraint, Freedom, Image};

/// The way of all nodes from the fallback to the CAD; nodes that are not on walls have none.
#[derive(Clone)]
pub(super) struct Way {
    pub(super) fallback: Fallback,
    /// Places on the CAD.
    pub(super) goals: Vec<DVec3>,
    /// Displacements of the boundary nodes from their straight places to the CAD.
    pub(super) whole: Vec<DVec3>,
    /// How far along each node is; 1 on the CAD.
    pub(super) shares: Vec<f64>,
}

impl Way {
    /// All nodes on the CAD, at `places`.
    pub(super) fn new(fallback: Fallback, places: &[DVec3], displacement: &[DVec3]) -> Way {
        Way { fallback, goals: places.to_vec(), whole: displacement.to_vec(), shares: vec![1.0; places.len()] }
    }

    /// Whether every node is on the CAD.
    pub(super) fn is_done(&self) -> bool {
        self.shares.iter().all(|&share| share >= 1.0)
    }

    /// How far along the last of the nodes is that are not on the CAD and are pulled with full strength.
    pub(super) fn least(&self, pull: &[f64]) -> Option<f64> {
        let left = self.shares.iter().zip(pull).filter(|(share, pull)| **share < 1.0 && **pull >= 1.0);
        left.map(|(share, _)| *share).min_by(f64::total_cmp)
    }

    /// Takes a node that stands at `place` back, to this share of where it is on its way.
    pub(super) fn take_back(&mut self, node: usize, share: f64, place: DVec3) {
        if self.shares[node] >= 1.0 {
            self.goals[node] = place; // it may have slid
        }
        self.shares[node] *= share;
    }

    /// Where a node is.
    pub(super) fn place(&self, node: usize) -> DVec3 {
        self.between(node, self.fallback.places[node], self.goals[node])
    }

    /// The displacement from its `straight` place that a boundary node follows.
    pub(super) fn displacement(&self, node: usize, straight: DVec3) -> DVec3 {
        self.between(node, self.fallback.places[node] - straight, self.whole[node])
    }

    fn between(&self, node: usize, back: DVec3, goal: DVec3) -> DVec3 {
        if self.shares[node] < 1.0 { back.lerp(goal, self.shares[node]) } else { goal }
    }
}

/// The CAD's constraint, and nodes off the CAD held where they are.
pub(super) struct Held<'a> {
    pub(super) wall: CadConstraint<'a>,
    pub(super) shares: &'a [f64],
}

impl Constraint for Held<'_> {
    fn freedom(&self, node: NodeId, at: DVec3) -> Freedom {
        if self.shares[node.index()] < 1.0 { Freedom::Fixed } else { self.wall.freedom(node, at) }
    }

    fn restrict(&self, node: NodeId, from: DVec3, wish: DVec3) -> DVec3 {
        self.wall.restrict(node, from, wish)
    }

    fn images(&self) -> &[Image] {
        self.wall.images()
    }

    fn anchor(&self, node: NodeId) -> Option<Anchor> {
        self.wall.anchor(node).filter(|_| self.shares[node.index()] >= 1.0)
    }
}
