//! Which wall nodes make elements impossible.

use rustc_hash::FxHashSet;

use crate::associate::Classification;
use crate::curve::level::Level;
use crate::element::{edge_nodes, interior_start};
use crate::mesh::{Element, ElementId, Incidence, components};
use crate::smooth::ElementCost;

/// Elements among which the wall under an element is sought.
const SOUGHT: usize = 4096;

/// Which wall nodes at an element that fails are released, none of them a linear one; each goes where the one before was not enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reach {
    /// Inside one edge of its wall faces, and inside the faces beside that: the edge that two of its wall faces share, else the one that
    /// is bent most. At an element off the wall all those of the wall faces under it: these push its column together.
    Edge,
    /// All those of its wall faces that are not on CAD curves.
    Faces,
    /// All those of its wall faces.
    Whole,
    /// Those on CAD curves as well, and those of the wall faces around.
    Around,
}

/// The nodes of a boundary face.
struct FaceNodes {
    nodes: Vec<usize>,
    /// The nodes of each edge, both ends first.
    edges: &'static [Vec<usize>],
    /// From where on nodes lie inside the face.
    inside: usize,
}

/// An edge of wall faces.
struct WallEdge {
    /// Its nodes but for the ends.
    inner: Vec<usize>,
    /// Whether two faces of one element meet at it within one smooth wall.
    shared: bool,
    /// How far its nodes are displaced, in lengths of the edge.
    bend: f64,
}

/// Looks for the nodes to release at elements of a level.
pub(super) struct Offending<'l, 'a> {
    pub(super) level: &'l Level<'a>,
}

impl Offending<'_, '_> {
    /// Nodes to release at some elements that are still held, rising.
    pub(super) fn nodes(&self, elements: &[ElementId], reach: Reach) -> Vec<usize> {
        let mut marked = vec![false; self.level.curved.len()];
        let cells = self.level.mesh().cells();
        let corners = cells.iter().flat_map(|own| own.corners().iter().map(move |n| (n.index(), own.id)));
        let around = Incidence::new(self.level.elevated.linear_nodes, corners);
        elements.iter().for_each(|&e| self.mark(e, reach, &around, &mut marked));
        if reach == Reach::Around {
            self.mark_around(&mut marked);
        }
        self.mark_inside_faces(&mut marked);
        self.level.periodic.spread(&mut marked);
        (0..marked.len()).filter(|&n| marked[n] && !self.level.wall.is_released(n)).collect()
    }

    /// Those of some elements at which nodes are released. With one edge in reach these are, of elements that are next to each other, the ones
    /// that have two faces on one smooth wall, or else the worst of those on a wall, as the others may fail because of these; where none
    /// is on a wall, all.
    pub(super) fn culprits(&self, elements: &[ElementId], reach: Reach, costs: &[ElementCost]) -> Vec<ElementId> {
        if reach != Reach::Edge {
            return elements.to_vec();
        }
        let tied = self.level.periodic.images().iter().map(|image| [image.node, image.of]);
        let parts = components(&self.level.mesh().cells(), elements, tied);
        parts.into_iter().flat_map(|part| self.culprits_of(part, costs)).collect()
    }

