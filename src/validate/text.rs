//! What was found, for people.

use std::fmt;

use super::{Measured, Validation};

impl fmt::Display for Validation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for finding in &self.findings {
            write!(f, "{}:", self.linkage.display())?;
            if let (Some(line), Some(column)) = (finding.line, finding.column) {
                write!(f, "{line}:{column}:")?;
            }
            writeln!(f, " {} {}: {}: {}", finding.severity, finding.code, finding.message, finding.remedy)?;
        }
        let total = self.errors + self.warnings + self.notes;
        if total > self.findings.len() {
            writeln!(f, "... and {} more of the same kinds", total - self.findings.len())?;
        }
        if !self.coverage.is_empty() {
            writeln!(f, "{:<32}{:>9}{:>9}{:>18}", "patch", "faces", "linked", "without geometry")?;
        }
        for patch in &self.coverage {
            let name = format!("{} {}", patch.names.join(","), patch.entity);
            writeln!(f, "{:<32}{:>9}{:>9}{:>18}", name.trim(), patch.faces, patch.linked, patch.without_geometry)?;
        }
        if let Some(tolerance) = self.tolerance {
            writeln!(f, "distances from the CAD, tolerance {tolerance:.2e}")?;
            writeln!(f, "{:<32}{:>9}{:>6}{:>11}  {:<30}  CAD", "what", "points", "off", "farthest", "node, at")?;
            let mut all = self.sheets.iter().chain(&self.strings).chain(&self.points);
            all.try_for_each(|measured| measured.line(f))?;
        }
        write!(f, "{}: ", self.linkage.display())?;
        match (self.errors, self.warnings, self.notes) {
            (0, 0, 0) => write!(f, "clean"),
            (0, 0, notes) => write!(f, "clean, {notes} notes"),
            (errors, warnings, notes) => write!(f, "{errors} errors, {warnings} warnings, {notes} notes"),
        }
    }
}

impl Measured {
    fn line(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.position;
        let farthest = format!("{} ({x:.4}, {y:.4}, {z:.4})", self.node);
        writeln!(
            f,
            "{:<32}{:>9}{:>6}{:>11.2e}  {farthest:<30}  {}",
            self.name, self.points, self.off_cad, self.cad_distance_max, self.cad
        )
    }
}
