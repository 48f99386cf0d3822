//! What is asked of a curving.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use crate::associate::Choice;
use crate::element::Order;
use crate::smooth;

/// What is asked of a curving, whether its mesh and CAD come from files or from memory.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Which patches are curved.
    pub patches: Choice,
    /// Whether the mesh is one of faces on the CAD's surfaces, without a volume.
    pub surface: bool,
    /// Order of the curved mesh, 2 to 4.
    pub order: Order,
    /// Whether the mesh's entity tags may be the CAD's numbers. Default true.
    pub by_tags: bool,
    /// How far a node may be from its CAD entity where geometry decides, in the mesh's unit; `None` takes what mesh and CAD allow.
    pub tolerance: Option<f64>,
    /// How far a linear node may be from its CAD entity; fraction of the diagonal of the mesh's bounding box. Default 1e-3.
    pub max_offset: f64,
    /// Keep all linear nodes where they are.
    pub freeze_linear: bool,
    /// Keep nodes on curved walls where projection put them.
    pub freeze_walls: bool,
    /// Begin at the order itself, not at the curved mesh of the order below.
    pub direct: bool,
    /// Layers of elements off curved walls that may be curved; `None` leaves it to the walls' displacement.
    pub curve_layers: Option<NonZeroUsize>,
    /// Least costs, `C_WCN` and `C_JAC`, 0 to 1, for which wall faces stay on the CAD: where smoothing leaves an element below, the wall
    /// nodes that make it so may leave the CAD. Default 0.1.
    pub floor: f64,
    /// The smoother's settings.
    pub smoothing: smooth::Settings,
    /// A checkpoint file to go on from.
    pub resume: Option<PathBuf>,
}

impl Settings {
    /// The default settings for an order.
    #[must_use]
    pub fn new(order: Order) -> Settings {
        Settings {
            patches: Choice::All,
            surface: false,
            order,
            by_tags: true,
            tolerance: None,
            max_offset: 1e-3,
            freeze_linear: false,
            freeze_walls: false,
            direct: false,
            curve_layers: None,
            floor: 0.1,
            smoothing: smooth::Settings::default(),
            resume: None,
        }
    }

    /// Whatever a checkpoint depends on beside the mesh and its boundary.
    pub(crate) fn fingerprint(&self) -> String {
        let smooth::Settings { threshold, alpha, max_sweeps: _, survey_factor, engine } = &self.smoothing;
        let held = (self.freeze_linear, self.freeze_walls, self.curve_layers, self.direct, self.floor);
        format!("{:?}", (threshold, alpha, survey_factor, engine, held))
    }
}