    fn culprits_of(&self, elements: Vec<ElementId>, costs: &[ElementCost]) -> Vec<ElementId> {
        let cells = self.level.mesh().cells();
        let (mut cornered, mut on_wall) = (Vec::new(), Vec::new());
        for &e in &elements {
            let faces = self.wall_faces(&cells.get(e));
            if !faces.is_empty() {
                on_wall.push(e);
            }
            if self.edge_to_release(&faces).is_some_and(|edge| edge.shared) {
                cornered.push(e);
            }
        }
        let cost = |e: &ElementId| costs[e.index()].worst();
        match on_wall.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b))) {
            _ if !cornered.is_empty() => cornered,
            Some(worst) => vec![worst],
            None => elements,
        }
    }

    /// Whether a node can be released: one on a curved wall that is not a linear node.
    fn releasable(&self, node: usize, curves: bool) -> bool {
        let inside = |classification| match classification {
            Classification::Surface(_) => true,
            Classification::Curve(_) => curves,
            _ => false,
        };
        node >= self.level.elevated.linear_nodes
            && self.level.on_curved_wall(node)
            && inside(self.level.wall.classification(node))
    }

    /// Marks the nodes at an element that are in reach.
    fn mark(&self, element: ElementId, reach: Reach, around: &Incidence<ElementId>, marked: &mut [bool]) {
        let own = self.level.mesh().cells().get(element);
        let mut faces = self.wall_faces(&own);
        let chosen = match reach {
            Reach::Edge => self.edge_to_release(&faces),
            Reach::Faces | Reach::Whole | Reach::Around => None,
        };
        if faces.is_empty() {
            faces = self.faces_below(element, around);
        }
        let Some(edge) = chosen else {
            let curves = reach != Reach::Faces;
            let nodes = faces.iter().flat_map(|face| face.nodes.iter().copied());
            return nodes.filter(|&n| self.releasable(n, curves)).for_each(|n| marked[n] = true);
        };
        edge.inner.iter().for_each(|&n| marked[n] = true);
    }

    /// Marks also the nodes inside wall faces that have a marked node: these faces are off the CAD then anyway.
    fn mark_inside_faces(&self, marked: &mut [bool]) {
        for face in (0..self.level.case.boundary.faces.len()).map(|face| self.face_nodes(face)) {
            if face.nodes.iter().any(|&n| marked[n]) {
                let inside = face.nodes[face.inside..].iter().filter(|&&n| self.releasable(n, false));
                inside.for_each(|&n| marked[n] = true);
            }
        }
    }

    /// The edge that two of some wall faces share within one smooth wall, else the one that is bent most.
    fn edge_to_release(&self, faces: &[FaceNodes]) -> Option<WallEdge> {
        let straight = self.level.straight();
        let mut edges = Vec::new();
        for face in faces {
            for edge in face.edges {
                let nodes: Vec<usize> = edge.iter().map(|&place| face.nodes[place]).collect();
                let inner = &nodes[2..];
                if !inner.iter().all(|&n| self.releasable(n, true) && !self.level.wall.is_released(n)) {
                    continue;
                }
                let smooth = inner.iter().all(|&n| self.releasable(n, false));
                let at = faces.iter().filter(|other| inner.iter().all(|n| other.nodes.contains(n))).count();
                let moved = inner.iter().map(|&n| self.level.wall.displacement(n).length()).fold(0.0, f64::max);
                let bend = moved / straight[nodes[0]].distance(straight[nodes[1]]);
                edges.push(WallEdge { inner: inner.to_vec(), shared: smooth && at > 1, bend });
            }
        }
        edges.into_iter().max_by(|a, b| a.shared.cmp(&b.shared).then(a.bend.total_cmp(&b.bend)))
    }

    /// An element's faces on the CAD.
    fn wall_faces(&self, own: &Element) -> Vec<FaceNodes> {
        let faces = own.sides().filter_map(|side| self.level.case.boundary.face_of(side));
        faces.filter(|&face| self.is_on_cad(face)).map(|face| self.face_nodes(face)).collect()
    }

    /// The faces on the CAD under an element off the wall: those of the first elements with one that are come by, from element to
    /// element through their sides. In layers this is the foot of the element's column.
    fn faces_below(&self, element: ElementId, around: &Incidence<ElementId>) -> Vec<FaceNodes> {
        let cells = self.level.mesh().cells();
        let (mut seen, mut front) = (FxHashSet::from_iter([element]), vec![element]);
        while !front.is_empty() && seen.len() < SOUGHT {
            let mut next = Vec::new();
            for side in front.iter().flat_map(|&e| cells.get(e).sides()) {
                let behind = |e: &&ElementId| cells.get(**e).sides().any(|other| other == side);
                let first = side.corners().first().map_or(&[][..], |n| around.at(n.index()));
                next.extend(first.iter().filter(behind).copied().filter(|&e| seen.insert(e)));
            }
            let faces: Vec<FaceNodes> = next.iter().flat_map(|&e| self.wall_faces(&cells.get(e))).collect();
            if !faces.is_empty() {
                return faces;
            }
            front = next;
        }
        Vec::new()
    }

    fn is_on_cad(&self, face: usize) -> bool {
        matches!(self.level.case.association.faces[face], Classification::Surface(_))
    }

    fn face_nodes(&self, face: usize) -> FaceNodes {
        let (boundary, mesh) = (self.level.case.boundary, self.level.mesh());
        let cell = boundary.faces[face].cell;
        FaceNodes {
            nodes: boundary.nodes(face, mesh).iter().map(|n| n.index()).collect(),
            edges: edge_nodes(cell, mesh.order()),
            inside: interior_start(cell, mesh.order()),
        }
    }

    /// Marks also the nodes of the wall faces that have a marked node.
    fn mark_around(&self, marked: &mut [bool]) {
        let (case, mesh) = (self.level.case, self.level.mesh());
        let mut around = Vec::new();
        for face in 0..case.boundary.faces.len() {
            let nodes = case.boundary.nodes(face, mesh);
            if nodes.iter().any(|n| marked[n.index()]) {
                around.extend(nodes.iter().map(|n| n.index()).filter(|&n| self.releasable(n, true)));
            }
        }
        around.into_iter().for_each(|n| marked[n] = true);
    }
}
