//! What ids stand for.

use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::{
    Attribute, AttributeGroup, AttributeId, Code, Document, Findings, GeometryFile, GeometryGroup, GeometryId,
};
use crate::{GeometryReference, Origin, Transform, TransformId};

/// Members that are taken from groups within groups, in all; nested groups are an error, and could be made to multiply.
const NESTED: usize = 1_000_000;
/// Members of attribute groups that are followed in search of groups that contain themselves; known files have a handful.
const STEPS: usize = 1_000_000;
/// Attributes and groups that are looked through behind one `aref`; known files have a handful.
const BEHIND: usize = 10_000;

/// One entity of one CAD file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entity<'a> {
    /// The id in the document.
    pub id: GeometryId,
    /// The CAD file, as the document names it.
    pub file: &'a GeometryFile,
    /// How the entity is called in that file.
    pub reference: &'a str,
    /// A name for people.
    pub name: Option<&'a str>,
}

/// What a `gref` stands for: one entity, or the members of a group.
#[derive(Clone, Debug, PartialEq)]
pub struct Target<'a> {
    /// The id.
    pub id: GeometryId,
    /// The name of the entity or the group.
    pub name: Option<&'a str>,
    /// Whether the id is a group's.
    pub group: bool,
    /// The entities, in the order of the document, each once.
    pub entities: Vec<Entity<'a>>,
    /// The place of its definition.
    pub origin: Origin,
}

/// `gid`s.
#[derive(Debug, Default)]
pub(super) struct GeometryTable<'a>(HashMap<GeometryId, Arc<Target<'a>>>);

impl<'a> GeometryTable<'a> {
    pub(super) fn new(document: &'a Document, findings: &mut Findings) -> Self {
        let mut table = Self::default();
        for file in &document.geometry_files {
            for reference in &file.references {
                table.define(single(file, reference), findings);
            }
        }
        // Groups may refer to what stands behind them, so their members are looked up when all are known.
        let groups: HashMap<GeometryId, &GeometryGroup> =
            document.geometry_groups.iter().rev().map(|group| (group.id, group)).collect();
        let mut room = NESTED;
        let opened: Vec<Target<'a>> =
            document.geometry_groups.iter().map(|group| table.open(group, &groups, &mut room, findings)).collect();
        for target in opened {
            table.define(target, findings);
        }
        table
    }

    pub(super) fn get(&self, id: GeometryId) -> Option<&Arc<Target<'a>>> {
        self.0.get(&id)
    }

    /// What an optional `gref` of an element stands for; a dangling one is found.
    pub(super) fn find(
        &self,
        gref: Option<GeometryId>,
        findings: &mut Findings,
        origin: Origin,
        who: impl FnOnce() -> String,
    ) -> Option<Arc<Target<'a>>> {
        let id = gref?;
        let target = self.get(id);
        if target.is_none() {
            findings.push(Code::DanglingReference, origin, || {
                format!("{} has gref {id}, which no GeometryReference or GeometryGroup defines", who())
            });
        }
        target.cloned()
    }

    fn define(&mut self, target: Target<'a>, findings: &mut Findings) {
        match self.0.entry(target.id) {
            Entry::Occupied(first) => duplicate("gid", target.id.get(), target.origin, first.get().origin, findings),
            Entry::Vacant(vacant) => {
                vacant.insert(Arc::new(target));
            }
        }
    }

    fn open(
        &self,
        group: &'a GeometryGroup,
        groups: &HashMap<GeometryId, &'a GeometryGroup>,
        room: &mut usize,
        findings: &mut Findings,
    ) -> Target<'a> {
        let (id, origin) = (group.id, group.origin);
        let mut entities = Vec::new();
        let mut seen = HashSet::new();
        let mut nested = Vec::new();
        for &member in &group.members {
            if !seen.insert(member) {
                findings.push(Code::RepeatedMember, origin, || format!("GeometryGroup {id} lists {member} twice"));
            } else if let Some(target) = self.get(member) {
                entities.extend(target.entities.iter().copied());
            } else if let Some(inner) = groups.get(&member) {
                findings
                    .push(Code::NestedGroup, origin, || format!("GeometryGroup {id} contains GeometryGroup {member}"));
                let taken = inner.members.len().min(*room);
                *room -= taken;
                nested.extend(inner.members.iter().take(taken).copied());
            } else {
                findings.push(Code::DanglingReference, origin, || {
                    format!("GeometryGroup {id} contains {member}, which no GeometryReference defines")
                });
            }
        }
        for member in nested {
            if seen.insert(member) {
                entities.extend(self.get(member).into_iter().flat_map(|target| target.entities.iter().copied()));
            }
        }
        if group.members.is_empty() {
            findings.push(Code::EmptyElement, origin, || format!("GeometryGroup {id} has no members"));
        }
        Target { id, name: group.name.as_deref(), group: true, entities, origin }
    }
}

