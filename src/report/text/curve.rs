//! A curved mesh in words: tables of its cells and patches, what was not done, and what is proven.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::fmt::{self, Display};

use glam::DVec3;

use super::{LISTED, certificate, number, patch, position};
use crate::report::Report;
use crate::report::curve::{PatchReport, PlaneReport, WallVerdict};

impl Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (order, nodes) = (self.order, self.nodes);
        writeln!(f, "{} -> P{order}: {} nodes ({} in the linear mesh)", self.input.mesh, nodes.curved, nodes.linear)?;
        if let Some(plane) = &self.plane {
            let PlaneReport { walls, curves, .. } = plane;
            writeln!(f, "plane mesh at {}, {walls} walls on {curves} curves", equation(plane))?;
        }
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
        self.off_cad(f)?;
        self.open_faces(f)?;
        self.walls(f)?;
        certificate(&self.certificate, self.certified, f)
    }
}

/// The plane of a mesh in words: `z = 0`.
fn equation(plane: &PlaneReport) -> String {
    let (normal, point) = (DVec3::from(plane.normal), DVec3::from(plane.point));
    let height = normal.dot(point);
    for (name, axis) in [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)] {
        if normal.dot(axis).abs() == 1.0 {
            return format!("{name} = {}", height * normal.dot(axis) + 0.0);
        }
    }
    format!("{:.6} x + {:.6} y + {:.6} z = {height:.6}", normal.x, normal.y, normal.z)
}

