//! The report of a mesh that was only certified.

use std::path::Path;

use glam::DVec3;
use schemars::JsonSchema;
use serde::Serialize;

use super::certificate::CertificateReport;
use super::measures::{LowElement, MeasureReport, lowest, spread};
use super::run::{Run, Units};
#[cfg(feature = "cad")]
use crate::associate::Summary;
use crate::certify::{Certificate, Tally};
use crate::element::Cell;
use crate::mesh::{Mesh, Plane, Skin};
use crate::scene::Measures;

/// Name and version of the JSON document.
pub const SCHEMA: &str = "sagitta-check-2";

/// The certificate of a mesh file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CheckReport {
    /// Name and version of this document.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// When it was made, by which command, and how that ended.
    pub run: Run,
    /// The units of its numbers.
    pub units: Units,
    /// The file.
    pub mesh: String,
    /// Polynomial order.
    pub order: u8,
    /// Whether every element is proven valid.
    pub certified: bool,
    /// By kind of cell: how many, and how many are valid, invalid, undecided.
    pub cells: Vec<CellCounts>,
    /// Minima and the elements that have them.
    pub certificate: CertificateReport,
    /// The measures of the elements, by kind of cell; empty where they were not asked for.
    pub measures: Vec<MeasureReport>,
    /// The 50 elements with the smallest J / J_c, worst first; empty where measures were not asked for.
    pub lowest: Vec<LowElement>,
    /// What lies on which CAD, and where that leaves little room; only where CAD is given.
    #[cfg(feature = "cad")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub association: Option<Summary>,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// Verdicts on the elements of one kind.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
#[allow(missing_docs)] // the names say it
pub struct CellCounts {
    pub cell: &'static str,
    pub count: usize,
    pub valid: usize,
    pub invalid: usize,
    pub undecided: usize,
}

impl CheckReport {
    /// The report of a mesh file's certificate, and of the measures of its elements where they are taken.
    #[must_use]
    pub fn new(path: &Path, mesh: &Mesh, certificate: &Certificate, measures: &Measures, run: Run) -> CheckReport {
        let counts = |(cell, tally): (Cell, &Tally)| CellCounts {
            cell: cell.name(),
            count: tally.elements,
            valid: tally.valid,
            invalid: tally.invalid,
            undecided: tally.undecided,
        };
        CheckReport {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            run,
            units: Units::with_length(None),
            mesh: path.display().to_string(),
            order: mesh.order().into(),
            certified: certificate.holds(),
            cells: certificate.tallies().map(counts).collect(),
            certificate: CertificateReport::new(mesh, certificate),
            measures: spread(mesh, measures),
            lowest: lowest(mesh, measures),
            #[cfg(feature = "cad")]
            association: None,
            notes: certificate.normal.into_iter().filter_map(orientation).chain(Skin::of(mesh).notes(mesh)).collect(),
        }
    }
}

/// The orientation of a plane mesh, where it is not the usual one.
fn orientation(normal: DVec3) -> Option<String> {
    let plane = Plane { point: DVec3::ZERO, normal };
    let largest = normal.abs().max_position();
    (!plane.is_along_axis()).then(|| {
        // What rounds to zero has no sign.
        let [x, y, z] = normal.to_array().map(|x| if x.abs() < 5e-7 { 0.0 } else { x });
        format!(
            "most cells are numbered clockwise as seen from +{}; all are judged against the normal ({x:.6}, {y:.6}, {z:.6})",
            ["x", "y", "z"][largest]
        )
    })
}
