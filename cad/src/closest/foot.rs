//! What a query answers.

use crate::ids::{EdgeId, EntityId, VertexId};
use glam::DVec3;

/// The closest point of a group to a query point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// The point on the CAD, evaluated by OCCT, in the unit of the file.
    pub point: DVec3,
    /// The face, edge or vertex it lies on.
    pub entity: EntityId,
    /// OCCT's parameters on that entity: `u, v` of a face, `t, 0` of an edge, zeros of a vertex. For [`End::OnTrim`] they are those of
    /// the edge's pcurve: the surface there differs from `point` by up to the edge's tolerance. `None` at a boundary edge or corner for
    /// which the file has no curve on the surface.
    pub parameters: Option<[f64; 2]>,
    /// Distance from the query point to `point`; finite.
    pub distance: f64,
    /// How the search ended.
    pub end: End,
    /// Why another point of the group might be nearer; `None` where the foot is proven to be the closest point (up to rounding): every
    /// leaf was either farther away or had one minimum only.
    pub doubt: Option<Doubt>,
}

impl Foot {
    /// Whether the foot is proven to be the closest point of the group.
    pub fn is_proven(&self) -> bool {
        self.doubt.is_none()
    }
}

/// Why a foot is not proven to be the closest point; of several reasons, the last of these.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Doubt {
    /// A surface or curve near by is of a kind whose hulls are sampled.
    SampledHull,
    /// The search spent [`CUT_BUDGET`](crate::tolerance::CUT_BUDGET) before it had cut all that may be nearer.
    Budget,
    /// The search was made without proof.
    NotSearched,
}

impl std::fmt::Display for Doubt {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::SampledHull => "a surface or curve nearby is bounded by samples only",
            Self::Budget => "too many parts are equally near",
            Self::NotSearched => "not searched",
        })
    }
}

/// How a query ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// Inside a face or an edge; the line to the query point is normal to it.
    Interior,
    /// On a boundary edge of the face.
    OnTrim(EdgeId),
    /// On a line where the surface or curve is not smooth, or ends without an edge.
    OnCrease,
    /// At the end of an edge, or at a corner of the face.
    OnEnd(VertexId),
    /// The best point found is not a minimum: `residual` is the length of the tangential part of (foot − query point).
    Stalled {
        /// In the unit of the file.
        residual: f64,
    },
}
