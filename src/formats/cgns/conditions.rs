//! Boundary conditions and families of a CGNS file: which patch each element belongs to.

use std::collections::{BTreeMap, HashSet};

use rustc_hash::FxHashMap;

use super::labels;
use super::sections::Section;
use super::skin;
use super::structured::{Faces, Grid};
use super::tree::{Ints, Tree};
use super::zone::Zone;
use crate::element::Cell;
use crate::formats::assembly::Assembly;
use crate::formats::error::Flaw;
use crate::mesh::{Condition, EntityKey, NodeId};

/// A group that a family stands for: its name, and its number where the file gives one.
type Group = (String, Option<i32>);

/// What a base says of its families.
pub(super) struct Families<'a> {
    known: BTreeMap<&'a str, (Vec<Group>, String)>,
}

impl<'a> Families<'a> {
    pub(super) fn new(base: &'a Tree<'a>) -> Families<'a> {
        let groups = |family: &'a Tree<'a>| {
            let ordinal = ordinal(family);
            // Gmsh makes a family of each entity and names its physical groups within.
            let inner = family.all(labels::FAMILY_NAME).map(filled);
            let inner: Vec<Group> = inner.zip(std::iter::once(ordinal).chain(std::iter::repeat(None))).collect();
            let kind = family.child(labels::FAMILY_BC).map(Tree::text).unwrap_or_default();
            let groups = match inner.is_empty() {
                true if entity_tag(family.name, ordinal).is_some() => Vec::new(),
                true => vec![(family.name.to_owned(), ordinal)],
                false => inner,
            };
            (family.name, (groups, kind))
        };
        Families { known: base.all(labels::FAMILY).map(groups).collect() }
    }

    /// The groups that a node's family names stand for.
    fn of(&self, node: &Tree) -> Vec<Group> {
        let names = node.all(labels::FAMILY_NAME).chain(node.all(labels::MORE_FAMILIES)).map(Tree::text);
        names
            .flat_map(|name| match self.known.get(name.as_str()) {
                Some((groups, _)) => groups.clone(),
                None if entity_tag(&name, None).is_some() => Vec::new(),
                None => vec![(name, None)],
            })
            .collect()
    }

    /// The kind of condition that the node's family has.
    fn kind(&self, node: &Tree) -> Option<&str> {
        let name = node.child(labels::FAMILY_NAME)?.text();
        self.known.get(name.as_str()).map(|(_, kind)| kind.as_str()).filter(|kind| !kind.is_empty())
    }
}

/// A node's text, or its name where it holds none.
fn filled(node: &Tree) -> String {
    let text = node.text();
    if text.is_empty() { node.name.to_owned() } else { text }
}

fn ordinal(node: &Tree) -> Option<i32> {
    i32::try_from(node.child(labels::ORDINAL)?.ints().ok()?.get(0)?).ok().filter(|&n| n > 0)
}

/// The tag in a name that stands for a bare entity: Gmsh's `S_5`, or this program's `surface_5` beside the same ordinal.
fn entity_tag(name: &str, ordinal: Option<i32>) -> Option<i32> {
    let (stem, number) = name.rsplit_once('_')?;
    let tag: i32 = number.parse().ok().filter(|&tag| tag > 0)?;
    let nouns = ["point", "curve", "surface", "volume"];
    // Gmsh gives no ordinals: with one beside it such a name is a group's own.
    let gmsh = matches!(stem, "P" | "L" | "S" | "V") && ordinal.is_none();
    (gmsh || (nouns.contains(&stem) && ordinal == Some(tag))).then_some(tag)
}

/// A patch of the file: a condition, or a section that none covers.
struct Patch {
    name: String,
    kind: String,
    groups: Vec<Group>,
    /// The entity tag that the file asks for.
    wish: Option<i32>,
    /// The node that it comes from.
    path: String,
    is_condition: bool,
}