impl Report {
    /// What bounds its cells.
    fn side(&self) -> &'static str {
        if self.plane.is_some() { "edge" } else { "face" }
    }

    fn cells(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let heads = ["cell", "count", "straight", "C_WCN min", "mean", "C_JAC min", "J/Jc >=", "valid"];
        let [cell, count, straight, wcn, mean, jac, proven, valid] = heads;
        writeln!(f, "{cell:<10}{count:>10}{straight:>10}{wcn:>12}{mean:>9}{jac:>12}{proven:>10}{valid:>10}")?;
        for c in &self.cells {
            let (min, mean, jac, proven) = (c.c_wcn_min, c.c_wcn_mean, c.c_jac_min, number(c.j_over_jc_min));
            write!(f, "{:<10}{:>10}{:>10}", c.cell, c.count, c.straight)?;
            writeln!(f, "{min:>12.4}{mean:>9.4}{jac:>12.4}{proven:>10}{:>10}", c.valid)?;
        }
        Ok(())
    }

    fn patches(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [faces, groups] = if self.plane.is_some() { ["edges", "CAD edges"] } else { ["faces", "CAD faces"] };
        let [name, distance, moved] = ["patch", "CAD distance", "node move"];
        writeln!(f, "{name:<24}{faces:>9}{distance:>14}{moved:>11}  {groups}")?;
        for p in &self.patches {
            let distance = p.cad_distance_max.map_or("-".to_owned(), |d| format!("{d:.2e}"));
            let groups = if p.cad_groups.is_empty() { "none".to_owned() } else { p.cad_groups.join("; ") };
            let (name, moved) = (patch(&p.names, &p.entity), p.node_move_max);
            writeln!(f, "{name:<24}{:>9}{distance:>14}{moved:>11.2e}  {groups}", p.faces)?;
        }
        let far = |p: &PatchReport| p.cad_distance_max.map_or(f64::NEG_INFINITY, |far| far);
        if let Some(farthest) = self.patches.iter().max_by(|a, b| far(a).total_cmp(&far(b)))
            && let Some(distance) = farthest.cad_distance_max
        {
            let unit = if self.input.cad_scale == 1.0 { format!(" {}", self.input.cad_unit) } else { String::new() };
            writeln!(f, "farthest from the CAD: {distance:.2e}{unit}, {}", patch(&farthest.names, &farthest.entity))?;
        }
        if self.faces_without_cad > 0 {
            writeln!(f, "{} boundary {}s are not associated with the CAD", self.faces_without_cad, self.side())?;
        }
        Ok(())
    }

    fn work(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let s = &self.smoothing;
        let stopped = if s.stopped { ", stopped early" } else { "" };
        for l in &s.lower_orders {
            let (sweeps, wcn, jac) = (l.sweeps, l.end.c_wcn, l.end.c_jac);
            writeln!(f, "smoothing at P{}: {sweeps} sweeps; min C_WCN {wcn:.4}, min C_JAC {jac:.4}", l.order)?;
        }
        writeln!(
            f,
            "smoothing: {} sweeps{stopped}; min C_WCN {:.4} -> {:.4}, min C_JAC {:.4} -> {:.4}, inverted {} -> {}",
            s.sweeps, s.start.c_wcn, s.end.c_wcn, s.start.c_jac, s.end.c_jac, s.start.inverted, s.end.inverted
        )?;
        let p = &self.projections;
        writeln!(f, "closest points on the CAD: {} ({} not proven to be the closest)", p.count, p.unproven)?;
        let steps: Vec<String> = self.seconds.iter().map(|s| format!("{} {:.2}", s.step, s.seconds)).collect();
        write!(f, "seconds: {}; {} threads", steps.join(", "), self.threads)?;
        match self.peak_memory {
            Some(bytes) => writeln!(f, ", peak memory {:.0} MB", bytes as f64 / 1e6),
            None => writeln!(f),
        }
    }

    fn grid_line_angles(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (curved, linear) = (&self.grid_line_angles.curved, &self.grid_line_angles.linear);
        if curved.angles == 0 {
            return Ok(());
        }
        writeln!(
            f,
            "grid-line angles off the walls, in degrees: 99 % of {} are at most {:.2}, largest {:.2} (linear mesh: {:.2}, {:.2})",
            curved.angles, curved.p99, curved.max, linear.p99, linear.max
        )
    }

    fn off_cad(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.off_cad.is_empty() {
            return Ok(());
        }
        let side = self.side();
        writeln!(f, "off the CAD: {} boundary {side}s, so that all elements are valid", self.off_cad.len())?;
        for face in self.off_cad.iter().take(LISTED) {
            let way = match (face.order, face.fraction) {
                (Some(order), Some(fraction)) => {
                    let base =
                        if order == 1 { format!("the straight {side}") } else { format!("the {side} of P{order}") };
                    format!("{:.0} % of the way from {base} to the CAD", 100.0 * fraction)
                }
                _ => "released".to_owned(),
            };
            let far = match (face.node_distance, face.cad_distance) {
                (Some(nodes), Some(face)) => format!("nodes up to {nodes:.2e} off, the {side} {face:.2e}, "),
                _ => String::new(),
            };
            let (element, entity, at) = (face.element, &face.entity, position(face.position));
            writeln!(f, "  {side} {element} of {entity}: {far}{way}, near {at}")?;
        }
        Ok(())
    }

    fn open_faces(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.open_faces.is_empty() {
            return Ok(());
        }
        let side = self.side();
        writeln!(f, "open: {} boundary {side}s belong to the CAD and stay straight", self.open_faces.len())?;
        for face in self.open_faces.iter().take(LISTED) {
            let (entity, nodes, at, cause) = (&face.entity, &face.nodes, position(face.position), &face.cause);
            writeln!(f, "  {side} of {entity} with nodes {nodes:?} near {at}: {cause}")?;
        }
        let more = self.open_faces.len().saturating_sub(LISTED);
        if more > 0 {
            writeln!(f, "  {more} more (--report lists them)")?;
        }
        let farthest = self
            .open_faces
            .iter()
            .max_by(|a, b| a.cad_distance.partial_cmp(&b.cad_distance).unwrap_or(Ordering::Equal));
        let others = self.open_faces.iter().filter(|face| face.cad_distance.is_none());
        let remedies: BTreeSet<&String> = farthest.into_iter().chain(others).map(|face| &face.remedy).collect();
        remedies.into_iter().try_for_each(|remedy| writeln!(f, "  remedy: {remedy}"))
    }

    fn walls(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (w, side) = (&self.walls, self.side());
        if w.failures.is_empty() {
            return writeln!(f, "walls: none of {} {side}s folds (proven)", w.faces);
        }
        writeln!(f, "walls: {} of {} {side}s FOLD, {} are undecided", w.folded, w.faces, w.undecided)?;
        for face in w.failures.iter().take(LISTED) {
            let verdict = match face.verdict {
                WallVerdict::Folded => "folded",
                WallVerdict::Undecided => "undecided",
            };
            writeln!(f, "  {verdict} {side} {} of {} near {}", face.element, face.entity, position(face.position))?;
        }
        Ok(())
    }
}
