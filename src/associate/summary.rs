//! An association in figures, patch by patch: what `sagitta link` and `sagitta curve --dry-run` report.

use std::collections::{BTreeMap, BTreeSet};

use cad::{EntityId, Group, Model};
use glam::DVec3;
use schemars::JsonSchema;
use serde::Serialize;

use super::host::is_host;
use super::{Candidates, Doubt, Inference};
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId};

/// Name and version of the JSON document.
pub const SUMMARY_SCHEMA: &str = "sagitta-association-2";

/// Which mesh entities lie on which CAD entities.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Summary {
    /// Name and version of this document.
    #[schemars(extend("const" = SUMMARY_SCHEMA))]
    pub schema: &'static str,
    /// Where the association comes from.
    pub source: String,
    /// Whether the mesh is a plane one: what is called a face here is an edge then.
    #[serde(skip)]
    pub in_plane: bool,
    /// By boundary entity of the mesh.
    pub patches: Vec<Patch>,
    /// Mesh edges that are associated with CAD edges.
    pub edges: usize,
    /// Nodes that are associated with CAD vertices.
    pub points: usize,
    /// What could not be decided; faces whose points are not on the CAD at all are counted in their patch only.
    pub undecided: Vec<Undecided>,
    /// Where the CAD leaves the elements little room, least first: `curve --dry-run` looks for it, `link` does not.
    pub spots: Vec<SpotReport>,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// A place where the CAD leaves the elements little room.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct SpotReport {
    /// What it is: `element corner`, `face corner` or `column`.
    pub kind: &'static str,
    /// The element or boundary face, by kind and number in the file.
    pub element: String,
    /// The number of the node at the corner; nothing for a column.
    pub node: Option<u64>,
    /// That node, or the middle of the column's wall face.
    pub position: [f64; 3],
    /// Room between the tangents of its edges on the CAD, in that between their chords; 0 and less is impossible. Nothing for a column.
    pub q: Option<f64>,
    /// The longest edge there over the CAD's least radius of curvature. Nothing for a column.
    pub bend: Option<f64>,
    /// Displacement of a column's ends towards each other over its height; 1 and more is impossible. Nothing for a corner.
    pub squeeze: Option<f64>,
    /// Whether wall nodes have to slide or to leave the CAD there for the elements to be valid.
    pub impossible: bool,
    /// The CAD that it lies on.
    pub cad: String,
    /// What can be done to the mesh.
    pub remedy: &'static str,
}

/// A patch and the CAD faces that it lies on.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Patch {
    /// The mesh entity.
    pub entity: String,
    /// Its physical names.
    pub names: Vec<String>,
    /// Its faces.
    pub faces: usize,
    /// CAD faces, or groups of them, with the number of mesh faces on each.
    pub cad_faces: BTreeMap<String, usize>,
    /// Faces that could not be decided.
    pub undecided: usize,
    /// Faces of which no point is on the CAD.
    pub off_cad: usize,
    /// The largest distance of an associated node from its CAD faces.
    pub cad_distance_max: f64,
}

/// A face or edge that is left out.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Undecided {
    /// `face` or `edge`.
    pub kind: &'static str,
    /// The numbers of its nodes.
    pub nodes: Vec<u64>,
    /// Its middle.
    pub position: [f64; 3],
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
            cad_faces: BTreeMap::new(),
            undecided: 0,
            off_cad: 0,
            cad_distance_max: 0.0,
        });
        patch.faces += 1;
    }
    for sheet in candidates.sheets.iter().filter(|sheet| !sheet.entities.is_empty()) {
        let target = sheet.entities.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let farthest = farthest_by_patch(mesh, boundary, model, &sheet.entities, &sheet.items);
        for &face in &sheet.items {
            if let Some(patch) = patches.get_mut(&boundary.faces[face].entity) {
                *patch.cad_faces.entry(target.clone()).or_default() += 1;
            }
        }
        for (entity, distance) in farthest {
            if let Some(patch) = patches.get_mut(&entity) {
                patch.cad_distance_max = patch.cad_distance_max.max(distance);
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
            let kind = if boundary.plane.is_some() { "edge" } else { "face" };
            undecided.push(Undecided::new(kind, mesh, &boundary.corners[*face], doubt));
        }
    }
    for (edge, doubt) in inference.iter().flat_map(|inference| &inference.edges) {
        undecided.push(Undecided::new("edge", mesh, &boundary.edges[*edge], doubt));
    }
    Summary {
        schema: SUMMARY_SCHEMA,
        source: source.to_owned(),
        in_plane: boundary.plane.is_some(),
        patches: patches.into_values().collect(),
        edges: candidates.strings.iter().filter(|s| !s.entities.is_empty()).map(|s| s.items.len()).sum(),
        points: candidates.points.iter().filter(|p| !p.entities.is_empty()).map(|p| p.items.len()).sum(),
        undecided,
        spots: Vec::new(),
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
    let ids: Vec<EntityId> = entities.iter().copied().filter(|&e| is_host(boundary, e)).collect();
    let Ok(group) = Group::of(model, &ids) else { return farthest };
    let mut nodes: BTreeMap<EntityKey, BTreeSet<NodeId>> = BTreeMap::new();
    for &face in faces {
        nodes.entry(boundary.faces[face].entity).or_default().extend(&boundary.corners[face]);
    }
    for (entity, nodes) in nodes {
        let positions: Vec<DVec3> = nodes.iter().map(|n| mesh.points()[n.index()]).collect();
        farthest.insert(entity, group.distances(&positions).into_iter().fold(0.0, f64::max));
    }
    farthest
}

impl Undecided {
    fn new(kind: &'static str, mesh: &Mesh, nodes: &[NodeId], doubt: &Doubt) -> Undecided {
        Undecided {
            kind,
            nodes: nodes.iter().map(|n| mesh.node_tags()[n.index()]).collect(),
            position: (mesh.points_of(nodes).sum::<DVec3>() / nodes.len() as f64).to_array(),
            reason: doubt.to_string(),
        }
    }
}
