//! An association in figures, patch by patch: what `sagitta link` and `sagitta curve --dry-run` tell.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use cad::{EntityId, Group, Model};
use glam::DVec3;
use serde::Serialize;

use super::{Candidates, Doubt, Inference};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

/// Undecided items that are listed as text.
const LISTED: usize = 10;

/// What is tied to what.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Where the association comes from.
    pub source: String,
    /// By boundary entity of the mesh.
    pub patches: Vec<Patch>,
    /// Mesh edges that are tied to CAD edges.
    pub edges: usize,
    /// Nodes that are tied to CAD vertices.
    pub points: usize,
    /// What could not be decided; faces whose points are not on the CAD at all are counted in their patch only.
    pub undecided: Vec<Undecided>,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// A patch and the CAD faces that it lies on.
#[derive(Clone, Debug, Serialize)]
pub struct Patch {
    /// The mesh entity.
    pub entity: String,
    /// Its physical names.
    pub names: Vec<String>,
    /// Its faces.
    pub faces: usize,
    /// CAD faces, or groups of them, with the number of mesh faces on each.
    pub on: BTreeMap<String, usize>,
    /// Faces that could not be decided.
    pub undecided: usize,
    /// Faces of which no point is on the CAD.
    pub off_cad: usize,
    /// The largest distance of a tied node from its CAD faces.
    pub farthest: f64,
}

/// A face or edge that is left out.
#[derive(Clone, Debug, Serialize)]
pub struct Undecided {
    /// `face` or `edge`.
    pub kind: &'static str,
    /// The numbers of its nodes.
    pub nodes: Vec<u64>,
    /// Its middle.
    pub place: [f64; 3],
    /// Why.
    pub reason: String,
}

/// The figures of candidates; `inference` is what they came from, if they were inferred.
#[must_use]
pub fn summary(
    source: &str,
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    candidates: &Candidates,
    inference: Option<&Inference>,
) -> Summary {
    let mut patches: BTreeMap<EntityKey, Patch> = BTreeMap::new();
    for face in &boundary.faces {
        let patch = patches.entry(face.entity).or_insert_with(|| Patch {
            entity: face.entity.to_string(),
            names: mesh.names_of(face.entity),
            faces: 0,
            on: BTreeMap::new(),
            undecided: 0,
            off_cad: 0,
            farthest: 0.0,
        });
        patch.faces += 1;
    }
    for sheet in candidates.sheets.iter().filter(|sheet| !sheet.entities.is_empty()) {
        let target = sheet.entities.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let farthest = farthest_by_patch(mesh, boundary, model, &sheet.entities, &sheet.items);
        for &face in &sheet.items {
            if let Some(patch) = patches.get_mut(&boundary.faces[face].entity) {
                *patch.on.entry(target.clone()).or_default() += 1;
            }
        }
        for (entity, distance) in farthest {
            if let Some(patch) = patches.get_mut(&entity) {
                patch.farthest = patch.farthest.max(distance);
            }
        }
    }
    let mut undecided = Vec::new();
    for (face, doubt) in inference.iter().flat_map(|inference| &inference.faces) {
        let Some(patch) = patches.get_mut(&boundary.faces[*face].entity) else { continue };
        if *doubt == Doubt::OffCad {
            patch.off_cad += 1;
        } else {
            patch.undecided += 1;
            undecided.push(Undecided::new("face", mesh, &boundary.corners[*face], doubt));
        }
    }
    for (edge, doubt) in inference.iter().flat_map(|inference| &inference.edges) {
        undecided.push(Undecided::new("edge", mesh, &boundary.edges[*edge], doubt));
    }
    Summary {
        source: source.to_owned(),
        patches: patches.into_values().collect(),
        edges: candidates.strings.iter().filter(|s| !s.entities.is_empty()).map(|s| s.items.len()).sum(),
        points: candidates.points.iter().filter(|p| !p.entities.is_empty()).map(|p| p.items.len()).sum(),
        undecided,
        notes: Vec::new(),
    }
}

/// The largest distance of the faces' nodes from the entities, by patch.
fn farthest_by_patch(
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    entities: &[EntityId],
    faces: &[usize],
) -> BTreeMap<EntityKey, f64> {
    let mut farthest = BTreeMap::new();
    let ids: Vec<cad::FaceId> =
        entities.iter().filter_map(|e| if let EntityId::Face(id) = e { Some(*id) } else { None }).collect();
    let Ok(group) = Group::of_faces(model, &ids) else { return farthest };
    let mut nodes: BTreeMap<EntityKey, BTreeSet<NodeId>> = BTreeMap::new();
    for &face in faces {
        nodes.entry(boundary.faces[face].entity).or_default().extend(&boundary.corners[face]);
    }
    for (entity, nodes) in nodes {
        let places: Vec<DVec3> = nodes.iter().map(|n| mesh.points[n.index()]).collect();
        let feet = group.closest_batch(&places, &mut []);
        farthest.insert(entity, feet.iter().map(|foot| foot.distance).fold(0.0, f64::max));
    }
    farthest
}

impl Undecided {
    fn new(kind: &'static str, mesh: &Mesh, nodes: &[NodeId], doubt: &Doubt) -> Undecided {
        Undecided {
            kind,
            nodes: nodes.iter().map(|n| mesh.node_tags[n.index()]).collect(),
            place: (mesh.points_of(nodes).sum::<DVec3>() / nodes.len() as f64).to_array(),
            reason: doubt.to_string(),
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "association by {}", self.source)?;
        let heads = ["patch", "faces", "undecided", "not on CAD", "farthest", "on"];
        let [patch, faces, undecided, off, farthest, on] = heads;
        writeln!(f, "{patch:<24}{faces:>9}{undecided:>11}{off:>12}{farthest:>11}  {on}")?;
        for p in &self.patches {
            let name =
                if p.names.is_empty() { p.entity.clone() } else { format!("{} {}", p.names.join(","), p.entity) };
            let on: Vec<String> = p.on.iter().map(|(target, count)| format!("{target} ({count})")).collect();
            let on = if on.is_empty() { "not tied".to_owned() } else { on.join("; ") };
            writeln!(f, "{name:<24}{:>9}{:>11}{:>12}{:>11.2e}  {on}", p.faces, p.undecided, p.off_cad, p.farthest)?;
        }
        write!(f, "{} mesh edges on CAD edges, {} nodes at CAD vertices", self.edges, self.points)?;
        for item in self.undecided.iter().take(LISTED) {
            let [x, y, z] = item.place;
            write!(f, "\nundecided: {} {:?} near ({x:.6}, {y:.6}, {z:.6}): {}", item.kind, item.nodes, item.reason)?;
        }
        let more = self.undecided.len().saturating_sub(LISTED);
        if more > 0 {
            write!(f, "\nundecided: {more} more (--report lists them)")?;
        }
        self.notes.iter().try_for_each(|note| write!(f, "\nnote: {note}"))
    }
}
