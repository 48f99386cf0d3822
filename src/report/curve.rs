//! The report of a curved mesh.

use schemars::JsonSchema;
use serde::Serialize;

use super::certificate::CertificateReport;
use super::measures::{LowElement, MeasureReport};
use super::run::{Run, Units};

/// Name and version of the JSON document.
pub const SCHEMA: &str = "sagitta-report-2";

/// A curved mesh in figures.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Report {
    /// Name and version of this document.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// When it was made, by which command, and how that ended.
    pub run: Run,
    /// The units of its numbers.
    pub units: Units,
    /// The files that went in.
    pub input: Input,
    /// Polynomial order.
    pub order: u8,
    /// What a plane mesh is; nothing of a mesh of volumes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plane: Option<PlaneReport>,
    /// Whether every element is proven valid.
    pub certified: bool,
    /// Nodes of the linear and of the curved mesh.
    pub nodes: Nodes,
    /// By kind of cell.
    pub cells: Vec<CellReport>,
    /// By boundary entity of the mesh.
    pub patches: Vec<PatchReport>,
    /// Number of boundary faces that are associated with no CAD face.
    pub faces_without_cad: usize,
    /// Boundary faces that are associated with the CAD and yet not on it, so that the elements behind them are valid.
    pub off_cad: Vec<OffCadReport>,
    /// Boundary faces that belong to the CAD and stay straight, as it could not be decided on which of its faces they lie.
    pub open_faces: Vec<OpenFaceReport>,
    /// Whether the faces on the CAD are free of folds.
    pub walls: WallReport,
    /// Angles at which grid lines off the walls bend from layer to layer.
    pub grid_line_angles: GridLinesReport,
    /// Bounds of the mesh's smallest J / J_c and scaled Jacobian, and its worst elements.
    pub certificate: CertificateReport,
    /// The measures of the elements, by kind of cell; empty where they were not asked for.
    pub measures: Vec<MeasureReport>,
    /// The 50 elements with the smallest J / J_c, worst first; empty where measures were not asked for.
    pub lowest: Vec<LowElement>,
    /// What the smoother did.
    pub smoothing: SmoothingReport,
    /// The smoothing sweep by sweep, at most 1000 of them; empty where it was not followed.
    pub sweeps: Vec<SweepReport>,
    /// Closest points asked of the CAD, and how many of them are not proven to be the closest.
    pub projections: Projections,
    /// What a user should know.
    pub notes: Vec<String>,
    /// Seconds a step, all orders together.
    pub seconds: Vec<StepReport>,
    /// Largest resident memory of the process so far; nothing where the system does not say.
    pub peak_memory: Option<u64>,
    /// Threads that worked.
    pub threads: usize,
}

/// Paths as given.
#[derive(Clone, Debug, Serialize, JsonSchema)]
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

/// A plane mesh: what is called a face of its boundary is an edge.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct PlaneReport {
    /// A point of its plane.
    pub point: [f64; 3],
    /// The unit normal that its cells turn about.
    pub normal: [f64; 3],
    /// Boundary entities of the mesh that lie on CAD edges.
    pub walls: usize,
    /// CAD edges that they lie on.
    pub curves: usize,
}

/// Counts of nodes.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
#[allow(missing_docs)] // the names say it
pub struct Nodes {
    pub linear: usize,
    pub curved: usize,
}

/// Elements of one kind.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
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
    /// Proven lower bound of their J / J_c; the least of all kinds is the certificate's. Nothing where there is no bound.
    pub j_over_jc_min: Option<f64>,
    /// Elements proven valid.
    pub valid: usize,
    /// Elements proven invalid.
    pub invalid: usize,
    /// Elements of which neither is proven.
    pub undecided: usize,
}

/// Boundary elements of one entity of the mesh file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct PatchReport {
    /// The entity.
    pub entity: String,
    /// Its physical names.
    pub names: Vec<String>,
    /// The groups of CAD faces that its faces lie on; empty where it is not associated with the CAD.
    pub cad_groups: Vec<String>,
    /// Number of faces.
    pub faces: usize,
    /// Largest distance of its curved faces from the CAD, at (3p)^2 samples a face; nothing where it is not associated with it.
    pub cad_distance_max: Option<f64>,
    /// Where that is, on the curved face.
    pub cad_distance_at: Option<[f64; 3]>,
    /// The root mean square of the distances at these samples.
    pub cad_distance_rms: Option<f64>,
    /// Largest move of a linear node onto the CAD.
    pub node_move_max: f64,
}

