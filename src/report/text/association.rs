//! An association of mesh and CAD in words.

use std::fmt::{self, Display};

use super::{LISTED, patch, position};
use crate::associate::Summary;

impl Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "association by {}", self.source)?;
        let heads = ["patch", "faces", "undecided", "off the CAD", "CAD distance", "CAD faces"];
        let [name, faces, undecided, off, distance, on] = heads;
        writeln!(f, "{name:<24}{faces:>9}{undecided:>11}{off:>13}{distance:>14}  {on}")?;
        for p in &self.patches {
            let on: Vec<String> = p.cad_faces.iter().map(|(target, count)| format!("{target} ({count})")).collect();
            let on = if on.is_empty() { "none".to_owned() } else { on.join("; ") };
            let (name, distance) = (patch(&p.names, &p.entity), p.cad_distance_max);
            writeln!(f, "{name:<24}{:>9}{:>11}{:>13}{distance:>14.2e}  {on}", p.faces, p.undecided, p.off_cad)?;
        }
        write!(f, "{} mesh edges on CAD edges, {} nodes at CAD vertices", self.edges, self.points)?;
        for item in self.undecided.iter().take(LISTED) {
            let (kind, nodes, at, reason) = (item.kind, &item.nodes, position(item.position), &item.reason);
            write!(f, "\nundecided: {kind} with nodes {nodes:?} near {at}: {reason}")?;
        }
        let more = self.undecided.len().saturating_sub(LISTED);
        if more > 0 {
            write!(f, "\nundecided: {more} more (--report lists them)")?;
        }
        self.notes.iter().try_for_each(|note| write!(f, "\nnote: {note}"))
    }
}
