//! Which patches are curved, where the user chooses.

use std::collections::{BTreeMap, BTreeSet};

use super::Candidates;
use crate::mesh::{Boundary, EntityKey, Mesh};

/// Patches by name: a physical name, `surface 3`, or `3`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// All that are associated with the CAD.
    #[default]
    All,
    /// Of those, these only.
    Curve(Vec<String>),
    /// Of those, all but these.
    Straight(Vec<String>),
}

/// A name that no patch has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no boundary patch is called {name:?}; {meant}there are: {known}")]
pub struct UnknownPatch {
    name: String,
    /// The name that is most like it, as a question.
    meant: String,
    known: String,
}

/// Names that are less alike than this, by Jaro and Winkler (0 to 1), are no slips of the pen.
const ALIKE: f64 = 0.8;

impl UnknownPatch {
    fn new(name: &str, all: &BTreeSet<EntityKey>, mesh: &Mesh) -> UnknownPatch {
        let mut entities: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for &entity in all {
            let mut names = mesh.names_of(entity);
            if names.is_empty() {
                names.push(String::new());
            }
            names.into_iter().for_each(|own| entities.entry(own).or_default().push(entity.to_string()));
        }
        let likeness = |own: &String| strsim::jaro_winkler(&own.to_lowercase(), &name.to_lowercase());
        let nearest = entities.keys().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
        let meant = nearest.filter(|own| likeness(own) >= ALIKE);
        let known = entities.iter().map(|(own, on)| {
            let on = on.join(", ");
            if own.is_empty() { on } else { format!("{own} ({on})") }
        });
        let meant = meant.map_or_else(String::new, |own| format!("did you mean {own:?}? "));
        UnknownPatch { name: name.to_owned(), meant, known: known.collect::<Vec<_>>().join(", ") }
    }
}

impl Choice {
    /// The patches that are to stay straight.
    ///
    /// # Errors
    /// [`UnknownPatch`].
    pub fn straight(&self, mesh: &Mesh, boundary: &Boundary) -> Result<BTreeSet<EntityKey>, UnknownPatch> {
        let all: BTreeSet<EntityKey> = boundary.faces.iter().map(|face| face.entity).collect();
        let find = |names: &[String]| -> Result<BTreeSet<EntityKey>, UnknownPatch> {
            let mut found = BTreeSet::new();
            for name in names {
                let called = |entity: &&EntityKey| {
                    mesh.names_of(**entity).contains(name)
                        || entity.to_string() == *name
                        || entity.tag.to_string() == *name
                };
                let before = found.len();
                found.extend(all.iter().filter(called));
                if found.len() == before && !all.iter().any(|entity| called(&entity)) {
                    return Err(UnknownPatch::new(name, &all, mesh));
                }
            }
            Ok(found)
        };
        Ok(match self {
            Choice::All => BTreeSet::new(),
            Choice::Curve(names) => &all - &find(names)?,
            Choice::Straight(names) => find(names)?,
        })
    }
}

impl Candidates {
    /// Strikes out what is said of the faces of these patches, and of edges that have no other faces.
    pub fn leave_straight(&mut self, boundary: &Boundary, patches: &BTreeSet<EntityKey>) {
        if patches.is_empty() {
            return;
        }
        let stays = |face: usize| patches.contains(&boundary.faces[face].entity);
        for sheet in &mut self.sheets {
            sheet.items.retain(|&face| !stays(face));
        }
        self.sheets.retain(|sheet| !sheet.items.is_empty());
        for string in &mut self.strings {
            string.items.retain(|&ends| {
                boundary.edge(ends).is_none_or(|edge| !boundary.edge_faces[edge].iter().all(|&face| stays(face)))
            });
        }
        self.strings.retain(|string| !string.items.is_empty());
    }
}
