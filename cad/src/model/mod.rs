//! The CAD model: entities as plain data, and the geometry behind them.

pub(crate) mod containment;
pub(crate) mod crease;
mod flat;
pub(crate) mod health;
pub(crate) mod reference;
mod sewing;

use crate::boxes::Aabb;
use crate::geometry::chart::surface_d2;
use crate::geometry::curve::curve_d2;
use crate::geometry::evaluation::{CurvePoint, Evaluation, SurfacePoint};
use crate::geometry::leaf::{EdgeGeometry, FaceGeometry};
use crate::ids::{EdgeId, EntityId, FaceId, VertexId};
use glam::DVec3;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Entities that a message lists.
const LISTED: usize = 5;

/// What a face or an edge is, as the file says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs)] // the names say it
pub enum Kind {
    Plane,
    Cylinder,
    Cone,
    Sphere,
    Torus,
    Revolution,
    Extrusion,
    Offset,
    Bezier,
    Bspline,
    Line,
    Circle,
    Ellipse,
    Parabola,
    Hyperbola,
    /// An edge without a curve: a pole of its face.
    Degenerate,
    Other,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
}

/// The format of a CAD file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum SourceFormat {
    /// ISO 10303-21.
    Step,
    /// IGES 5.x.
    Iges,
    /// OCCT's own text or binary format, with or without the trailer of EGADS.
    Brep,
}

impl fmt::Display for SourceFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Step => "STEP",
            Self::Iges => "IGES",
            Self::Brep => "BREP",
        })
    }
}

/// Unit of length of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// As the file names it; "unknown" where the format has none (BREP).
    pub name: String,
    /// Metres per unit; `None` where unknown.
    pub metres: Option<f64>,
}

/// Name and reference of an entity in its file; empty where the file has none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Label {
    /// Name, trimmed.
    pub name: String,
    /// `step:#17`, `step:#17@4/2` in instance 2 of instance 4 of an assembly, or `iges:D19`.
    pub reference: String,
}

/// A face.
#[derive(Clone, Debug)]
pub struct Face {
    /// Its number.
    pub id: FaceId,
    /// Name and reference.
    pub label: Label,
    /// Its surface.
    pub kind: Kind,
    /// OCCT's tolerance, in the unit of the file.
    pub tolerance: f64,
    /// Close box of its points inside the trim, from samples: points between them may stand out by a little.
    pub bounds: Aabb,
    /// Whether its normal is opposite to that of its surface.
    pub reversed: bool,
    /// Its parameters: `[[u_min, u_max], [v_min, v_max]]`.
    pub parameters: [[f64; 2]; 2],
    /// Its boundary edges, each once, ascending.
    pub edges: Vec<EdgeId>,
}

/// An edge.
#[derive(Clone, Debug)]
pub struct Edge {
    /// Its number.
    pub id: EdgeId,
    /// Name and reference.
    pub label: Label,
    /// Its curve.
    pub kind: Kind,
    /// OCCT's tolerance, in the unit of the file.
    pub tolerance: f64,
    /// Close box, see [`Face::bounds`]; the box of its vertex where degenerate.
    pub bounds: Aabb,
    /// A pole: no curve in space.
    pub degenerate: bool,
    /// One face has it on two sides.
    pub seam: bool,
    /// Its range of parameters.
    pub parameters: [f64; 2],
    /// Vertices at its two ends; equal for a closed edge.
    pub ends: [Option<VertexId>; 2],
    /// The faces it bounds, ascending; a seam's face stands once.
    pub faces: Vec<FaceId>,
}

impl Edge {
    /// Whether it bounds one face only, on one side.
    pub(crate) fn is_open(&self) -> bool {
        self.faces.len() == 1 && !self.seam && !self.degenerate
    }
}

/// A vertex.
#[derive(Clone, Debug)]
pub struct Vertex {
    /// Its number.
    pub id: VertexId,
    /// Name and reference.
    pub label: Label,
    /// Its place.
    pub point: DVec3,
    /// OCCT's tolerance, in the unit of the file.
    pub tolerance: f64,
}

/// A set of entities that the file itself names: an IGES 402 group, or faces (else edges) that share a name. `group:NAME` refers to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedGroup {
    /// Its name.
    pub name: String,
    /// Reference of the group's own entity; empty for entities that share a name.
    pub reference: String,
    /// Its faces, and its edges that bound none of them, ascending.
    pub members: Vec<EntityId>,
}

/// Which open edges are one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sewing {
    /// Sets of edges that are the same curve within tolerance, each ascending, ordered by their first.
    pub merged: Vec<Vec<EdgeId>>,
    /// Edges that bound one face, on one side, and match no other.
    pub open: Vec<EdgeId>,
}

impl Sewing {
    /// All edges that are the same as `edge`, itself included.
    pub fn same_as(&self, edge: EdgeId) -> Vec<EdgeId> {
        let set = self.merged.iter().find(|set| set.contains(&edge));
        set.cloned().unwrap_or_else(|| vec![edge])
    }
}

