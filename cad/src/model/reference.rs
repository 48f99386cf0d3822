//! References to CAD entities, as linkage files and commands write them.
//!
//! | reference | meaning |
//! |---|---|
//! | `name:"WING UPPER"`, `name:WING` | the entity, or the group of the file, of that name |
//! | `group:WING` | all members of the ready group of that name: a group of the file, or faces that share the name |
//! | `step:#17`, `iges:D19` | the entity with that id in its file; an IGES 402 group |
//! | `step:#17@4/2` | that entity in instance 2 of instance 4 of an assembly; without the path where there is only one |
//! | `face:7`, `edge-12`, `vertex:3` | by number, 1-based |
//! | `faces:#17\|#137`, `faces:3\|4` | the edges that two faces share; of doubled edges between faces that are not sewn, the first |

use crate::ids::{EdgeId, EntityId, FaceId, VertexId};
use crate::model::{Edge, Model};
use std::collections::BTreeSet;
use thiserror::Error;

/// Why a reference does not lead to an entity.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ReferenceError {
    /// Not of the grammar.
    #[error(
        "{reference:?} is not a reference: expected name:NAME, group:NAME, step:#N, iges:DN, face:N, edge:N, vertex:N or faces:A|B"
    )]
    Grammar {
        /// The text.
        reference: String,
    },
    /// Nothing answers to it.
    #[error("{reference:?} refers to nothing in {model}: {hint}")]
    Unknown {
        /// The text.
        reference: String,
        /// The CAD file.
        model: String,
        /// What there is instead.
        hint: String,
    },
    /// Several entities of one kind answer to it.
    #[error("{reference:?} is ambiguous in {model}: it may be {}; take a reference that only one has, or group:NAME for all that share a name", candidates.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "))]
    Ambiguous {
        /// The text.
        reference: String,
        /// The CAD file.
        model: String,
        /// All that answer.
        candidates: Box<[EntityId]>,
    },
}

/// A name without quotes and spaces around it.
fn bare(name: &str) -> &str {
    name.trim().trim_matches('"')
}

impl Model {
    /// The entities that some references mean, each once; all faces and free edges where there are no references.
    ///
    /// # Errors
    /// Those of [`Model::resolve`].
    pub fn select(&self, references: &[String]) -> Result<Vec<EntityId>, ReferenceError> {
        if references.is_empty() {
            let free = self.edges().iter().filter(|edge| edge.faces.is_empty() && !edge.degenerate);
            return Ok(self.faces().iter().map(|face| face.id.into()).chain(free.map(|edge| edge.id.into())).collect());
        }
        let mut all = Vec::new();
        for reference in references {
            all.extend(self.resolve(reference)?);
        }
        all.sort_unstable();
        all.dedup();
        Ok(all)
    }

    /// The entities that a reference means: one, or the members of a ready group, or the edges between two faces.
    ///
    /// # Errors
    /// [`ReferenceError`]: not a reference, refers to nothing, or to several entities.
    pub fn resolve(&self, reference: &str) -> Result<Vec<EntityId>, ReferenceError> {
        let text = reference.trim();
        let grammar = || ReferenceError::Grammar { reference: reference.to_owned() };
        if let Some(name) = text.strip_prefix("name:") {
            return self.by_name(reference, bare(name));
        }
        if let Some(name) = text.strip_prefix("group:") {
            return self.by_group(reference, bare(name));
        }
        if text.starts_with("step:") || text.starts_with("iges:") {
            return self.by_origin(reference, text);
        }
        if let Some(pair) = text.strip_prefix("faces:") {
            let (a, b) = pair.split_once('|').ok_or_else(grammar)?;
            return self.between(reference, a, b);
        }
        let (kind, number) = text.split_once([':', '-']).ok_or_else(grammar)?;
        let tag: u32 = number.trim().parse().map_err(|_| grammar())?;
        let (id, count) = match kind {
            "face" => (FaceId::from_tag(tag).map(EntityId::Face), self.faces().len()),
            "edge" => (EdgeId::from_tag(tag).map(EntityId::Edge), self.edges().len()),
            "vertex" => (VertexId::from_tag(tag).map(EntityId::Vertex), self.vertices().len()),
            _ => return Err(grammar()),
        };
        let known = id.filter(|&id| self.label(id).is_some()).map(|id| vec![id]);
        known.ok_or_else(|| self.unknown(reference, format!("it has {kind}:1 to {kind}:{count}")))
    }

    fn unknown(&self, reference: &str, hint: String) -> ReferenceError {
        ReferenceError::Unknown { reference: reference.to_owned(), model: self.path().display().to_string(), hint }
    }

    fn ambiguous(&self, reference: &str, candidates: Vec<EntityId>) -> ReferenceError {
        let model = self.path().display().to_string();
        ReferenceError::Ambiguous { reference: reference.to_owned(), model, candidates: candidates.into() }
    }

