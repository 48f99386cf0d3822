//! How far linked points are from their CAD entities.

use cad::{EdgeId, EntityId, FaceId, Group, GroupError, Model, VertexId};
use glam::DVec3;
use linkage_schema::{Code, Findings, ModelLinks, Origin, Target};
use schemars::JsonSchema;
use serde::Serialize;

use super::called;
use super::linked_mesh::LinkedMesh;
use super::references::Geometry;
use crate::associate::{AssociateError, Candidate, Candidates, check_boxes};
use crate::mesh::NodeId;

/// The distances of one run of faces, edges or points.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Measured {
    /// Sheet or string.
    pub name: String,
    /// The CAD entities.
    pub cad: String,
    /// Its points.
    pub points: usize,
    /// Those farther away than the tolerance.
    pub off_cad: usize,
    /// The largest distance.
    pub cad_distance_max: f64,
    /// The number of the node that has it.
    pub node: u64,
    /// The position of that node.
    pub position: [f64; 3],
    /// Line of the run in the linkage file.
    pub line: Option<u32>,
}

/// Whether CAD and mesh are in one unit and at one place; a finding where not.
pub(super) fn same_scale(
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
    findings: &mut Findings,
) -> bool {
    match (models.first(), misfit(linked, models, model, geometry)) {
        (Some(first), Some(error)) => {
            findings.push(Code::OtherScale, first.model.origin, || error.to_string());
            false
        }
        _ => true,
    }
}

/// The factor between units by which the CAD must be multiplied to fit the mesh, if that is what sets them apart.
pub(super) fn unit_factor(
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
) -> Option<f64> {
    match misfit(linked, models, model, geometry)? {
        AssociateError::Scale { factor, .. } => Some(factor),
        _ => None,
    }
}

/// How the boxes of what is linked, in mesh and CAD, differ in size or place.
fn misfit(
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
) -> Option<AssociateError> {
    let mut candidates = Candidates::default();
    for links in models {
        let linked = linked.within(links.model);
        for link in links.sheets.iter().flat_map(|sheet| &sheet.faces) {
            let items: Vec<usize> = link.run.faces().filter_map(|face| linked.face(face)).collect();
            let entities = geometry.of(link.target.as_deref());
            if !items.is_empty() && !entities.is_empty() {
                candidates.sheets.push(Candidate { label: String::new(), items, entities });
            }
        }
    }
    let error = (!candidates.sheets.is_empty())
        .then(|| check_boxes(linked.mesh, linked.boundary, model, &candidates).err())??;
    matches!(error, AssociateError::Scale { .. } | AssociateError::Size { .. } | AssociateError::Place { .. })
        .then_some(error)
}

/// Measures all sheets, strings and points.
pub(super) fn check(
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
    tolerance: f64,
    findings: &mut Findings,
) -> [Vec<Measured>; 3] {
    let [mut sheets, mut strings, mut points]: [Vec<Measured>; 3] = Default::default();
    for links in models {
        let linked = &linked.within(links.model);
        let ruler = Ruler { linked, model, geometry, tolerance };
        for sheet in &links.sheets {
            for link in &sheet.faces {
                let nodes =
                    linked.nodes(link.run.faces().filter(|face| linked.face(face).is_some()).flatten().copied());
                let name = called("sheet", sheet.name());
                sheets.extend(ruler.measure(&name, link.target.as_deref(), &nodes, link.run.origin, findings));
            }
        }
        for string in &links.strings {
            for link in &string.edges {
                let nodes = linked.nodes(link.run.edges().filter(|ends| linked.edge(*ends).is_some()).flatten());
                let name = called("string", string.name());
                strings.extend(ruler.measure(&name, link.target.as_deref(), &nodes, link.run.origin, findings));
            }
        }
        for link in &links.points {
            let nodes = linked.nodes(link.run.indices.iter().copied());
            points.extend(ruler.measure(
                "MeshPointReference",
                link.target.as_deref(),
                &nodes,
                link.run.origin,
                findings,
            ));
        }
    }
    [sheets, strings, points]
}

struct Ruler<'a> {
    linked: &'a LinkedMesh<'a>,
    model: &'a Model,
    geometry: &'a Geometry,
    tolerance: f64,
}

impl Ruler<'_> {
    fn measure(
        &self,
        name: &str,
        target: Option<&Target<'_>>,
        nodes: &[NodeId],
        origin: Origin,
        findings: &mut Findings,
    ) -> Option<Measured> {
        let entities = self.geometry.of(target);
        let group = group(self.model, &entities)?.ok()?;
        let positions: Vec<DVec3> = nodes.iter().map(|n| self.linked.mesh.points()[n.index()]).collect();
        let distances = group.distances(&positions);
        let worst = (0..distances.len()).max_by(|&a, &b| distances[a].total_cmp(&distances[b]))?;
        let cad = entities.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        let off_cad = distances.iter().filter(|&&distance| distance > self.tolerance).count();
        let measured = Measured {
            name: name.to_owned(),
            cad,
            points: nodes.len(),
            off_cad,
            cad_distance_max: distances[worst],
            node: self.linked.tag(nodes[worst]),
            position: positions[worst].to_array(),
            line: origin.position().map(|position| position.line.get()),
        };
        if off_cad > 0 {
            findings.push(Code::OffGeometry, origin, || {
                let Measured { points, node, cad_distance_max: distance, cad, .. } = &measured;
                let [x, y, z] = positions[worst].to_array();
                format!("{off_cad} of the {points} points of {name} are off {cad}: node {node} at ({x:.6}, {y:.6}, {z:.6}) by {distance:.3e}")
            });
        }
        Some(measured)
    }
}

/// The group of entities of one kind, the kind of the first; `None` for none.
pub(super) fn group(model: &Model, entities: &[EntityId]) -> Option<Result<Group, GroupError>> {
    let faces: Vec<FaceId> =
        entities.iter().filter_map(|e| if let EntityId::Face(id) = e { Some(*id) } else { None }).collect();
    let edges: Vec<EdgeId> =
        entities.iter().filter_map(|e| if let EntityId::Edge(id) = e { Some(*id) } else { None }).collect();
    let vertices: Vec<VertexId> =
        entities.iter().filter_map(|e| if let EntityId::Vertex(id) = e { Some(*id) } else { None }).collect();
    Some(match entities.first()? {
        EntityId::Face(_) => Group::of_faces(model, &faces),
        EntityId::Edge(_) => Group::of_edges(model, &edges),
        EntityId::Vertex(_) => Group::of_vertices(model, &vertices),
    })
}