/// What queries need, shared by the model and its groups.
pub(crate) struct Geometry {
    pub(crate) faces: Vec<FaceGeometry>,
    /// `None` for degenerate edges.
    pub(crate) edges: Vec<Option<EdgeGeometry>>,
    pub(crate) ends: Vec<[Option<VertexId>; 2]>,
    /// Places and tolerances.
    pub(crate) vertices: Vec<(DVec3, f64)>,
}

impl Geometry {
    pub(crate) fn evaluate(&self, entity: EntityId, [u, v]: [f64; 2]) -> Option<Evaluation> {
        let evaluation = match entity {
            EntityId::Face(id) => {
                let face = self.faces.get(id.index())?;
                Evaluation::Surface(SurfacePoint::new(surface_d2(&face.handle, u, v), face.reversed))
            }
            EntityId::Edge(id) => {
                Evaluation::Curve(CurvePoint::new(curve_d2(&self.edges.get(id.index())?.as_ref()?.handle, u)))
            }
            EntityId::Vertex(id) => Evaluation::Vertex(self.vertices.get(id.index())?.0),
        };
        evaluation.point().is_finite().then_some(evaluation)
    }
}

/// A CAD file, read. Plain data and immutable geometry: all of it may be used from any thread.
pub struct Model {
    pub(crate) path: PathBuf,
    pub(crate) format: SourceFormat,
    pub(crate) unit: Unit,
    pub(crate) scale: f64,
    pub(crate) faces: Vec<Face>,
    pub(crate) edges: Vec<Edge>,
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) groups: Vec<NamedGroup>,
    pub(crate) dropped: Vec<String>,
    pub(crate) warnings: Vec<String>,
    pub(crate) sewing: OnceLock<Sewing>,
    pub(crate) bounds: Aabb,
    pub(crate) geometry: Arc<Geometry>,
}

impl fmt::Debug for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [self.faces.len(), self.edges.len(), self.vertices.len()];
        f.debug_struct("Model")
            .field("path", &self.path)
            .field("faces, edges, vertices", &counts)
            .finish_non_exhaustive()
    }
}

impl Model {
    /// The file it was read from.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Format of that file, found by its content.
    pub fn format(&self) -> SourceFormat {
        self.format
    }

    /// Unit of length of the file; all numbers are in it, times [`ReadOptions::scale`](crate::ReadOptions::scale).
    pub fn unit(&self) -> &Unit {
        &self.unit
    }

    /// What all lengths of the file were multiplied by: [`ReadOptions::scale`](crate::ReadOptions::scale).
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// All faces, by number.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// All edges, by number.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// All vertices, by number.
    pub fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Sets of entities that the file names.
    pub fn groups(&self) -> &[NamedGroup] {
        &self.groups
    }

    /// Entities of the file that came to no shape, by reference, with a reason where OCCT gives one.
    pub fn dropped(&self) -> &[String] {
        &self.dropped
    }

    /// What OCCT's checks say of entities of the file, by reference; the model may be right nevertheless.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// What a user of the model should know of the reading: entities of the file that came to no shape or that OCCT calls malformed, the first
    /// by reference. `None` where there are none.
    pub fn losses(&self) -> Option<String> {
        let told = |list: &[String], what: &str| {
            let first = list.iter().take(LISTED).map(String::as_str).collect::<Vec<_>>().join(", ");
            let more = if list.len() > LISTED { ", ..." } else { "" };
            (!list.is_empty()).then(|| format!("{} entities of it {what}: {first}{more}", list.len()))
        };
        let lost = told(&self.dropped, "were dropped by the reader").into_iter();
        let told: Vec<String> = lost.chain(told(&self.warnings, "are malformed or doubtful")).collect();
        (!told.is_empty()).then(|| format!("{}: {}", self.path.display(), told.join("; ")))
    }

    /// Close box of all entities, see [`Face::bounds`].
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Length of the box's diagonal: the measure of all tolerances.
    pub fn diagonal(&self) -> f64 {
        self.bounds.diagonal()
    }

    /// A face by number.
    pub fn face(&self, id: FaceId) -> Option<&Face> {
        self.faces.get(id.index())
    }

    /// An edge by number.
    pub fn edge(&self, id: EdgeId) -> Option<&Edge> {
        self.edges.get(id.index())
    }

    /// A vertex by number.
    pub fn vertex(&self, id: VertexId) -> Option<&Vertex> {
        self.vertices.get(id.index())
    }

    /// Name and reference of an entity; `None` where the model has no such number.
    pub fn label(&self, id: EntityId) -> Option<&Label> {
        match id {
            EntityId::Face(id) => self.face(id).map(|face| &face.label),
            EntityId::Edge(id) => self.edge(id).map(|edge| &edge.label),
            EntityId::Vertex(id) => self.vertex(id).map(|vertex| &vertex.label),
        }
    }

    /// Point and derivatives of an entity at OCCT's parameters, by OCCT. `None` where OCCT cannot evaluate, the entity does not
    /// exist, or is a degenerate edge.
    pub fn evaluate(&self, entity: EntityId, parameters: [f64; 2]) -> Option<Evaluation> {
        self.geometry.evaluate(entity, parameters)
    }

    pub(crate) fn geometry(&self) -> &Arc<Geometry> {
        &self.geometry
    }
}