    /// Entities of every kind with their labels.
    fn labelled(&self) -> impl Iterator<Item = (EntityId, &crate::Label)> {
        let faces = self.faces().iter().map(|face| (face.id.into(), &face.label));
        let edges = self.edges().iter().map(|edge| (edge.id.into(), &edge.label));
        faces.chain(edges).chain(self.vertices().iter().map(|vertex| (vertex.id.into(), &vertex.label)))
    }

    fn by_name(&self, reference: &str, name: &str) -> Result<Vec<EntityId>, ReferenceError> {
        let mut groups = self.groups().iter().filter(|group| !group.reference.is_empty() && group.name == name);
        let found: Vec<EntityId> =
            self.labelled().filter(|(_, label)| !name.is_empty() && label.name == name).map(|(id, _)| id).collect();
        match (groups.next(), groups.next(), found.len()) {
            (Some(group), None, 0) => Ok(group.members.clone()),
            (None, _, 1) => Ok(found),
            (None, _, 0) => Err(self.unknown(reference, format!("no entity has that name; {}", self.ready()))),
            (group, second, _) => {
                let members = group.into_iter().chain(second).flat_map(|group| group.members.iter().copied());
                Err(self.ambiguous(reference, found.into_iter().chain(members).collect()))
            }
        }
    }

    fn by_group(&self, reference: &str, name: &str) -> Result<Vec<EntityId>, ReferenceError> {
        let found: Vec<_> = self.groups().iter().filter(|group| group.name == name).collect();
        match found.as_slice() {
            [] => Err(self.unknown(reference, self.ready())),
            [group] => Ok(group.members.clone()),
            several => {
                let members = several.iter().flat_map(|group| group.members.iter().copied());
                Err(self.ambiguous(reference, members.collect()))
            }
        }
    }

    /// The ready groups, for messages.
    fn ready(&self) -> String {
        let names: Vec<&str> =
            self.groups().iter().map(|group| group.name.as_str()).filter(|n| !n.is_empty()).collect();
        if names.is_empty() { "it has no named groups".into() } else { format!("named groups: {}", names.join(", ")) }
    }

    fn by_origin(&self, reference: &str, origin: &str) -> Result<Vec<EntityId>, ReferenceError> {
        let answers = |of: &str| of.strip_prefix(origin).is_some_and(|rest| rest.is_empty() || rest.starts_with('@'));
        let found: Vec<EntityId> =
            self.labelled().filter(|(_, label)| answers(&label.reference)).map(|(id, _)| id).collect();
        match found.len() {
            0 => match self.groups().iter().find(|group| group.reference == origin) {
                Some(group) => Ok(group.members.clone()),
                None => Err(self.unknown(reference, "no face, edge, vertex or group has that id".into())),
            },
            1 => Ok(found),
            _ => Err(self.ambiguous(reference, found)),
        }
    }

    /// One side of `faces:A|B`: `#17`, `D19`, `3`, or a full reference to a face.
    fn side(&self, reference: &str, side: &str) -> Result<FaceId, ReferenceError> {
        let side = side.trim();
        let full = match side.as_bytes().first() {
            Some(b'#') => format!("step:{side}"),
            Some(b'D') => format!("iges:{side}"),
            Some(b'0'..=b'9') => format!("face:{side}"),
            _ => side.to_owned(),
        };
        match self.resolve(&full)?.as_slice() {
            [EntityId::Face(id)] => Ok(*id),
            _ => Err(self.unknown(reference, format!("{side:?} is not one face"))),
        }
    }

    fn between(&self, reference: &str, a: &str, b: &str) -> Result<Vec<EntityId>, ReferenceError> {
        let (a, b) = (self.side(reference, a)?, self.side(reference, b)?);
        let between = |edge: &&Edge| edge.faces.contains(&a) && edge.faces.contains(&b) && (a != b || edge.seam);
        let mut shared: Vec<EntityId> = self.edges().iter().filter(between).map(|edge| edge.id.into()).collect();
        if shared.is_empty() {
            shared = self.between_unsewn(a, b).into_iter().map(EntityId::Edge).collect();
        }
        if shared.is_empty() { Err(self.unknown(reference, format!("{a} and {b} share no edge"))) } else { Ok(shared) }
    }

    /// Edges of one face that are doubled by edges of the other, or a seam by one of the same face. Of two that double each other it is the
    /// first, of a long one and its piece the piece: it alone lies between the two faces.
    fn between_unsewn(&self, a: FaceId, b: FaceId) -> Vec<EdgeId> {
        let of = |set: &[EdgeId], face| -> Vec<&Edge> {
            set.iter().filter_map(|&id| self.edge(id)).filter(|edge| edge.faces.contains(&face)).collect()
        };
        let mut between = BTreeSet::new();
        for set in &self.sewing().merged {
            let on_b = of(set, b);
            for one in of(set, a) {
                between.extend(on_b.iter().filter_map(|other| self.doubled_part(one, other)));
            }
        }
        between.into_iter().collect()
    }
}