/// The patches of all zones.
pub(super) struct Conditions<'a> {
    families: Families<'a>,
    /// Dimension of the cells.
    dimension: u8,
    patches: Vec<Patch>,
    /// Sections that no condition covers, and zones' volumes, by path: their patch.
    by_path: FxHashMap<String, usize>,
    /// The entity of each patch in each dimension that its elements have.
    entities: BTreeMap<(u8, usize), EntityKey>,
    used: HashSet<EntityKey>,
    /// Patches given by vertices: the nodes of each.
    by_vertices: Vec<(usize, HashSet<NodeId>)>,
    /// Conditions that list what is not there: their path, and how many numbers.
    beyond: Vec<(String, u64)>,
    /// Conditions of structured zones whose ranges are no part of a layer: their paths.
    ranges: Vec<String>,
}

impl<'a> Conditions<'a> {
    pub(super) fn new(families: Families<'a>, dimension: u8) -> Conditions<'a> {
        Conditions {
            families,
            dimension,
            patches: Vec::new(),
            by_path: FxHashMap::default(),
            entities: BTreeMap::new(),
            used: HashSet::new(),
            by_vertices: Vec::new(),
            beyond: Vec::new(),
            ranges: Vec::new(),
        }
    }

    /// Dimension of the cells.
    pub(super) fn dimension(&self) -> usize {
        self.dimension.into()
    }

    /// For each element of a zone's sections, one after the other, the patch that covers it plus one, or 0.
    ///
    /// Conditions on vertices are kept for [`Conditions::finish`], when the boundary is known.
    pub(super) fn of_zone(&mut self, zone: &Zone, nodes: &[NodeId]) -> Result<Vec<u32>, Flaw> {
        let count = zone.sections.last().map_or(0, |section| section.before + section.count);
        let mut covered = vec![0_u32; count];
        for node in zone.tree.all(labels::ZONE_BC).flat_map(|parent| parent.all(labels::BC)) {
            let patch = self.patches.len();
            self.patches.push(self.patch(node));
            let Some((points, elements)) = points(node) else { continue };
            let values = points.values()?;
            let known = |run: [i64; 2]| match elements {
                true => places(&zone.sections, run).map(|places| places.len() as u64).sum(),
                false => (run[0].max(1)..=run[1].min(nodes.len() as i64)).count() as u64,
            };
            let listed = |[a, b]: [i64; 2]| b.checked_sub(a).map_or(u64::MAX, |n| n.saturating_add(1).max(0) as u64);
            let beyond: u64 =
                values.iter().fold(0, |sum, &run| sum.saturating_add(listed(run).saturating_sub(known(run))));
            if beyond > 0 {
                self.beyond.push((node.path.clone(), beyond));
            }
            if elements {
                for places in values.into_iter().flat_map(|run| places(&zone.sections, run)) {
                    covered[places].iter_mut().filter(|at| **at == 0).for_each(|at| *at = patch as u32 + 1);
                }
            } else {
                let inside = |n: i64| usize::try_from(n - 1).ok().and_then(|n| nodes.get(n)).copied();
                let set = values.into_iter().flat_map(|[a, b]| a.max(1)..=b.min(nodes.len() as i64)).filter_map(inside);
                self.by_vertices.push((patch, set.collect()));
            }
        }
        Ok(covered)
    }

    /// The entity of a structured zone's cells.
    pub(super) fn entity_of_cells(&mut self, zone: &Zone) -> EntityKey {
        let patch = self.uncovered(zone.tree, self.families.of(zone.tree));
        self.entity_of(patch, self.dimension)
    }

    /// The entities of a structured zone's conditions, each with the corners of its faces; a face is in the first that covers it.
    pub(super) fn of_grid(&mut self, zone: &Zone, grid: &Grid) -> Result<Vec<(EntityKey, Faces)>, Flaw> {
        let mut found = Vec::new();
        let mut taken: HashSet<Vec<usize>> = HashSet::new();
        for node in zone.tree.all(labels::ZONE_BC).flat_map(|parent| parent.all(labels::BC)) {
            self.patches.push(self.patch(node));
            let patch = self.patches.len() - 1;
            let location = node.child(labels::LOCATION).map_or_else(|| "Vertex".to_owned(), Tree::text);
            let range = node.named(labels::RANGE, "PointRange");
            let range = range.map(Tree::ints).transpose()?.and_then(|numbers| grid.range(numbers));
            let Some(mut faces) = range.and_then(|range| grid.faces(range, &location)) else {
                self.ranges.push(node.path.clone());
                continue;
            };
            faces.retain(|face| {
                let mut corners = face.clone();
                corners.sort_unstable();
                taken.insert(corners)
            });
            if !faces.is_empty() {
                found.push((self.entity_of(patch, self.dimension - 1), faces));
            }
        }
        Ok(found)
    }

    fn patch(&self, node: &Tree) -> Patch {
        let ordinal = ordinal(node);
        let named = node.child(labels::FAMILY_NAME).map(Tree::text).unwrap_or_default();
        let bare = entity_tag(node.name, ordinal);
        let mut groups = self.families.of(node);
        if named.is_empty() && bare.is_none() {
            groups.push((node.name.to_owned(), None));
        }
        let kind = match node.text() {
            text if text == "FamilySpecified" || text.is_empty() => {
                self.families.kind(node).unwrap_or("FamilySpecified").to_owned()
            }
            text => text,
        };
        let wish = ordinal.or(bare).or_else(|| entity_tag(&named, None));
        Patch { name: node.name.to_owned(), kind, groups, wish, path: node.path.clone(), is_condition: true }
    }

    /// The entity of an element: that of the patch that covers it; else its section's, or for cells its zone's.
    pub(super) fn entity(&mut self, zone: &Zone, section: &Section, covered: u32, cell: Cell) -> EntityKey {
        let dimension = cell.dimension() as u8;
        let patch = match covered.checked_sub(1) {
            Some(patch) => patch as usize,
            None if dimension == self.dimension => self.uncovered(zone.tree, self.families.of(zone.tree)),
            None if dimension + 1 == self.dimension => {
                self.uncovered(section.tree, vec![(section.tree.name.to_owned(), None)])
            }
            None => self.uncovered(section.tree, Vec::new()),
        };
        self.entity_of(patch, dimension)
    }

    fn uncovered(&mut self, node: &Tree, groups: Vec<Group>) -> usize {
        if let Some(&known) = self.by_path.get(&node.path) {
            return known;
        }
        self.patches.push(Patch {
            name: node.name.to_owned(),
            kind: String::new(),
            groups,
            wish: ordinal(node),
            path: node.path.clone(),
            is_condition: false,
        });
        self.by_path.insert(node.path.clone(), self.patches.len() - 1);
        self.patches.len() - 1
    }

    fn entity_of(&mut self, patch: usize, dimension: u8) -> EntityKey {
        if let Some(&known) = self.entities.get(&(dimension, patch)) {
            return known;
        }
        let wishes: HashSet<i32> = self.patches.iter().filter_map(|patch| patch.wish).collect();
        let free = |tag: &i32| !self.used.contains(&EntityKey::new(dimension, *tag));
        let wish = self.patches[patch].wish.filter(free);
        let next = || (1..).find(|tag| !wishes.contains(tag) && free(tag));
        let key = EntityKey::new(dimension, wish.or_else(next).unwrap_or(i32::MAX));
        self.used.insert(key);
        self.entities.insert((dimension, patch), key);
        key
    }

    /// Applies the conditions on vertices, and names all entities.
    pub(super) fn finish(mut self, assembly: &mut Assembly) {
        self.vertices(assembly);
        for (&(dimension, patch), &key) in &self.entities {
            let Patch { name, kind, groups, is_condition, .. } = &self.patches[patch];
            let mut tags: Vec<i32> = groups.iter().map(|(name, tag)| assembly.group(dimension, name, *tag)).collect();
            tags.dedup();
            assembly.entity(key, tags);
            if *is_condition && dimension < self.dimension {
                assembly.parts.conditions.push(Condition { entity: key, name: name.clone(), kind: kind.clone() });
            }
        }
        let used: HashSet<usize> = self.entities.keys().map(|&(_, patch)| patch).collect();
        let unused = self.patches.iter().enumerate().filter(|(n, patch)| patch.is_condition && !used.contains(n));
        for (_, patch) in unused {
            assembly
                .parts
                .notes
                .push(format!("{}: has no face that is not in another condition too; left out", patch.path));
        }
        for (path, count) in &self.beyond {
            let note = format!(
                "{path}: {count} of the numbers that it lists are of no element or vertex of the zone; ignored"
            );
            assembly.parts.notes.push(note);
        }
        for path in &self.ranges {
            assembly.parts.notes.push(format!("{path}: its PointRange is no part of one layer of the zone; ignored"));
        }
        assembly.parts.physical_names.sort_by_key(|name| (name.dimension, name.tag));
    }

    /// Faces of the boundary whose corners are all listed by a condition on vertices become its faces, unless another
    /// condition has them.
    fn vertices(&mut self, assembly: &mut Assembly) {
        if self.by_vertices.is_empty() {
            return;
        }
        let by_vertices = std::mem::take(&mut self.by_vertices);
        let conditions: HashSet<EntityKey> =
            self.entities.iter().filter(|((_, p), _)| self.patches[*p].is_condition).map(|(_, &key)| key).collect();
        let mut assigned = Vec::new();
        for face in skin::bare_faces(&assembly.parts, &conditions) {
            let corners = &face.nodes[..face.cell.corner_count()];
            let holds = |(_, set): &&(usize, HashSet<NodeId>)| corners.iter().all(|node| set.contains(node));
            if let Some(&(patch, _)) = by_vertices.iter().find(holds) {
                let key = self.entity_of(patch, face.cell.dimension() as u8);
                assigned.push((face, key));
            }
        }
        skin::assign(assembly, assigned);
    }
}

/// Element or vertex numbers of a condition.
enum Points<'a> {
    List(Ints<'a>),
    Range(Ints<'a>),
}

impl Points<'_> {
    /// As ranges, both ends included.
    fn values(&self) -> Result<Vec<[i64; 2]>, Flaw> {
        Ok(match self {
            Points::List(values) => values.iter().map(|n| [n, n]).collect(),
            Points::Range(values) => match (values.get(0), values.get(1)) {
                (Some(a), Some(b)) => vec![[a, b]],
                _ => Vec::new(),
            },
        })
    }
}

/// The numbers that a condition lists, and whether they are of elements rather than of vertices.
fn points<'a>(node: &'a Tree<'a>) -> Option<(Points<'a>, bool)> {
    let list = |name| node.named(labels::LIST, name).and_then(|node| node.ints().ok()).map(Points::List);
    let range = |name| node.named(labels::RANGE, name).and_then(|node| node.ints().ok()).map(Points::Range);
    // Before CGNS 3.1 element numbers had names of their own.
    if let Some(old) = list("ElementList").or_else(|| range("ElementRange")) {
        return Some((old, true));
    }
    let location = node.child(labels::LOCATION).map_or_else(|| "Vertex".to_owned(), Tree::text);
    Some((list("PointList").or_else(|| range("PointRange"))?, location != "Vertex"))
}

/// Places of the elements `a..=b` among those of the sections.
fn places<'s>(sections: &'s [Section], [a, b]: [i64; 2]) -> impl Iterator<Item = std::ops::Range<usize>> + 's {
    sections.iter().filter_map(move |section| {
        let first = section.first as i64;
        let from = a.max(first) - first;
        let to = b.min(first + section.count as i64 - 1) - first;
        (from <= to).then(|| section.before + from as usize..section.before + to as usize + 1)
    })
}
