//! The entities and groups of a CAD file in words.

use std::fmt::{self, Display};

use crate::report::Groups;
use crate::report::groups::quoted;

impl Display for Groups {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let metres = self.metres_per_unit.map_or_else(String::new, |m| format!(" ({m} m)"));
        write!(f, "{}: {}, unit {}{metres}", self.path, self.format, self.unit)?;
        for (title, entities) in [("faces", &self.faces), ("edges", &self.edges), ("vertices", &self.vertices)] {
            write!(f, "\n{} {title}", entities.len())?;
            for e in entities {
                let name = if e.name.is_empty() { String::new() } else { format!("name:{}", quoted(&e.name)) };
                let (id, kind, reference, neighbours) = (&e.id, &e.kind, &e.reference, e.neighbours.join(" "));
                let line = format!("  {id:<11} {kind:<11} {reference:<16} {name:<20} {neighbours}");
                write!(f, "\n{}", line.trim_end())?;
            }
        }
        write!(f, "\n{} groups", self.groups.len())?;
        for group in &self.groups {
            write!(f, "\n  {}: {}", group.reference, group.members.join(" "))?;
        }
        self.losses.iter().try_for_each(|losses| write!(f, "\nnote: {losses}"))
    }
}
