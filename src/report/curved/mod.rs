//! The report of a curved mesh.

mod build;
mod text;

use serde::Serialize;

use super::CertificateReport;
use crate::curve::LowerOrder;
use crate::quality::GridLineAngles;
use crate::smooth::Summary;

pub use build::{fields, report};

/// Name and version of the JSON document.
pub const SCHEMA: &str = "sagitta-report-1";

/// A curved mesh in figures.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// The files that went in.
    pub input: Input,
    /// Polynomial order.
    pub order: u8,
    /// Whether every element is proven valid.
    pub certified: bool,
    /// Nodes of the linear and of the curved mesh.
    pub nodes: Nodes,
    /// By kind of cell.
    pub cells: Vec<CellReport>,
    /// By boundary entity of the mesh.
    pub patches: Vec<PatchReport>,
    /// Boundary faces that are tied to no CAD face.
    pub unlinked_faces: usize,
    /// Boundary faces taken off the CAD, so that the elements behind them are valid.
    pub given_up: Vec<GivenUpFace>,
    /// Whether the faces on the CAD are free of folds.
    pub walls: WallReport,
    /// Angles at which grid lines off the wall bend from layer to layer.
    pub grid_line_angles: GridLinesReport,
    /// Bounds of the mesh's smallest J / J_c and scaled Jacobian.
    pub certificate: CertificateReport,
    /// What the smoother did.
    pub smoothing: SmoothingReport,
    /// Closest points asked of the CAD, and how many of them are not proven to be the closest.
    pub projections: Projections,
    /// What a user should know.
    pub notes: Vec<String>,
    /// Seconds a step.
    pub seconds: Vec<StepReport>,
    /// Largest resident memory of the process so far; 0 where the system does not tell.
    pub peak_memory: u64,
    /// Threads that worked.
    pub threads: usize,
}

/// Paths as given.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)] // the names say it
pub struct Input {
    pub mesh: String,
    pub cad: String,
    pub linkage: Option<String>,
    /// The CAD file's unit, as it names it.
    pub cad_unit: String,
    /// What the CAD was multiplied by.
    pub cad_scale: f64,
}

/// Counts of nodes.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs)] // the names say it
pub struct Nodes {
    pub linear: usize,
    pub curved: usize,
}

/// Elements of one kind.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct CellReport {
    /// `tet`, `pyramid`, `prism` or `hex`.
    pub cell: &'static str,
    /// How many.
    pub count: usize,
    /// How many of them no displacement reaches: they are written at the mesh's order, and straight.
    pub straight: usize,
    /// Smallest `C_WCN` of their sub-elements (eqs 3-5).
    pub c_wcn_min: f64,
    /// Mean `C_WCN` of their sub-elements.
    pub c_wcn_mean: f64,
    /// Smallest `C_JAC` (eq. 6) at the closing survey.
    pub c_jac_min: f64,
    /// Proven lower bound of their J / J_c.
    pub certified_min: f64,
    /// Elements proven valid.
    pub valid: usize,
    /// Elements proven invalid.
    pub invalid: usize,
    /// Elements of which neither is proven.
    pub undecided: usize,
}

/// Boundary elements of one entity of the mesh file.
#[derive(Clone, Debug, Serialize)]
pub struct PatchReport {
    /// The entity.
    pub entity: String,
    /// Its physical names.
    pub names: Vec<String>,
    /// The CAD groups that its faces lie on; empty where it is not tied to the CAD.
    pub surfaces: Vec<String>,
    /// Number of faces.
    pub faces: usize,
    /// Farthest point of its curved faces from the CAD, at (3p)^2 samples a face; nothing where it is not tied to the CAD.
    pub farthest: Option<f64>,
    /// Largest move of a linear node onto the CAD.
    pub largest_offset: f64,
}

/// A boundary face that is not on the CAD as it should be.
#[derive(Clone, Debug, Serialize)]
pub struct GivenUpFace {
    /// Its number in the file.
    pub element: u64,
    /// The mesh entity that it belongs to.
    pub entity: String,
    /// What it went back to: order 1 is the straight face, a higher one the face curved at that order.
    pub order: usize,
    /// The share of its displacement from there that is left, 0 to 1.
    pub share: f64,
    /// Its middle.
    pub place: [f64; 3],
}

/// Curved faces on the CAD: folded where the normal leans by 90 degrees or more against the linear face's, and the face is no graph
/// over another plane on the CAD's side.
#[derive(Clone, Debug, Serialize)]
pub struct WallReport {
    /// How many.
    pub faces: usize,
    /// Faces proven to be free of folds.
    pub valid: usize,
    /// Faces proven to fold.
    pub folded: usize,
    /// Faces of which neither is proven.
    pub undecided: usize,
    /// All faces that are not proven to be free of folds.
    pub failures: Vec<WallFailure>,
}

/// A face to look at.
#[derive(Clone, Debug, Serialize)]
pub struct WallFailure {
    /// Its number in the file.
    pub element: u64,
    /// The mesh entity that it belongs to.
    pub entity: String,
    /// `folded` or `undecided`.
    pub verdict: &'static str,
    /// A point of the fold.
    pub place: [f64; 3],
}

/// Grid-line angles ([`crate::quality::GridLines`]).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct GridLinesReport {
    /// Of the curved mesh, between the tangents of its edges.
    pub curved: GridLineAngles,
    /// Of the same grid lines in the linear mesh.
    pub linear: GridLineAngles,
}

/// What the smoother did.
#[derive(Clone, Debug, Serialize)]
pub struct SmoothingReport {
    /// What was done at the orders below.
    pub lower_orders: Vec<LowerOrder>,
    /// Sweeps over the active nodes.
    pub sweeps: usize,
    /// Whether it was ended before it was done.
    pub stopped: bool,
    /// Smallest costs after perturbation.
    pub start: Summary,
    /// Smallest costs at the end.
    pub end: Summary,
}

/// Counts of closest points.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs)] // the names say it
pub struct Projections {
    pub count: usize,
    pub unproven: usize,
}

/// Time of a step.
#[derive(Clone, Copy, Debug, Serialize)]
#[allow(missing_docs)] // the names say it
pub struct StepReport {
    pub step: &'static str,
    pub seconds: f64,
}
