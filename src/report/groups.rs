//! The entities and groups of a CAD file, by the references that commands and linkage files take.

use cad::{Aabb, Label, Model};
use schemars::JsonSchema;
use serde::Serialize;

use super::finite;

/// Name and version of the JSON document.
pub const SCHEMA: &str = "sagitta-groups-2";

/// What references to a CAD file may mean.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Groups {
    /// Name and version of this document.
    #[schemars(extend("const" = SCHEMA))]
    pub schema: &'static str,
    /// The file.
    pub path: String,
    /// Its format.
    pub format: String,
    /// The unit of its lengths, as it names it.
    pub unit: String,
    /// That unit in metres, where it is known.
    pub metres_per_unit: Option<f64>,
    /// All faces.
    pub faces: Vec<Entity>,
    /// All edges.
    pub edges: Vec<Entity>,
    /// All vertices.
    pub vertices: Vec<Entity>,
    /// The groups that the file brings along.
    pub groups: Vec<NamedGroup>,
    /// What is missing or malformed in the file.
    pub losses: Option<String>,
}

/// A face, edge or vertex.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Entity {
    /// `face:7`.
    pub id: String,
    /// `step:#17@4/2`, `iges:D19`; empty where the file has none.
    pub reference: String,
    /// Its name; empty where it has none.
    pub name: String,
    /// The kind of surface or curve; `point` for a vertex.
    pub kind: String,
    /// Smallest and largest corner of its bounding box; nothing where it has none.
    pub bounds: Option<[[f64; 3]; 2]>,
    /// Edges of a face, faces of an edge.
    pub neighbours: Vec<String>,
}

/// A group that the file brings along.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct NamedGroup {
    /// `group:NAME`, or the group's own reference where it has no name.
    pub reference: String,
    /// Its name; empty where it has none.
    pub name: String,
    /// Its faces, edges and vertices.
    pub members: Vec<String>,
}

impl Groups {
    /// Of a CAD model.
    #[must_use]
    pub fn new(model: &Model) -> Groups {
        let faces = model.faces().iter().map(|face| {
            let kind = face.kind.to_string();
            Entity::new(face.id.to_string(), &face.label, kind, face.bounds, words(&face.edges))
        });
        let edges = model.edges().iter().map(|edge| {
            let kind = edge.kind.to_string();
            Entity::new(edge.id.to_string(), &edge.label, kind, edge.bounds, words(&edge.faces))
        });
        let vertices = model.vertices().iter().map(|vertex| {
            let bounds = Aabb::of_points([vertex.point]);
            Entity::new(vertex.id.to_string(), &vertex.label, "point".to_owned(), bounds, Vec::new())
        });
        let groups = model.groups().iter().map(|group| NamedGroup {
            reference: match group.name.as_str() {
                "" => group.reference.clone(),
                name => format!("group:{}", quoted(name)),
            },
            name: group.name.clone(),
            members: words(&group.members),
        });
        Groups {
            schema: SCHEMA,
            path: model.path().display().to_string(),
            format: model.format().to_string(),
            unit: model.unit().name.clone(),
            metres_per_unit: model.unit().metres,
            faces: faces.collect(),
            edges: edges.collect(),
            vertices: vertices.collect(),
            groups: groups.collect(),
            losses: model.losses(),
        }
    }
}

impl Entity {
    fn new(id: String, label: &Label, kind: String, bounds: Aabb, neighbours: Vec<String>) -> Entity {
        let corners = [bounds.min, bounds.max].map(|corner| corner.to_array());
        let known = corners.iter().flatten().all(|&value| finite(value).is_some());
        let (reference, name) = (label.reference.clone(), label.name.clone());
        Entity { id, reference, name, kind, bounds: known.then_some(corners), neighbours }
    }
}

fn words<I: ToString>(ids: &[I]) -> Vec<String> {
    ids.iter().map(ToString::to_string).collect()
}

/// A name as references take it.
pub(super) fn quoted(name: &str) -> String {
    if name.contains([' ', ',']) { format!("\"{name}\"") } else { name.to_owned() }
}