/// A boundary face that is associated with the CAD and yet not on it.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OffCadReport {
    /// Its number in the file.
    pub element: u64,
    /// The mesh entity that it belongs to.
    pub entity: String,
    /// Whether nodes of it were released, and moved as little as the elements behind it ask; otherwise it was taken back.
    pub released: bool,
    /// Where it was taken back: towards what. Order 1 is the straight face, a higher one the face curved at that order.
    pub order: Option<usize>,
    /// Where it was taken back: the fraction of its displacement from there that is left, 0 to 1.
    pub fraction: Option<f64>,
    /// Its largest distance from the CAD, at (3p)^2 samples: that of a curved face whose nodes all lie on the CAD is not 0 either.
    pub cad_distance: Option<f64>,
    /// The largest distance of its nodes from the CAD: what it had to leave it by.
    pub node_distance: Option<f64>,
    /// Its middle.
    pub position: [f64; 3],
}

/// A boundary face that belongs to the CAD and stays straight.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct OpenFaceReport {
    /// Its number in the file; nothing where the file has no boundary element there.
    pub element: Option<u64>,
    /// The mesh entity that it belongs to.
    pub entity: String,
    /// The numbers of its corners.
    pub nodes: Vec<u64>,
    /// Its middle.
    pub position: [f64; 3],
    /// Why it is associated with no CAD face.
    pub cause: String,
    /// Its largest distance from the CAD face that it runs beside, where that is the cause.
    pub cad_distance: Option<f64>,
    /// What can be done.
    pub remedy: String,
}

/// Curved faces on the CAD: folded where the normal leans by 90 degrees or more against the linear face's, and the face is no graph
/// over another plane on the CAD's side.
#[derive(Clone, Debug, Serialize, JsonSchema)]
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
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct WallFailure {
    /// Its number in the file.
    pub element: u64,
    /// The mesh entity that it belongs to.
    pub entity: String,
    /// What is proven of it.
    pub verdict: WallVerdict,
    /// A point of the fold.
    pub position: [f64; 3],
}

/// What is proven of a face that is not proven to be free of folds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum WallVerdict {
    /// It folds.
    Folded,
    /// Neither that it folds nor that it does not.
    Undecided,
}

/// Angles at which grid lines off the walls bend from layer to layer.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct GridLinesReport {
    /// Of the curved mesh, between the tangents of its edges.
    pub curved: Angles,
    /// Of the same grid lines in the linear mesh.
    pub linear: Angles,
}

/// Angles at the inner nodes of grid lines, in degrees.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Angles {
    /// Number of grid lines with at least one inner node.
    pub lines: usize,
    /// Number of angles: inner nodes of grid lines.
    pub angles: usize,
    /// The angle that 99 % of the angles do not exceed.
    pub p99: f64,
    /// The largest angle.
    pub max: f64,
}

/// What the smoother did.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SmoothingReport {
    /// What it did at the orders below.
    pub lower_orders: Vec<LowerOrderReport>,
    /// Sweeps over the active nodes.
    pub sweeps: usize,
    /// Whether it was ended before it was done.
    pub stopped: bool,
    /// Smallest costs after perturbation.
    pub start: Costs,
    /// Smallest costs at the end.
    pub end: Costs,
}

/// The mesh before a sweep of the smoother, or at its end.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct SweepReport {
    /// The order that is smoothed.
    pub order: usize,
    /// Sweeps at this order before.
    pub sweep: usize,
    /// Nodes that are moved; 0 at the end.
    pub active_nodes: usize,
    /// Smallest `C_WCN` of the last survey.
    pub c_wcn: Option<f64>,
    /// Smallest `C_JAC` of the last survey.
    pub c_jac: Option<f64>,
    /// Elements with a cost of 0 or less.
    pub inverted: usize,
}

/// What the smoother did at an order below the one asked for.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct LowerOrderReport {
    /// The order.
    pub order: u8,
    /// Sweeps over the active nodes.
    pub sweeps: usize,
    /// Whether it was ended before it was done; the orders between are left out then.
    pub stopped: bool,
    /// Smallest costs before the first sweep.
    pub start: Costs,
    /// Smallest costs at the end.
    pub end: Costs,
}

/// The smallest costs of a mesh.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Costs {
    /// Smallest `C_WCN`.
    pub c_wcn: f64,
    /// Smallest `C_JAC`.
    pub c_jac: f64,
    /// Elements with a cost of 0 or less.
    pub inverted: usize,
}

/// Counts of closest points.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
#[allow(missing_docs)] // the names say it
pub struct Projections {
    pub count: usize,
    pub unproven: usize,
}

/// Time of a step.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
#[allow(missing_docs)] // the names say it
pub struct StepReport {
    pub step: &'static str,
    pub seconds: f64,
}
