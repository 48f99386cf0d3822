//! The faces and edges of a linear mesh that can lie on CAD; of a plane mesh the edges alone.

use rustc_hash::FxHashMap;

use super::{EntityKey, FaceKey, Mesh, NodeId, Plane};
use crate::element::{Cell, Order};

/// A two-dimensional element of the mesh file; of a plane mesh a one-dimensional one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryFace {
    /// Triangle or quadrilateral; line.
    pub cell: Cell,
    /// Its block in the mesh, and its place there.
    pub block: usize,
    /// Its place in the block.
    pub element: usize,
    /// The mesh entity that it belongs to.
    pub entity: EntityKey,
}

/// The two-dimensional elements of a mesh of volumes or on a curved surface, and their edges. In a plane mesh the lines that bound its
/// cells are the faces, and each is its own edge.
#[derive(Debug, Default)]
pub struct Boundary {
    /// All of them, in file order.
    pub faces: Vec<BoundaryFace>,
    /// Corners of each face, in file order.
    pub corners: Vec<Vec<NodeId>>,
    /// Every edge of a face once, smaller node first.
    pub edges: Vec<[NodeId; 2]>,
    /// The plane of a plane mesh.
    pub plane: Option<Plane>,
    /// The faces at each edge.
    pub edge_faces: Vec<Vec<usize>>,
    by_corners: FxHashMap<FaceKey, usize>,
    by_ends: FxHashMap<[NodeId; 2], usize>,
}

impl Boundary {
    /// The boundary of a linear mesh.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Boundary {
        let mut boundary = Boundary { plane: mesh.plane(mesh.points()), ..Boundary::default() };
        let dimension = if boundary.plane.is_some() { 1 } else { 2 };
        for (place, block) in mesh.blocks_of(dimension) {
            for (element, corners) in block.elements(Order::LINEAR).enumerate() {
                let face = BoundaryFace { cell: block.cell, block: place, element, entity: block.entity };
                boundary.add(face, corners);
            }
        }
        boundary
    }

    fn add(&mut self, face: BoundaryFace, corners: &[NodeId]) {
        let index = self.faces.len();
        for &[a, b] in face.cell.edges() {
            let ends = sorted([corners[usize::from(a)], corners[usize::from(b)]]);
            let edge = *self.by_ends.entry(ends).or_insert_with(|| {
                self.edges.push(ends);
                self.edge_faces.push(Vec::new());
                self.edges.len() - 1
            });
            self.edge_faces[edge].push(index);
        }
        self.by_corners.insert(FaceKey::new(corners), index);
        self.corners.push(corners.to_vec());
        self.faces.push(face);
    }

    /// Whether its faces are the cells of `mesh`, as those of a surface mesh are.
    #[must_use]
    pub fn is_of_cells(&self, mesh: &Mesh) -> bool {
        self.faces.first().is_some_and(|face| face.cell.dimension() == mesh.dimension())
    }

    /// Nodes of a face in `mesh`, which has the faces of the linear mesh, in internal order.
    #[must_use]
    pub fn nodes<'m>(&self, face: usize, mesh: &'m Mesh) -> &'m [NodeId] {
        let own = &self.faces[face];
        let block = &mesh.blocks()[own.block];
        let stride = block.stride(mesh.order());
        &block.nodes[own.element * stride..][..stride]
    }

    /// The file's number of a face of `mesh`.
    #[must_use]
    pub fn tag(&self, face: usize, mesh: &Mesh) -> u64 {
        let own = &self.faces[face];
        mesh.blocks()[own.block].tags[own.element]
    }

    /// The face with these corners, in whatever order.
    #[must_use]
    pub fn face(&self, corners: &[NodeId]) -> Option<usize> {
        self.face_of(FaceKey::new(corners))
    }

    /// The face of a key.
    #[must_use]
    pub fn face_of(&self, key: FaceKey) -> Option<usize> {
        self.by_corners.get(&key).copied()
    }

    /// The edge between two nodes.
    #[must_use]
    pub fn edge(&self, ends: [NodeId; 2]) -> Option<usize> {
        self.by_ends.get(&sorted(ends)).copied()
    }
}

fn sorted([a, b]: [NodeId; 2]) -> [NodeId; 2] {
    if a < b { [a, b] } else { [b, a] }
}
