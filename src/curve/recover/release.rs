//! Release: wall nodes that make elements impossible leave the CAD, as few and as little as it takes.
//!
//! An element with two faces on one smooth wall cannot be valid while all its edges there follow it, whatever the volume does: at their
//! common corner `det J` goes to zero, and its sign is that of the wall's curvature. To free the one node between the ends of the edge
//! that the two faces share is enough: it is drawn back to its place by a spring, and the smoother finds the least it must give.

use glam::DVec3;

use super::recovery::Recovery;
use crate::associate::Classification;
use crate::curve::start::start;
use crate::element::interior_start;
use crate::mesh::{Element, ElementId};

/// Which wall nodes of an element that fails are released, none of them a linear one; each goes where the one before was not enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reach {
    /// Inside the edges that two of its wall faces share.
    SharedEdge,
    /// All those inside CAD faces; where it has none, those nearest to its nodes.
    Element,
    /// Those on CAD curves as well, and those of the wall faces around.
    Around,
}

/// The nodes of a boundary face.
struct FaceNodes {
    nodes: Vec<usize>,
    /// From where on they lie inside the face.
    inside: usize,
}

impl Recovery<'_, '_> {
    /// Releases wall nodes at the elements that fail or are below the floor.
    pub(super) fn release(&mut self) {
        let settings = self.level.case.settings.smoothing.clone();
        for reach in [Reach::SharedEdge, Reach::Element, Reach::Around] {
            let poor = self.below(self.level.case.settings.floor);
            if poor.is_empty() || self.smoothed.stopped {
                break;
            }
            if self.release_at(&poor, reach) {
                self.begin_anew();
                self.smooth_again(&settings);
            }
        }
    }

    /// Elements that fail, or have a cost below the floor; rising.
    pub(super) fn below(&self, floor: f64) -> Vec<ElementId> {
        let mut poor = self.proof.failing(self.level);
        let costs = self.level.mesh().cells().ids().zip(&self.smoothed.costs);
        poor.extend(costs.filter(|(_, cost)| cost.worst() < floor).map(|(e, _)| e));
        poor.sort_unstable();
        poor.dedup();
        poor
    }

    /// Releases wall nodes at some elements; whether there were any that are still held.
    fn release_at(&mut self, elements: &[ElementId], reach: Reach) -> bool {
        let mut marked = vec![false; self.level.curved.len()];
        for &e in elements {
            self.mark(e, reach, &mut marked);
        }
        if reach == Reach::Around {
            self.mark_around(&mut marked);
        }
        self.level.periodic.spread(&mut marked);
        let nodes: Vec<usize> = (0..marked.len()).filter(|&n| marked[n] && !self.level.wall.is_released(n)).collect();
        nodes.iter().for_each(|&n| self.level.wall.release(n));
        !nodes.is_empty()
    }

    /// Begins the order anew, released nodes where they are in the fallback mesh: they come towards the CAD from a valid mesh, not from
    /// one that was bent to make room for what cannot be.
    fn begin_anew(&mut self) {
        let released: Vec<usize> = self.level.wall.released().collect();
        let places: Vec<DVec3> = released.iter().map(|&n| self.level.wall.displacement(n)).collect();
        for &n in &released {
            self.level.wall.displace(n, self.fallback.positions[n] - self.level.straight()[n]);
        }
        self.level.curved = start(self.level, self.below);
        released.iter().zip(places).for_each(|(&n, place)| self.level.wall.displace(n, place));
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

    /// Marks the nodes of an element that are in reach.
    fn mark(&self, element: ElementId, reach: Reach, marked: &mut [bool]) {
        let own = self.level.mesh().cells().get(element);
        if reach == Reach::SharedEdge {
            return self.mark_shared(&self.wall_faces(&own), marked);
        }
        let mut found = false;
        for n in own.nodes.iter().map(|n| n.index()).filter(|&n| self.releasable(n, reach == Reach::Around)) {
            marked[n] = true;
            found = true;
        }
        if !found {
            self.mark_below(&own, marked);
        }
    }

    /// Marks the nodes that two of some wall faces share, and those inside these faces, which are off the CAD then anyway.
    fn mark_shared(&self, faces: &[FaceNodes], marked: &mut [bool]) {
        for (k, one) in faces.iter().enumerate() {
            for other in &faces[..k] {
                let common = one.nodes.iter().filter(|n| other.nodes.contains(n));
                let common: Vec<usize> = common.copied().filter(|&n| self.releasable(n, false)).collect();
                if !common.is_empty() {
                    let inside = one.nodes[one.inside..].iter().chain(&other.nodes[other.inside..]);
                    common.iter().chain(inside).for_each(|&n| marked[n] = true);
                }
            }
        }
    }

    /// An element's faces on curved walls.
    fn wall_faces(&self, own: &Element) -> Vec<FaceNodes> {
        let (case, mesh) = (self.level.case, self.level.mesh());
        let on_wall = |face: &usize| {
            let classification = case.association.faces[*face];
            matches!(classification, Classification::Surface(_)) && case.association.plane_of(classification).is_none()
        };
        let faces = own.sides().filter_map(|side| case.boundary.face_of(side)).filter(on_wall);
        let nodes = |face: usize| FaceNodes {
            nodes: case.boundary.nodes(face, mesh).iter().map(|n| n.index()).collect(),
            inside: interior_start(case.boundary.faces[face].cell, mesh.order()),
        };
        faces.map(nodes).collect()
    }

    /// Marks the wall node nearest to each node of an element off the wall.
    fn mark_below(&self, own: &Element, marked: &mut [bool]) {
        let straight = self.level.straight();
        for node in own.nodes.iter().filter(|n| n.index() >= self.level.elevated.linear_nodes) {
            let distance = |n: &usize| straight[*n].distance_squared(straight[node.index()]);
            let wall = (0..self.level.wall.len()).filter(|&n| self.level.on_curved_wall(n));
            let nearest = wall.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(n) = nearest.filter(|&n| self.releasable(n, false)) {
                marked[n] = true;
            }
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
