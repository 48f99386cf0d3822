//! A curved mesh in words: tables of its cells and patches, what was not done, and what is proven.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::fmt::{self, Display};

use glam::DVec3;

use super::{LISTED, certificate, more, number, patch, patch_row, position};
use crate::report::Report;
use crate::report::curve::{PatchReport, PlaneReport, StepReport, WallVerdict};

/// The verdict first: valid, how good, where worst, how far from the CAD, what was not done; then the tables.
impl Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        certificate(&self.certificate, self.certified, f)?;
        let folds = !self.walls.failures.is_empty();
        if folds {
            self.walls(f)?;
        }
        self.farthest(f)?;
        self.on_cad(f)?;
        self.off_cad(f)?;
        self.open_faces(f)?;
        if !folds {
            self.walls(f)?;
        }
        let (order, nodes) = (self.order, self.nodes);
        writeln!(f, "\n{} -> P{order}: {} nodes ({} in the linear mesh)", self.input.mesh, nodes.curved, nodes.linear)?;
        if let Some(plane) = &self.plane {
            let PlaneReport { walls, curves, .. } = plane;
            writeln!(f, "plane mesh at {}, {walls} walls on {curves} curves", equation(plane))?;
        }
        writeln!(f)?;
        self.cells(f)?;
        writeln!(f)?;
        self.patches(f)?;
        writeln!(f)?;
        self.smoothing(f)?;
        writeln!(f)?;
        self.grid_line_angles(f)?;
        self.work(f)?;
        self.notes.iter().try_for_each(|note| write!(f, "\nnote: {note}"))
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
        writeln!(f, "{cell:<9}{count:>9}{straight:>10}{wcn:>11}{mean:>9}{jac:>11}{proven:>10}{valid:>9}")?;
        for c in &self.cells {
            let (min, mean, jac, proven) = (c.c_wcn_min, c.c_wcn_mean, c.c_jac_min, number(c.j_over_jc_min));
            write!(f, "{:<9}{:>9}{:>10}", c.cell, c.count, c.straight)?;
            writeln!(f, "{min:>11.4}{mean:>9.4}{jac:>11.4}{proven:>10}{:>9}", c.valid)?;
        }
        Ok(())
    }

    fn patches(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [faces, groups] = if self.plane.is_some() { ["edges", "CAD edges"] } else { ["faces", "CAD faces"] };
        let [name, distance, moved] = ["patch", "CAD distance", "node move"];
        writeln!(f, "{name:<24}{faces:>9}{distance:>14}{moved:>11}  {groups}")?;
        for p in &self.patches {
            let distance = p.cad_distance_max.map_or("-".to_owned(), |d| format!("{d:.2e}"));
            let figures = format!("{:>9}{distance:>14}{:>11.2e}", p.faces, p.node_move_max);
            patch_row(&patch(&p.names, &p.entity), &figures, &p.cad_groups, f)?;
        }
        Ok(())
    }

    fn farthest(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let far = |p: &PatchReport| p.cad_distance_max.map_or(f64::NEG_INFINITY, |far| far);
        let Some(farthest) = self.patches.iter().max_by(|a, b| far(a).total_cmp(&far(b))) else { return Ok(()) };
        let (Some(distance), Some(at)) = (farthest.cad_distance_max, farthest.cad_distance_at) else { return Ok(()) };
        let (name, at) = (patch(&farthest.names, &farthest.entity), position(at));
        let unit = self.units.length.as_deref().map_or_else(String::new, |unit| format!(" {unit}"));
        writeln!(f, "farthest from the CAD: {distance:.2e}{unit}, {name},\n  near {at}")
    }

    /// What lies on the CAD, and what belongs to none.
    fn on_cad(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = self.side();
        let all = self.patches.iter().map(|patch| patch.faces).sum::<usize>();
        let open = self.open_faces.len();
        let on = all.saturating_sub(self.faces_without_cad + self.off_cad.len());
        writeln!(f, "on the CAD: {on} of {all} boundary {side}s")?;
        if self.faces_without_cad > open {
            writeln!(f, "{} boundary {side}s are not associated with the CAD", self.faces_without_cad)?;
        }
        if self.smoothing.stopped {
            writeln!(f, "smoothing was stopped early: the mesh may be better with more time")?;
        }
        Ok(())
    }

    fn smoothing(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let heads = ["order", "sweeps", "C_WCN min, from -> to", "C_JAC min, from -> to", "inverted"];
        let [order, sweeps, wcn, jac, inverted] = heads;
        writeln!(f, "{order:<7}{sweeps:>7}{wcn:>23}{jac:>23}{inverted:>18}")?;
        let s = &self.smoothing;
        let below = s.lower_orders.iter().map(|own| (own.order, own.sweeps, own.start, own.end));
        for (order, sweeps, start, end) in below.chain([(self.order, s.sweeps, s.start, s.end)]) {
            let wcn = format!("{:.4} -> {:.4}", start.c_wcn, end.c_wcn);
            let jac = format!("{:.4} -> {:.4}", start.c_jac, end.c_jac);
            let inverted = format!("{} -> {}", start.inverted, end.inverted);
            writeln!(f, "P{order:<6}{sweeps:>7}{wcn:>23}{jac:>23}{inverted:>18}")?;
        }
        Ok(())
    }

    fn work(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let p = &self.projections;
        writeln!(f, "closest points on the CAD: {} ({} not proven to be the closest)", p.count, p.unproven)?;
        let width = |step: &StepReport| step.step.len() + 2;
        let heads: String = self.seconds.iter().map(|own| format!("{:>1$}", own.step, width(own))).collect();
        let figures: String = self.seconds.iter().map(|own| format!("{:>1$.2}", own.seconds, width(own))).collect();
        writeln!(f, "seconds{heads}\n       {figures}")?;
        let total: f64 = self.seconds.iter().map(|own| own.seconds).sum();
        write!(f, "together {total:.2} s on {} threads", self.threads)?;
        self.peak_memory.map_or(Ok(()), |bytes| write!(f, ", peak memory {:.0} MB", bytes as f64 / 1e6))
    }

    fn grid_line_angles(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (curved, linear) = (&self.grid_line_angles.curved, &self.grid_line_angles.linear);
        if curved.angles == 0 {
            return Ok(());
        }
        let (p99, max) = (curved.p99, curved.max);
        writeln!(f, "grid-line angles: 99 % of {} are at most {p99:.2} degrees, largest {max:.2}", curved.angles)?;
        writeln!(f, "  in the linear mesh {:.2} and {:.2}", linear.p99, linear.max)
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
                    let base = if order == 1 { format!("the straight {side}") } else { format!("that of P{order}") };
                    format!("{:.0} % of the way from {base}", 100.0 * fraction)
                }
                _ => "released".to_owned(),
            };
            let far = match (face.node_distance, face.cad_distance) {
                (Some(nodes), Some(face)) => format!("{face:.2e} off, nodes up to {nodes:.2e}, "),
                _ => String::new(),
            };
            let (element, entity, at) = (face.element, &face.entity, position(face.position));
            writeln!(f, "  {side} {element} of {entity} near {at}\n    {far}{way}")?;
        }
        more(self.off_cad.len(), f)
    }

    fn open_faces(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.open_faces.is_empty() {
            return Ok(());
        }
        let side = self.side();
        writeln!(f, "open: {} boundary {side}s belong to the CAD and stay straight", self.open_faces.len())?;
        for face in self.open_faces.iter().take(LISTED) {
            let (entity, nodes, at, cause) = (&face.entity, &face.nodes, position(face.position), &face.cause);
            writeln!(f, "  {side} of {entity} with nodes {nodes:?} near {at}\n    {cause}")?;
        }
        more(self.open_faces.len(), f)?;
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
        more(w.failures.len(), f)
    }
}
