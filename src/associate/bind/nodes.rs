//! What linear nodes lie on: the lowest of what their edges and faces do.

use std::collections::BTreeSet;

use cad::{EntityId, VertexId};
use glam::DVec3;

use super::Binder;
use crate::associate::{Candidates, Classification};

/// A node is at no CAD vertex that is farther away than this share of its shortest boundary edge: taken there it would crush cells.
const VERTEX: f64 = 0.5;

impl Binder<'_> {
    pub(super) fn nodes(&mut self, candidates: &Candidates) {
        let mut classifications: Vec<BTreeSet<Rank>> = vec![BTreeSet::new(); self.mesh.points().len()];
        for (edge, ends) in self.boundary.edges.iter().enumerate() {
            for end in ends {
                classifications[end.index()].insert(Rank::of(self.result.edges[edge]));
            }
        }
        for (face, corners) in self.boundary.corners.iter().enumerate() {
            for corner in corners {
                classifications[corner.index()].insert(Rank::of(self.result.faces[face]));
            }
        }
        let shortest = self.shortest_edges();
        self.result.nodes = (0..classifications.len())
            .map(|n| self.lowest(&classifications[n], self.mesh.points()[n], VERTEX * shortest[n]))
            .collect();
        for point in &candidates.points {
            let vertex = point.entities.iter().find_map(|e| vertex_of(*e)).and_then(|id| self.model.vertex(id));
            for node in &point.items {
                let near = |v: &&cad::Vertex| v.point.distance(self.mesh.points()[node.index()]) <= self.slack;
                if let Some(vertex) = vertex.filter(near) {
                    self.result.nodes[node.index()] = Classification::Vertex(vertex.point);
                }
            }
        }
    }

    /// Length of the shortest boundary edge at each node; infinite off the boundary.
    fn shortest_edges(&self) -> Vec<f64> {
        let mut shortest = vec![f64::INFINITY; self.mesh.points().len()];
        for ends in &self.boundary.edges {
            let [a, b] = ends.map(|n| self.mesh.points()[n.index()]);
            ends.iter().for_each(|n| shortest[n.index()] = shortest[n.index()].min(a.distance(b)));
        }
        shortest
    }

    /// The lowest of the classifications around a node, which is at no CAD vertex that is farther away than `limit`.
    fn lowest(&self, around: &BTreeSet<Rank>, x: DVec3, limit: f64) -> Classification {
        let curves: Vec<usize> =
            around.iter().filter_map(|r| if let Rank::Curve(c) = r { Some(*c) } else { None }).collect();
        if self.boundary.plane.is_some() {
            return self.lowest_in_plane(around, x, limit);
        }
        match curves[..] {
            [] => around.first().map_or(Classification::Free, |rank| rank.classification()),
            [only] if self.result.curves[only].group.entities().len() == 1 => Classification::Curve(only),
            [first, ..] => self.vertex(x, limit).map_or(Classification::Curve(first), Classification::Vertex),
        }
    }

    /// The same in a plane mesh: where sides on different edges meet, or on several that go together, there is a vertex.
    fn lowest_in_plane(&self, around: &BTreeSet<Rank>, x: DVec3, limit: f64) -> Classification {
        let lowest = around.first().map_or(Classification::Free, |rank| rank.classification());
        let one = match lowest {
            Classification::Surface(surface) => self.result.surfaces[surface].group.entities().len() == 1,
            _ => true,
        };
        if around.len() < 2 && one { lowest } else { self.vertex(x, limit).map_or(lowest, Classification::Vertex) }
    }

    /// The CAD vertex at a place, within `limit`: where curves meet, or the edges of one curve do, perhaps at an angle.
    fn vertex(&self, x: DVec3, limit: f64) -> Option<DVec3> {
        let near = self.model.vertices().iter().map(|v| (v.point.distance(x), v.point));
        let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.filter(|(distance, _)| *distance <= self.slack.min(limit)).map(|(_, point)| point)
    }
}

/// Classifications without coordinates, lowest first: what a node at the meeting of several takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Curve(usize),
    Straight,
    Surface(usize),
    Plane(usize),
}

impl Rank {
    fn of(classification: Classification) -> Rank {
        match classification {
            Classification::Curve(c) => Rank::Curve(c),
            Classification::Surface(s) => Rank::Surface(s),
            Classification::Plane(p) => Rank::Plane(p),
            Classification::Straight | Classification::Free | Classification::Vertex(_) => Rank::Straight,
        }
    }

    fn classification(self) -> Classification {
        match self {
            Rank::Curve(c) => Classification::Curve(c),
            Rank::Surface(s) => Classification::Surface(s),
            Rank::Plane(p) => Classification::Plane(p),
            Rank::Straight => Classification::Straight,
        }
    }
}

fn vertex_of(entity: EntityId) -> Option<VertexId> {
    if let EntityId::Vertex(id) = entity { Some(id) } else { None }
}