fn single<'a>(file: &'a GeometryFile, reference: &'a GeometryReference) -> Target<'a> {
    let name = reference.name.as_deref();
    let entity = Entity { id: reference.id, file, reference: &reference.reference, name };
    Target { id: reference.id, name, group: false, entities: vec![entity], origin: reference.origin }
}

/// Says that an id was given before.
pub(super) fn duplicate(space: &str, id: u32, origin: Origin, first: Origin, findings: &mut Findings) {
    findings.push(Code::DuplicateId, origin, || match first.position() {
        Some(position) => format!("{space} {id} is already defined, at {position}"),
        None => format!("{space} {id} is already defined"),
    });
}

#[derive(Clone, Copy, Debug)]
enum AttributeEntry<'a> {
    Single(&'a Attribute),
    Group(&'a AttributeGroup),
}

/// `attid`s.
#[derive(Debug, Default)]
pub(super) struct AttributeTable<'a>(HashMap<AttributeId, AttributeEntry<'a>>);

impl<'a> AttributeTable<'a> {
    pub(super) fn new(document: &'a Document, findings: &mut Findings) -> Self {
        let mut table = Self::default();
        let singles = document.attributes.iter().map(|one| (one.id, one.origin, AttributeEntry::Single(one)));
        let groups = document.attribute_groups.iter().map(|one| (one.id, one.origin, AttributeEntry::Group(one)));
        for (id, origin, entry) in singles.chain(groups) {
            match table.0.entry(id) {
                Entry::Occupied(first) => duplicate("attid", id.get(), origin, first.get().origin(), findings),
                Entry::Vacant(vacant) => {
                    vacant.insert(entry);
                }
            }
        }
        let mut room = STEPS;
        for group in &document.attribute_groups {
            table.check_members(group, findings);
            if table.reaches(group, group.id, &mut room) {
                findings
                    .push(Code::CyclicGroup, group.origin, || format!("AttributeGroup {} contains itself", group.id));
            }
        }
        table
    }

    pub(super) fn contains(&self, id: AttributeId) -> bool {
        self.0.contains_key(&id)
    }

    fn check_members(&self, group: &AttributeGroup, findings: &mut Findings) {
        let (id, mut seen) = (group.id, HashSet::new());
        for &member in &group.members {
            if !seen.insert(member) {
                findings
                    .push(Code::RepeatedMember, group.origin, || format!("AttributeGroup {id} lists {member} twice"));
            } else if !self.contains(member) {
                findings.push(Code::DanglingReference, group.origin, || {
                    format!("AttributeGroup {id} contains {member}, which no Attribute or AttributeGroup defines")
                });
            }
        }
    }

    /// Whether a group contains an id, at any depth; each step takes from the room for them.
    fn reaches(&self, group: &AttributeGroup, id: AttributeId, room: &mut usize) -> bool {
        let mut seen = HashSet::from([group.id]);
        let mut waiting: Vec<AttributeId> = group.members.clone();
        while let Some(next) = waiting.pop().filter(|_| *room > 0) {
            *room -= 1;
            if next == id {
                return true;
            }
            if let (true, Some(AttributeEntry::Group(inner))) = (seen.insert(next), self.0.get(&next)) {
                waiting.extend(&inner.members);
            }
        }
        false
    }

    /// The attributes behind an id, in the order of the document, each once.
    pub(super) fn open(&self, id: AttributeId) -> Vec<&'a Attribute> {
        let (mut seen, mut waiting, mut found) = (HashSet::new(), vec![id], Vec::new());
        while let Some(next) = waiting.pop() {
            if seen.len() == BEHIND {
                break;
            }
            if !seen.insert(next) {
                continue;
            }
            match self.0.get(&next) {
                Some(AttributeEntry::Single(attribute)) => found.push(*attribute),
                Some(AttributeEntry::Group(group)) => waiting.extend(group.members.iter().rev()),
                None => {}
            }
        }
        found
    }
}

impl AttributeEntry<'_> {
    fn origin(&self) -> Origin {
        match self {
            Self::Single(attribute) => attribute.origin,
            Self::Group(group) => group.origin,
        }
    }
}

/// `xid`s.
#[derive(Debug, Default)]
pub(super) struct TransformTable<'a>(HashMap<TransformId, &'a Transform>);

impl<'a> TransformTable<'a> {
    pub(super) fn new(document: &'a Document, findings: &mut Findings) -> Self {
        let mut table = Self::default();
        for transform in &document.transforms {
            if transform.matrix().is_none() {
                findings.push(Code::BadTransform, transform.origin, || {
                    let words = transform.content.split_ascii_whitespace().count();
                    format!("Transform {} holds {words} words that are not all numbers, or not 16", transform.id)
                });
            }
            match table.0.entry(transform.id) {
                Entry::Occupied(first) => {
                    duplicate("xid", transform.id.get(), transform.origin, first.get().origin, findings);
                }
                Entry::Vacant(vacant) => {
                    vacant.insert(transform);
                }
            }
        }
        table
    }

    pub(super) fn get(&self, id: TransformId) -> Option<&'a Transform> {
        self.0.get(&id).copied()
    }
}
