//! Smoothing: stages, the active patch, the objective and its descent. Sees the CAD only as a [`Constraint`].

mod best;
mod block;
mod checkpoint;
mod confirm;
mod density;
mod derivative;
mod descend;
mod engine;
mod gradient;
mod kernel;
mod known;
mod objective;
mod pace;
mod patch;
mod problem;
mod settings;
mod stages;
mod summary;
mod survey;
mod view;
mod watch;

use glam::{DAffine3, DVec3};

use crate::mesh::NodeId;
pub use checkpoint::Checkpoint;
pub use engine::Engine;
pub use known::Known;
pub use problem::{ElementCost, Problem};
pub use settings::Settings;
pub use stages::{Begin, smooth};
pub use summary::{Smoothed, Summary};
pub use watch::{Progress, Watch};

/// The directions in which a node may move from where it stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Freedom {
    /// Everywhere.
    Space,
    /// In the plane of this unit normal.
    Plane(DVec3),
    /// Along this unit tangent.
    Line(DVec3),
    /// Nowhere.
    Fixed,
}

impl Freedom {
    /// What is left of it in the plane of this unit normal.
    #[must_use]
    pub fn within(self, normal: DVec3) -> Freedom {
        match self {
            Freedom::Space => Freedom::Plane(normal),
            Freedom::Plane(own) => own.cross(normal).try_normalize().map_or(Freedom::Fixed, Freedom::Line),
            Freedom::Line(_) | Freedom::Fixed => self,
        }
    }

    /// The part of a vector that lies in the free directions.
    fn keep(self, v: DVec3) -> DVec3 {
        match self {
            Freedom::Space => v,
            Freedom::Plane(normal) => v - normal * normal.dot(v),
            Freedom::Line(tangent) => tangent * tangent.dot(v),
            Freedom::Fixed => DVec3::ZERO,
        }
    }
}

/// What holds the nodes that lie on boundaries: the smoother's only sight of the CAD.
pub trait Constraint: Sync {
    /// How `node` may move from `at`.
    fn freedom(&self, node: NodeId, at: DVec3) -> Freedom;

    /// The allowed place nearest to `wish`, for a node that stands at `from`.
    fn restrict(&self, node: NodeId, from: DVec3, wish: DVec3) -> DVec3;

    /// Nodes that move as images of others.
    fn images(&self) -> &[Image] {
        &[]
    }

    /// What draws a node back to where it was put; nodes without an anchor follow their elements alone.
    fn anchor(&self, _node: NodeId) -> Option<Anchor> {
        None
    }
}

/// A node of a periodic patch that is another's image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image {
    /// The node.
    pub node: NodeId,
    /// What it is an image of; itself no image.
    pub of: NodeId,
    /// The map from that one to the node.
    pub map: DAffine3,
}

impl Image {
    /// Marks originals and all their images where one of them is marked.
    pub(crate) fn spread(images: &[Image], marked: &mut [bool]) {
        for Image { node, of, .. } in images {
            marked[of.index()] |= marked[node.index()];
        }
        for Image { node, of, .. } in images {
            marked[node.index()] |= marked[of.index()];
        }
    }
}

/// A spring that holds a wall node near its place among its neighbours: the wall polynomial follows the CAD only as well
/// as its nodes are spread. The objective grows by 1 where the node is `slack` away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// Where the node was put.
    pub place: DVec3,
    /// Distance that costs as much as one element at its worst shape.
    pub slack: f64,
    /// Whether the slack grows where nodes on walls hold back the worst elements.
    pub loosens: bool,
}

impl Anchor {
    /// The same spring with so many times the slack, if it loosens.
    fn loosened(self, looseness: f64) -> Anchor {
        Anchor { slack: if self.loosens { self.slack * looseness } else { self.slack }, ..self }
    }
}
