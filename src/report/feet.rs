//! The report of projected points, and of the CAD that they were projected on.

use std::collections::BTreeMap;

use cad::{Foot, Model};
use schemars::JsonSchema;
use serde::Serialize;

use super::run::Units;

/// Name and version of the JSON document.
pub const SCHEMA: &str = "sagitta-feet-2";

/// The feet of a list of points, in figures. Lengths are in the unit of the CAD file, times `scale`.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct FeetReport {
    /// Name and version of this document.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// Version of the program.
    pub version: &'static str,
    /// The units of its numbers.
    pub units: Units,
    /// The CAD.
    pub cad: CadReport,
    /// References that made the group, as given; empty where all of the CAD is meant.
    pub group: Vec<String>,
    /// The number of entities in the group.
    pub entities: usize,
    /// Points that were projected.
    pub points: usize,
    /// Feet that are proven to be the closest point of the group.
    pub proven: usize,
    /// Feet that are not.
    pub unproven: usize,
    /// Number of these for each reason.
    pub unproven_by_reason: BTreeMap<String, usize>,
    /// Number of feet for each way the search ended.
    pub feet_by_end: BTreeMap<&'static str, usize>,
    /// Number of feet on each entity.
    pub feet_by_entity: BTreeMap<String, usize>,
    /// Mean distance of the points from their feet.
    pub mean_distance: f64,
    /// The point that is farthest from its foot; nothing where there are no points.
    pub farthest: Option<FarthestPoint>,
    /// What a user should know.
    pub notes: Vec<String>,
    /// Seconds that the projection took, without reading and writing.
    pub seconds: f64,
    /// Threads that worked.
    pub threads: usize,
}

/// A point and its distance from its foot.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct FarthestPoint {
    /// Which point it is, from 1.
    pub point: usize,
    /// Its distance.
    pub distance: f64,
}

/// A CAD file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[allow(missing_docs)] // the names say it
pub struct CadReport {
    pub path: String,
    pub format: String,
    pub unit: String,
    /// What its coordinates were multiplied by.
    pub scale: f64,
    /// Length of the diagonal of its bounding box, scaled.
    pub diagonal: f64,
}

impl CadReport {
    /// Of a model that was read with this scale.
    #[must_use]
    pub fn new(model: &Model, scale: f64) -> CadReport {
        CadReport {
            path: model.path().display().to_string(),
            format: model.format().to_string(),
            unit: model.unit().name.clone(),
            scale,
            diagonal: model.diagonal(),
        }
    }
}

/// The word for how the search for a foot ended.
#[must_use]
pub fn end_of(foot: &Foot) -> &'static str {
    match foot.end {
        cad::End::Interior => "interior",
        cad::End::OnTrim(_) => "trim",
        cad::End::OnCrease => "crease",
        cad::End::OnEnd(_) => "end",
        cad::End::Stalled { .. } => "stalled",
    }
}

impl FeetReport {
    /// Counts; the caller fills in the notes.
    #[must_use]
    pub fn new(cad: CadReport, group: &[String], entities: usize, feet: &[Option<Foot>], seconds: f64) -> FeetReport {
        let found = || feet.iter().flatten();
        let mut report = FeetReport {
            schema: SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            units: Units::with_length((cad.scale == 1.0).then(|| cad.unit.clone())),
            cad,
            group: group.to_vec(),
            entities,
            points: feet.len(),
            proven: found().filter(|foot| foot.is_proven()).count(),
            unproven: 0,
            unproven_by_reason: BTreeMap::new(),
            feet_by_end: BTreeMap::new(),
            feet_by_entity: BTreeMap::new(),
            mean_distance: found().fold(0.0, |sum, foot| sum + foot.distance) / found().count().max(1) as f64,
            farthest: None,
            notes: Vec::new(),
            seconds,
            threads: rayon::current_num_threads(),
        };
        report.unproven = report.points - report.proven;
        for (i, foot) in feet.iter().enumerate() {
            let Some(foot) = foot else {
                *report.unproven_by_reason.entry("no foot: the point is too far away".to_owned()).or_default() += 1;
                continue;
            };
            *report.feet_by_end.entry(end_of(foot)).or_default() += 1;
            *report.feet_by_entity.entry(foot.entity.to_string()).or_default() += 1;
            if let Some(doubt) = foot.doubt {
                *report.unproven_by_reason.entry(doubt.to_string()).or_default() += 1;
            }
            if report.farthest.is_none_or(|known| foot.distance > known.distance) {
                report.farthest = Some(FarthestPoint { point: i + 1, distance: foot.distance });
            }
        }
        report
    }
}
