//! The association where neither a linkage file nor tags give it: by geometry, and by connectivity where geometry leaves a choice.
//!
//! 1. **Incidence.** A node lies on every CAD face, edge and vertex within tolerance ([`Tolerance`]): well below the mesh's own size, so that the
//!    first layer of nodes over a wall is not taken for the wall.
//! 2. **Candidates.** A mesh face may lie on the CAD faces that hold all its corners, that run along it, and that its middle is near to.
//! 3. **Sides.** Mesh faces with one candidate show on which side of each CAD face the volume is. Candidates with the volume on the other side are
//!    struck out: at a sharp edge both sides of a thin plate hold all corners of some faces.
//!    So are, where a wider tolerance is tried, candidates of faces that face the other way and lie farther off than others, and of faces that hang
//!    together with none that the first one found ([`before`]): the outer boundary of a thin mesh runs beside the CAD too.
//! 4. **Growth.** A mesh face that still has a choice goes with a neighbour across a mesh edge that runs along no CAD edge, and not with one across
//!    an edge of the neighbour's CAD face. Nearness never decides.
//! 5. **Smooth groups.** Faces whose corners no single CAD face holds, but several that go on smoothly in one another do, lie on these together.
//! 6. **Edges and corners.** A mesh edge between faces on different CAD faces goes to the CAD edge of theirs that it runs along; a node at the vertex of such
//!    an edge to that vertex.
//!
//! What is left is undecided: it is listed, and associated with nothing.

mod before;
mod edges;
mod faces;
mod in_plane;
mod incidence;
mod near;
mod smooth_groups;
mod volume_sides;

use cad::{Aabb, EntityId, Model};

use super::{Candidates, Joints, Side, Teller, sides};
use crate::mesh::{Boundary, Mesh};
use before::Before;
pub use incidence::Incidence;

/// Default tolerance, as a fraction of the mesh's bounding-box diagonal.
pub const ON_CAD: f64 = 1e-5;
/// The tolerance where none is asked for stays below this fraction of the shortest mesh edge at a node.
const OF_EDGE: f64 = 0.1;

/// The wider tolerance that is tried where this one leaves faces open; fraction of the mesh's bounding-box diagonal.
const WIDE: f64 = 1e-4;

/// How far a node may be from a CAD entity that holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    distance: f64,
    limit: Limit,
}

/// What a tolerance is limited by.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Limit {
    /// A fraction of the shortest mesh edge at the node.
    AnyEdge,
    /// A fraction of the shortest edge of the boundary face at the node whose edges are longest, the spacing along the wall: first cells may be
    /// lower than the CAD is exact.
    AlongWall,
    /// Nothing.
    None,
}

impl Tolerance {
    /// [`ON_CAD`] of the mesh's bounding-box diagonal, and at most a tenth of the shortest mesh edge at the node.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Tolerance {
        Tolerance {
            distance: ON_CAD * Aabb::of_points(mesh.points().iter().copied()).diagonal(),
            limit: Limit::AnyEdge,
        }
    }

    /// This distance at all nodes.
    #[must_use]
    pub fn fixed(distance: f64) -> Tolerance {
        Tolerance { distance, limit: Limit::None }
    }

    /// The wider one to be tried next, for meshes in single precision and CAD that is less exact than the first cells are high.
    fn wider(&self) -> Option<Tolerance> {
        let wide = Tolerance { distance: self.distance * WIDE / ON_CAD, limit: Limit::AlongWall };
        (self.limit == Limit::AnyEdge).then_some(wide)
    }

    fn is_wide(&self) -> bool {
        self.limit == Limit::AlongWall
    }

    /// At a node whose shortest edge has this length.
    fn at(&self, shortest: f64) -> f64 {
        if self.limit == Limit::None { self.distance } else { self.distance.min(OF_EDGE * shortest) }
    }
}

/// Why a face or edge is associated with nothing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// No CAD face (in the plane: edge) holds any of its corners: the patch may not be part of the CAD.
    #[error("its points are not on the CAD")]
    OffCad,
    /// Some of its corners are on the CAD, and some are not.
    #[error("some of its points are not on the CAD")]
    PartlyOffCad,
    /// It runs beside a CAD face or edge, farther from it than the tolerance, on which nothing else of the mesh lies.
    #[error("its points are up to {distance:.1e} off {on}, beyond the tolerance")]
    Beside {
        /// The nearest one.
        on: EntityId,
        /// The largest distance of its corners from it.
        distance: f64,
    },
    /// Each corner is on the CAD, but on no common face.
    #[error(
        "its points are on the CAD, but no part of it, and no set of parts that meet smoothly, contains them all and runs along it"
    )]
    NoCommonFace,
    /// Several CAD faces or edges hold it, and its neighbours do not decide which.
    #[error("it may lie on {}", list(.0))]
    Several(Vec<EntityId>),
    /// The linkage file says nothing of it, and where it lies by geometry does not go with the file.
    #[error("the linkage file says nothing of it, and that it lies on {0} does not go with the file")]
    Unfit(EntityId),
    /// It lies between faces on different CAD faces, but along none of their edges.
    #[error("it lies between {} and {}, but along no CAD edge that they share", .0[0], .0[1])]
    NoEdge([EntityId; 2]),
}

