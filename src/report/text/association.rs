//! An association of mesh and CAD in words.

use std::fmt::{self, Display};

use super::{LISTED, patch, patch_row, position};
use crate::associate::Summary;

impl Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "association by {}", self.source)?;
        let [faces, on] = if self.in_plane { ["edges", "CAD edges"] } else { ["faces", "CAD faces"] };
        let [name, undecided, off, distance] = ["patch", "undecided", "off CAD", "distance"];
        writeln!(f, "{name:<24}{faces:>9}{undecided:>11}{off:>9}{distance:>11}  {on}")?;
        for p in &self.patches {
            let on: Vec<String> = p.cad_faces.iter().map(|(target, count)| format!("{target} ({count})")).collect();
            let figures = format!("{:>9}{:>11}{:>9}{:>11.2e}", p.faces, p.undecided, p.off_cad, p.cad_distance_max);
            patch_row(&patch(&p.names, &p.entity), &figures, &on, f)?;
        }
        write!(f, "{} mesh edges on CAD edges, {} nodes at CAD vertices", self.edges, self.points)?;
        for item in self.undecided.iter().take(LISTED) {
            let (kind, nodes, at, reason) = (item.kind, &item.nodes, position(item.position), &item.reason);
            write!(f, "\nundecided: {kind} with nodes {nodes:?} near {at}\n  {reason}")?;
        }
        let more = self.undecided.len().saturating_sub(LISTED);
        if more > 0 {
            write!(f, "\nundecided: {more} more (--report lists them)")?;
        }
        self.spots(f)?;
        self.notes.iter().try_for_each(|note| write!(f, "\nnote: {note}"))
    }
}

impl Summary {
    fn spots(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.spots.is_empty() {
            return Ok(());
        }
        let impossible = self.spots.iter().filter(|spot| spot.impossible).count();
        let count = self.spots.len();
        write!(f, "\nlittle room: {count} places, {impossible} impossible unless wall nodes slide or leave the CAD")?;
        for spot in self.spots.iter().take(LISTED) {
            let (kind, element, at, cad) = (spot.kind, &spot.element, position(spot.position), &spot.cad);
            let node = spot.node.map_or_else(String::new, |node| format!(" at node {node}"));
            write!(f, "\n  {kind}: {element}{node} near {at}\n    on {cad}: ")?;
            match (spot.q, spot.bend, spot.squeeze) {
                (Some(q), Some(bend), _) => write!(f, "q {q:.3}, h/R {bend:.2}")?,
                (.., Some(squeeze)) => write!(f, "s {squeeze:.2}")?,
                _ => {}
            }
            write!(f, "; {}", spot.remedy)?;
        }
        let more = count.saturating_sub(LISTED);
        if more > 0 {
            write!(f, "\n  {more} more (--report lists them)")?;
        }
        Ok(())
    }
}
