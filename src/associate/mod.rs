//! Which CAD group each boundary point, edge and face of the mesh lies on.
//!
//! ```text
//!  MeshLink sheets, strings, points ─┐
//!                                    ├─ candidates ── bind ──► surfaces, curves, classifications of the linear nodes
//!  entity tags of the mesh file ─────┘            (checked against the CAD: do the points lie there?)
//! ```
//!
//! A number or tag (`face-3`, an entity tag) belongs to the CAD file that the linkage names or that the mesh was made on.
//! With any other file it counts only where all points of the mesh entity lie on that CAD entity. Faces for which that
//! fails are an error; an edge is then looked for among the CAD edges of the surfaces that meet in it, as the numbers of
//! edges differ between STEP and IGES of the same shape.

mod bind;
mod candidates;
mod choice;
mod classify;
mod document;
mod error;
mod flaws;
mod host;
mod infer;
mod joint;
mod link;
mod linkage;
mod numbering;
mod open;
mod path;
mod periodic;
mod propose;
mod side;
mod sizes;
mod summary;
mod witnesses;

use glam::DVec3;

use cad::Group;

use crate::mesh::Plane;

pub use bind::associate;
pub use candidates::{Candidate, Candidates, Teller};
pub use choice::{Choice, UnknownPatch};
pub use classify::{Classified, ClassifyError, Sources, classify};
pub use document::{TooLarge, Written, document};
pub use error::AssociateError;
pub use host::normal_of;
pub use infer::{Doubt, Incidence, Inference, ON_CAD, Tolerance, infer};
pub use joint::{Joints, SHARP, normal_at};
pub use link::{LinkError, LinkJob, Linked, ReadLinearError, read_linear};
pub use linkage::{Linkage, LinkageError, linked, models_of, own_geometry, same_file};
pub use numbering::{Numbering, Part, UnknownZone};
pub use open::{OpenFace, open_faces, open_notes};
pub use path::paths;
pub use periodic::{NotPeriodic, PeriodicSheet, periodic_records, periodic_sheets};
pub use propose::{Proposal, propose};
pub use side::{Side, sides};
pub use sizes::check_boxes;
pub use summary::{Patch, SUMMARY_SCHEMA, SpotReport, Summary, Undecided, summary};

/// A set of CAD faces that mesh faces lie on; of CAD edges that the sides of a plane mesh lie on.
#[derive(Debug)]
pub struct Surface {
    /// The set, ready for closest points.
    pub group: Group,
    /// What the user calls it: sheet name or entity, and its CAD references.
    pub label: String,
    /// The plane of the faces, where they are planes and lie in one; of straight edges in one line that which stands on the mesh's plane.
    pub plane: Option<Plane>,
}

/// A set of CAD edges that mesh edges lie on.
#[derive(Debug)]
pub struct Curve {
    /// The set, ready for closest points.
    pub group: Group,
    /// What the user calls it.
    pub label: String,
}

/// What holds a boundary node or the inner nodes of a boundary edge or face: the lowest entity wins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Classification {
    /// A node inside the volume.
    #[default]
    Free,
    /// Inside a surface, by index in [`Association::surfaces`].
    Surface(usize),
    /// In an unlinked patch that is plane, by index in [`Association::planes`].
    Plane(usize),
    /// On a curve, by index in [`Association::curves`].
    Curve(usize),
    /// At this point of the CAD.
    Vertex(DVec3),
    /// Unlinked and not in a plane, or where an unlinked plane ends: stays where it is.
    Straight,
}

/// The mesh associated with the CAD.
#[derive(Debug, Default)]
pub struct Association {
    /// CAD faces with mesh faces on them; in a plane mesh CAD edges with sides on them.
    pub surfaces: Vec<Surface>,
    /// CAD edges with mesh edges on them.
    pub curves: Vec<Curve>,
    /// Planes of unlinked patches.
    pub planes: Vec<Plane>,
    /// Classification of every linear node.
    pub nodes: Vec<Classification>,
    /// Classification of the inner nodes of every boundary face, by index in [`Boundary::faces`](crate::mesh::Boundary::faces).
    pub faces: Vec<Classification>,
    /// Classification of the inner nodes of every boundary edge, by index in [`Boundary::edges`](crate::mesh::Boundary::edges).
    pub edges: Vec<Classification>,
    /// The largest distance of a linear node from the CAD faces or edges that candidates put it on.
    pub farthest: f64,
    /// What a user should know and need not fix.
    pub notes: Vec<String>,
}

impl Association {
    /// The CAD that holds a classification's nodes, if it holds them on a surface or curve.
    #[must_use]
    pub fn group_of(&self, classification: Classification) -> Option<&Group> {
        match classification {
            Classification::Surface(surface) => Some(&self.surfaces[surface].group),
            Classification::Curve(curve) => Some(&self.curves[curve].group),
            _ => None,
        }
    }

    /// The plane that holds a classification's nodes, if one does.
    #[must_use]
    pub fn plane_of(&self, classification: Classification) -> Option<Plane> {
        match classification {
            Classification::Plane(plane) => Some(self.planes[plane]),
            Classification::Surface(surface) => self.surfaces[surface].plane,
            _ => None,
        }
    }
}