impl Doubt {
    /// How far from the CAD the face is, where that is the doubt.
    #[must_use]
    pub fn distance(&self) -> Option<f64> {
        if let Doubt::Beside { distance, .. } = self { Some(*distance) } else { None }
    }

    /// What kind of doubt it is, in a few words.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Doubt::OffCad => "not on the CAD",
            Doubt::PartlyOffCad => "partly off the CAD",
            Doubt::Beside { .. } => "beside the CAD",
            Doubt::NoCommonFace => "on no common CAD face",
            Doubt::Several(_) => "on several CAD faces",
            Doubt::Unfit(_) => "against the linkage file",
            Doubt::NoEdge(_) => "along no CAD edge",
        }
    }

    /// What a user can do.
    #[must_use]
    pub fn remedy(&self) -> String {
        match self {
            Doubt::OffCad | Doubt::PartlyOffCad => {
                "raise --tolerance if it was made on this CAD, or leave its patch straight by --straight".into()
            }
            Doubt::Beside { distance, .. } => {
                format!(
                    "--tolerance {:.1e} takes it as on the CAD; --straight leaves its patch as it is",
                    2.0 * distance
                )
            }
            Doubt::NoCommonFace | Doubt::Several(_) | Doubt::Unfit(_) | Doubt::NoEdge(_) => {
                "say where it lies in a linkage file, or leave its patch straight by --straight".into()
            }
        }
    }
}

fn list(entities: &[EntityId]) -> String {
    entities.iter().map(ToString::to_string).collect::<Vec<_>>().join(" or ")
}

/// What was found.
#[derive(Debug)]
pub struct Inference {
    /// What is decided.
    pub candidates: Candidates,
    /// Boundary faces that are not, by index, with the reason.
    pub faces: Vec<(usize, Doubt)>,
    /// Boundary edges that are not.
    pub edges: Vec<(usize, Doubt)>,
}

impl Inference {
    /// Faces whose points are on the CAD and that are undecided all the same.
    #[must_use]
    pub fn undecided(&self) -> usize {
        self.faces.iter().filter(|(_, doubt)| *doubt != Doubt::OffCad).count()
    }
}

/// Associates the boundary with the CAD by geometry; where the tolerance leaves faces open, with a wider one if that decides more.
#[must_use]
pub fn infer(mesh: &Mesh, boundary: &Boundary, model: &Model, tolerance: &Tolerance) -> Inference {
    let joints = Joints::new(model);
    let sides = sides(mesh, boundary);
    let part = Part { mesh, boundary, model, joints: &joints, sides: &sides };
    let within = |tolerance: &Tolerance, before: Option<&Before>| match boundary.plane {
        Some(_) => in_plane::infer(part, tolerance, before),
        None => infer_within(part, tolerance, before),
    };
    let first = within(tolerance, None);
    let Some(wider) = tolerance.wider().filter(|_| !first.faces.is_empty()) else { return first };
    let before = Before::of(&first.candidates.sheets, &joints, &sides);
    let mut second = within(&wider, Some(&before));
    let more = first.faces.len().saturating_sub(second.faces.len());
    if more == 0 {
        return first;
    }
    second.candidates.notes.push(format!(
        "{more} faces are farther from the CAD than {:.1e}, or than a tenth of the mesh edges there; they were associated with it \
         within {:.1e}",
        tolerance.distance, wider.distance
    ));
    second
}

/// What is associated, and with what.
#[derive(Clone, Copy)]
struct Part<'a> {
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    model: &'a Model,
    joints: &'a Joints<'a>,
    /// The geometry of the boundary faces.
    sides: &'a [Side],
}

fn infer_within(part: Part<'_>, tolerance: &Tolerance, before: Option<&Before>) -> Inference {
    let Part { mesh, boundary, model, joints, sides } = part;
    let incidence = Incidence::new(mesh, boundary, model, joints, tolerance);
    let along = incidence.along(mesh, boundary, model);
    let decided = faces::decide(part, &incidence, &along, before);
    let (classifications, mut doubts) = smooth_groups::join(boundary, model, joints, &incidence, sides, decided);
    near::find(model, boundary, mesh, sides, &classifications, &mut doubts);
    let mut candidates = Candidates {
        trusted: true,
        teller: Teller::Geometry,
        sheets: faces::sheets(mesh, boundary, &classifications),
        ..Candidates::default()
    };
    let strings = edges::strings(boundary, model, joints, &along, &classifications);
    candidates.points = edges::points(boundary, model, &incidence, &strings);
    candidates.strings = strings.candidates;
    Inference { candidates, faces: doubts, edges: strings.doubts }
}
