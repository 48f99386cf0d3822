//! What a linkage file, or the tags of a mesh file, say about where mesh entities lie: not yet checked against the CAD.

use cad::{EdgeId, EntityId, FaceId, Model, VertexId};
use rustc_hash::FxHashSet;

use crate::element::Cell;
use crate::mesh::{Boundary, EntityKey, Mesh, NodeId, Periodic};

/// Mesh items that are said to lie on CAD entities.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidate<T> {
    /// What the user calls it.
    pub label: String,
    /// Boundary faces, or node pairs, or nodes.
    pub items: Vec<T>,
    /// The CAD entities; empty where the source names none that this CAD has.
    pub entities: Vec<EntityId>,
}

/// Who says it, and so what can be done where it is wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Teller {
    /// The mesh's entity tags.
    #[default]
    Tags,
    /// A linkage file.
    Linkage,
    /// The mesh's place beside the CAD.
    Geometry,
}

/// All that is said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Candidates {
    /// Faces on CAD faces, by index in the [`Boundary`].
    pub sheets: Vec<Candidate<usize>>,
    /// Edges on CAD edges.
    pub strings: Vec<Candidate<[NodeId; 2]>>,
    /// Points on CAD vertices.
    pub points: Vec<Candidate<NodeId>>,
    /// Pairs of mesh entities whose nodes correspond.
    pub periodic: Vec<Periodic>,
    /// What could not be used, and need not stop the work.
    pub notes: Vec<String>,
    /// Whether the CAD is the file that the candidates were made for.
    pub trusted: bool,
    /// Who says it; what geometry adds to what others say is theirs.
    pub teller: Teller,
}

impl Candidates {
    /// The candidates of a mesh file's entity tags: surface 3 lies on the CAD's face 3, and so on.
    #[must_use]
    pub fn by_tags(mesh: &Mesh, boundary: &Boundary, model: &Model) -> Candidates {
        let mut candidates = Candidates::default();
        let faces = boundary.faces.iter().enumerate().map(|(index, face)| (face.entity, index));
        candidates.sheets = gather(faces, |tag| FaceId::from_tag(tag).filter(|&id| model.face(id).is_some()));
        let lines = mesh.elements_of(Cell::Line);
        let ends = lines.iter().map(|line| (line.entity, [line.nodes[0], line.nodes[1]]));
        candidates.strings = gather(ends, |tag| EdgeId::from_tag(tag).filter(|&id| model.edge(id).is_some()));
        let points = mesh.elements_of(Cell::Point);
        let nodes = points.iter().map(|point| (point.entity, point.nodes[0]));
        candidates.points = gather(nodes, |tag| VertexId::from_tag(tag).filter(|&id| model.vertex(id).is_some()));
        candidates.of_sides(boundary)
    }

    /// Boundary faces that are said to lie on CAD faces.
    pub(super) fn linked_faces(&self) -> FxHashSet<usize> {
        let linked = self.sheets.iter().filter(|sheet| !sheet.entities.is_empty());
        linked.flat_map(|sheet| sheet.items.iter().copied()).collect()
    }
}

/// Items by entity, in the order in which the entities are first met.
fn gather<T, I: Into<EntityId>>(
    items: impl Iterator<Item = (EntityKey, T)>,
    find: impl Fn(u32) -> Option<I>,
) -> Vec<Candidate<T>> {
    let mut places = rustc_hash::FxHashMap::default();
    let mut all: Vec<Candidate<T>> = Vec::new();
    for (entity, item) in items {
        let place = *places.entry(entity).or_insert_with(|| {
            let found = u32::try_from(entity.tag).ok().and_then(&find);
            let entities = found.map(Into::into).into_iter().collect();
            all.push(Candidate { label: entity.to_string(), items: Vec::new(), entities });
            all.len() - 1
        });
        all[place].items.push(item);
    }
    all
}
