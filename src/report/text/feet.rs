//! Projected points in words.

use std::collections::BTreeMap;
use std::fmt::{self, Display};

use crate::report::FeetReport;

impl Display for FeetReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cad = &self.cad;
        let (path, format, unit) = (&cad.path, &cad.format, &cad.unit);
        writeln!(f, "{path}: {format}, unit {unit}, scale {}, bounding-box diagonal {:.6}", cad.scale, cad.diagonal)?;
        write!(f, "{} points on {} entities: mean distance {:.6e}", self.points, self.entities, self.mean_distance)?;
        if let Some(farthest) = self.farthest {
            write!(f, ", largest {:.6e} (point {})", farthest.distance, farthest.point)?;
        }
        writeln!(f, "\nsearches ended: {}", counts(&self.feet_by_end))?;
        write!(f, "proven to be the closest: {}, not proven: {}", self.proven, self.unproven)?;
        if !self.unproven_by_reason.is_empty() {
            write!(f, " ({})", counts(&self.unproven_by_reason))?;
        }
        for note in &self.notes {
            write!(f, "\nnote: {note}")?;
        }
        write!(f, "\nseconds: {:.3} on {} threads", self.seconds, self.threads)
    }
}

fn counts(map: &BTreeMap<impl Display, usize>) -> String {
    map.iter().map(|(what, count)| format!("{count} {what}")).collect::<Vec<_>>().join(", ")
}
