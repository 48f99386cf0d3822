//! What is told of projected points.

use std::collections::BTreeMap;
use std::fmt;

use cad::{Foot, Model};
use serde::Serialize;

/// Name and version of the JSON document.
pub const FEET_SCHEMA: &str = "sagitta-feet-1";

/// The feet of a list of points, in figures. Lengths are in the unit of the CAD file, times `scale`.
#[derive(Clone, Debug, Serialize)]
pub struct FeetReport {
    /// [`FEET_SCHEMA`].
    pub schema: &'static str,
    /// Version of the program.
    pub version: &'static str,
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
    /// These, by the reason.
    pub doubts: BTreeMap<String, usize>,
    /// Feet by the way the search ended.
    pub ends: BTreeMap<&'static str, usize>,
    /// Feet by the entity that they lie on.
    pub feet: BTreeMap<String, usize>,
    /// Mean distance of the points from their feet.
    pub mean_distance: f64,
    /// The largest distance, and which point that is, counted from 1.
    pub largest_distance: (f64, usize),
    /// What a user should know.
    pub notes: Vec<String>,
    /// Seconds that the projection took, without reading and writing.
    pub seconds: f64,
    /// Threads that worked.
    pub threads: usize,
}

/// A CAD file.
#[derive(Clone, Debug, Serialize)]
#[allow(missing_docs)] // the names say it
pub struct CadReport {
    pub path: String,
    pub format: String,
    pub unit: String,
    /// What its coordinates were multiplied by.
    pub scale: f64,
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
    pub fn new(cad: CadReport, group: &[String], entities: usize, feet: &[Foot], seconds: f64) -> FeetReport {
        let mut report = FeetReport {
            schema: FEET_SCHEMA,
            version: env!("CARGO_PKG_VERSION"),
            cad,
            group: group.to_vec(),
            entities,
            points: feet.len(),
            proven: feet.iter().filter(|foot| foot.is_proven()).count(),
            unproven: 0,
            doubts: BTreeMap::new(),
            ends: BTreeMap::new(),
            feet: BTreeMap::new(),
            mean_distance: feet.iter().map(|foot| foot.distance).sum::<f64>() / feet.len().max(1) as f64,
            largest_distance: (0.0, 0),
            notes: Vec::new(),
            seconds,
            threads: rayon::current_num_threads(),
        };
        report.unproven = report.points - report.proven;
        for (i, foot) in feet.iter().enumerate() {
            *report.ends.entry(end_of(foot)).or_default() += 1;
            *report.feet.entry(foot.entity.to_string()).or_default() += 1;
            if let Some(doubt) = foot.doubt {
                *report.doubts.entry(doubt.to_string()).or_default() += 1;
            }
            if foot.distance > report.largest_distance.0 || i == 0 {
                report.largest_distance = (foot.distance, i + 1);
            }
        }
        report
    }
}

impl fmt::Display for FeetReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cad = &self.cad;
        writeln!(
            f,
            "{}: {}, unit {}, scale {}, {:.6} across",
            cad.path, cad.format, cad.unit, cad.scale, cad.diagonal
        )?;
        let (largest, at) = self.largest_distance;
        writeln!(
            f,
            "{} points on {} entities: mean distance {:.6e}, largest {largest:.6e} (point {at})",
            self.points, self.entities, self.mean_distance
        )?;
        let counts = |map: &mut dyn Iterator<Item = (String, usize)>| {
            map.map(|(what, count)| format!("{count} {what}")).collect::<Vec<_>>().join(", ")
        };
        writeln!(f, "ends: {}", counts(&mut self.ends.iter().map(|(end, n)| ((*end).to_owned(), *n))))?;
        write!(f, "proven to be the closest: {}, not proven: {}", self.proven, self.unproven)?;
        if !self.doubts.is_empty() {
            write!(f, " ({})", counts(&mut self.doubts.iter().map(|(doubt, n)| (doubt.clone(), *n))))?;
        }
        for note in &self.notes {
            write!(f, "\nnote: {note}")?;
        }
        write!(f, "\nseconds: {:.3} on {} threads", self.seconds, self.threads)
    }
}
