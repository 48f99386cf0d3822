//! The report as a table for people.

use std::fmt;

use super::Report;

/// Failures that are listed.
const LISTED: usize = 10;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} -> P{}: {} nodes of {} linear ones",
            self.input.mesh, self.order, self.nodes.curved, self.nodes.linear
        )?;
        writeln!(f)?;
        self.cells(f)?;
        writeln!(f)?;
        self.patches(f)?;
        writeln!(f)?;
        self.work(f)?;
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        self.grid_line_angles(f)?;
        self.given_up(f)?;
        self.walls(f)?;
        self.certificate.verdict(self.certified, f)
    }
}

impl Report {
    fn cells(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let heads = ["cell", "count", "straight", "C_WCN min", "mean", "C_JAC min", "J/Jc proven", "valid"];
        let [cell, count, straight, wcn, mean, jac, proven, valid] = heads;
        writeln!(f, "{cell:<10}{count:>10}{straight:>10}{wcn:>12}{mean:>9}{jac:>12}{proven:>14}{valid:>10}")?;
        for c in &self.cells {
            let (min, mean, jac, proven) = (c.c_wcn_min, c.c_wcn_mean, c.c_jac_min, c.certified_min);
            write!(f, "{:<10}{:>10}{:>10}", c.cell, c.count, c.straight)?;
            writeln!(f, "{min:>12.4}{mean:>9.4}{jac:>12.4}{proven:>14.4}{:>10}", c.valid)?;
        }
        Ok(())
    }

    fn patches(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [patch, faces, off, offset, on] = ["patch", "faces", "off CAD", "node offset", "CAD group"];
        writeln!(f, "{patch:<24}{faces:>9}{off:>12}{offset:>13}  {on}")?;
        for p in &self.patches {
            let name =
                if p.names.is_empty() { p.entity.clone() } else { format!("{} {}", p.names.join(","), p.entity) };
            let far = p.farthest.map_or("-".to_owned(), |d| format!("{d:.2e}"));
            let on = if p.surfaces.is_empty() { "not tied".to_owned() } else { p.surfaces.join("; ") };
            writeln!(f, "{name:<24}{:>9}{far:>12}{:>13.2e}  {on}", p.faces, p.largest_offset)?;
        }
        if self.unlinked_faces > 0 {
            writeln!(f, "{} boundary faces are not tied to the CAD", self.unlinked_faces)?;
        }
        Ok(())
    }

    fn grid_line_angles(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (curved, linear) = (&self.grid_line_angles.curved, &self.grid_line_angles.linear);
        if curved.angles == 0 {
            return Ok(());
        }
        writeln!(
            f,
            "grid-line angles off the walls, in degrees: {:.2} at most in 99 % of {}, largest {:.2} (linear mesh: {:.2}, {:.2})",
            curved.p99, curved.angles, curved.max, linear.p99, linear.max
        )
    }

    fn walls(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let w = &self.walls;
        if w.failures.is_empty() {
            return writeln!(f, "walls: none of {} faces folds (proven)", w.faces);
        }
        writeln!(f, "walls: {} of {} faces FOLD, {} are undecided", w.folded, w.faces, w.undecided)?;
        for face in w.failures.iter().take(LISTED) {
            let [x, y, z] = face.place;
            writeln!(f, "  {} face {} of {} near ({x:.6}, {y:.6}, {z:.6})", face.verdict, face.element, face.entity)?;
        }
        Ok(())
    }

    fn given_up(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.given_up.is_empty() {
            return Ok(());
        }
        writeln!(
            f,
            "given up: {} boundary faces are not on the CAD, so that all elements are valid",
            self.given_up.len()
        )?;
        for face in self.given_up.iter().take(LISTED) {
            let [x, y, z] = face.place;
            let percent = 100.0 * face.share;
            let kept = match face.order {
                1 => format!("{percent:.0} % of its curve"),
                order => format!("its curve of P{order}, and {percent:.0} % of the way to that of P{}", self.order),
            };
            writeln!(f, "  face {} of {}: {kept}, near ({x:.6}, {y:.6}, {z:.6})", face.element, face.entity)?;
        }
        Ok(())
    }

    fn work(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = &self.smoothing;
        let stopped = if s.stopped { ", stopped early" } else { "" };
        for l in &s.lower_orders {
            writeln!(
                f,
                "smoothing at {}: {} sweeps; min C_WCN {:.4}, min C_JAC {:.4}",
                l.order, l.sweeps, l.end.c_wcn, l.end.c_jac
            )?;
        }
        writeln!(
            f,
            "smoothing: {} sweeps{stopped}; min C_WCN {:.4} -> {:.4}, min C_JAC {:.4} -> {:.4}, inverted {} -> {}",
            s.sweeps, s.start.c_wcn, s.end.c_wcn, s.start.c_jac, s.end.c_jac, s.start.inverted, s.end.inverted
        )?;
        let p = &self.projections;
        writeln!(f, "projections: {} ({} not proven to be the closest)", p.count, p.unproven)?;
        let steps: Vec<String> = self.seconds.iter().map(|s| format!("{} {:.2}", s.step, s.seconds)).collect();
        let memory = self.peak_memory as f64 / 1e6;
        writeln!(f, "seconds: {}; {} threads, peak memory {memory:.0} MB", steps.join(", "), self.threads)
    }
}
