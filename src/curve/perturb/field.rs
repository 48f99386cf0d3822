//! The displacement of the wall, at any position in the linear mesh.

use cad::{Aabb, BoxTree};
use glam::DVec3;

use super::roots::Roots;
use crate::element::{Cell, Order, basis};
use crate::mesh::elevate::Elevated;
use crate::mesh::{Incidence, NodeId};

/// Reach of the displacement, in displacements of the wall around the foot.
const REACH: f64 = 5.0;
/// Share of the displacement below which there is none: elements that it does not reach stay straight and cost nothing.
const END: f64 = 0.01;
/// Least reach, in shortest edges of the wall faces around the foot.
const LEAST_REACH: f64 = 0.6;

/// A boundary face of the elevated mesh that moves the nodes around it.
#[derive(Clone, Debug, PartialEq)]
pub struct WallFace {
    /// Triangle or quadrilateral; line.
    pub cell: Cell,
    /// Its nodes, in internal order.
    pub nodes: Vec<NodeId>,
}

impl WallFace {
    pub(super) fn corners(&self) -> &[NodeId] {
        &self.nodes[..self.cell.corner_count()]
    }
}

/// The displacement of the wall, at any position.
pub(super) struct Field<'a> {
    order: Order,
    points: &'a [DVec3],
    wall: &'a [WallFace],
    displacement: &'a [DVec3],
    /// At each wall vertex, how far its displacement reaches.
    reach: Vec<f64>,
    /// At each wall vertex, the distance from it at which the displacement must have ended.
    ends: Vec<f64>,
    /// Root of every linear node: a wall vertex.
    roots: Roots,
    /// Wall faces around each wall vertex.
    around: Incidence<u32>,
    /// Faces that closest points are sought on: those all of whose corners are roots.
    sought: Vec<u32>,
    tree: BoxTree,
}

/// A point of the linear wall: a face and a point of it in reference coordinates.
#[derive(Clone, Copy)]
struct Foot {
    face: usize,
    at: [f64; 3],
    place: DVec3,
}

impl<'a> Field<'a> {
    /// The field of `wall`, whose nodes have these displacements: `seeds` tells which linear nodes are wall vertices, `roots`
    /// which of them each linear node hangs on, `beyond` which are beyond the layers that may be curved.
    pub(super) fn new(
        elevated: &'a Elevated,
        wall: &'a [WallFace],
        displacement: &'a [DVec3],
        seeds: &[bool],
        roots: Roots,
        inherited: &[f64],
        beyond: impl Fn(usize) -> bool,
    ) -> Field<'a> {
        let (mesh, linear_nodes) = (&elevated.mesh, elevated.linear_nodes);
        let corners = (0..).zip(wall).flat_map(|(face, own)| own.corners().iter().map(move |n| (n.index(), face)));
        let around = Incidence::new(linear_nodes, corners);
        let points = mesh.points();
        let sought: Vec<u32> =
            (0..wall.len() as u32).filter(|&f| wall[f as usize].corners().iter().all(|n| seeds[n.index()])).collect();
        let bounds = |&f: &u32| Aabb::of_points(wall[f as usize].corners().iter().map(|n| points[n.index()]));
        let boxes: Vec<Aabb> = sought.iter().map(bounds).collect();
        let mut reach = reaches(wall, displacement, mesh.points(), linear_nodes);
        for (own, &inherited) in reach.iter_mut().zip(inherited) {
            *own = own.max(inherited);
        }
        let ends = ends(points, &roots.of, beyond);
        Field {
            reach,
            ends,
            order: mesh.order(),
            points,
            wall,
            displacement,
            roots,
            around,
            sought,
            tree: BoxTree::new(&boxes),
        }
    }

    /// For every linear node the reach at its root: a plane that is carried by a wall carries the volume as far as the wall does.
    pub(super) fn reach_of_roots(&self) -> Vec<f64> {
        self.roots.of.iter().map(|root| root.map_or(0.0, |root| self.reach[root as usize])).collect()
    }

    /// Distance to the wall along mesh edges at the combination `weights` of linear nodes; not finite where no path leads to it.
    ///
    /// A cell in a corner of the wall has all its nodes on it, on different faces: no less than the distance to the closest point.
    pub(super) fn distance(&self, corners: &[usize], weights: &[f64]) -> f64 {
        let along_edges = corners.iter().zip(weights).map(|(&c, &w)| self.roots.length[c] * w).sum();
        if self.foot_by_roots(corners, weights).is_some() {
            return along_edges;
        }
        let x = self.position(corners, weights);
        self.closest(x).map_or(along_edges, |foot| foot.place.distance(x).max(along_edges))
    }

    fn position(&self, corners: &[usize], weights: &[f64]) -> DVec3 {
        corners.iter().zip(weights).map(|(&c, &w)| self.points[c] * w).sum()
    }

    /// The displacement at the combination `weights` of linear nodes.
    pub(super) fn at(&self, corners: &[usize], weights: &[f64]) -> DVec3 {
        let x = self.position(corners, weights);
        let Some(foot) = self.foot_by_roots(corners, weights).or_else(|| self.closest(x)) else {
            return DVec3::ZERO;
        };
        let face = &self.wall[foot.face];
        let values = basis::values(face.cell, self.order, foot.at);
        let p: DVec3 = face.nodes.iter().zip(values).map(|(n, v)| self.displacement[n.index()] * v).sum();
        p * self.share(face, foot.at, x.distance(foot.place))
    }

    /// `1 / (1 + (d / reach)^2)`, less [`END`] and none beyond; where the displacement must end at a distance `e`, times
    /// `1 - (d / e)^2`.
    fn share(&self, face: &WallFace, at: [f64; 3], distance: f64) -> f64 {
        let weights = basis::values(face.cell, Order::LINEAR, at);
        let mean = |of: &[f64]| face.corners().iter().zip(&weights).map(|(n, w)| of[n.index()] * w).sum::<f64>();
        let t = distance / mean(&self.reach);
        let share = ((1.0 / (1.0 + t * t) - END) / (1.0 - END)).max(0.0);
        if self.ends.is_empty() {
            return share;
        }
        let t = distance / mean(&self.ends);
        share * (1.0 - t * t).max(0.0)
    }

    /// The combination of the corners' roots, where one wall face has them all.
    fn foot_by_roots(&self, corners: &[usize], weights: &[f64]) -> Option<Foot> {
        let mut own = [0u32; 8];
        for (root, &corner) in own.iter_mut().zip(corners) {
            *root = self.roots.of[corner]?;
        }
        let own = &own[..corners.len()];
        let first = own[0] as usize;
        let faces = self.around.at(first);
        let local = |face: &WallFace, root: u32| face.corners().iter().position(|n| n.index() == root as usize);
        let face = *faces.iter().find(|&&f| own.iter().all(|&r| local(&self.wall[f as usize], r).is_some()))?;
        let wall = &self.wall[face as usize];
        let mut at = [0.0; 3];
        let mut place = DVec3::ZERO;
        for (&root, &weight) in own.iter().zip(weights) {
            let corner = wall.cell.corners()[local(wall, root)?];
            for (x, c) in at.iter_mut().zip(corner) {
                *x += weight * f64::from(c);
            }
            place += self.points[root as usize] * weight;
        }
        Some(Foot { face: face as usize, at, place })
    }

    /// The closest point of the linear wall.
    fn closest(&self, x: DVec3) -> Option<Foot> {
        let nearest = |face: usize| closest_on_face(&self.wall[face], self.points, x);
        let found = self
            .tree
            .nearest(x, f64::INFINITY, |leaf| Some(nearest(self.sought[leaf] as usize).1.distance_squared(x)))?;
        let face = self.sought[found.leaf] as usize;
        let (at, place) = nearest(face);
        Some(Foot { face, at, place })
    }
}

/// The closest point of a linear wall face, a quadrilateral taken as two triangles: reference coordinates and position. A line is a
/// triangle that ends where it began.
fn closest_on_face(face: &WallFace, points: &[DVec3], x: DVec3) -> ([f64; 3], DVec3) {
    let corners = face.corners();
    let at = |q: usize| points[corners[q].index()];
    let unit = |q: usize| DVec3::from(face.cell.corners()[q].map(f64::from));
    let mut best: Option<(f64, [f64; 3], DVec3)> = None;
    for second in 1..(corners.len() - 1).max(2) {
        let triangle = [0, second, (second + 1) % corners.len()];
        let weights = closest_on_triangle(x, triangle.map(at));
        let mix = |value: &dyn Fn(usize) -> DVec3| -> DVec3 {
            triangle.iter().zip(weights).map(|(&q, w)| value(q) * w).sum()
        };
        let place = mix(&at);
        let distance = place.distance_squared(x);
        if best.is_none_or(|(least, ..)| distance < least) {
            best = Some((distance, mix(&unit).to_array(), place));
        }
    }
    best.map_or(([0.0; 3], at(0)), |(_, at, place)| (at, place))
}

/// Barycentric coordinates of the point of a triangle closest to `x` (Ericson, *Real-Time Collision Detection* §5.1.5).
fn closest_on_triangle(x: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac, ax) = (b - a, c - a, x - a);
    let (d1, d2) = (ab.dot(ax), ac.dot(ax));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bx = x - b;
    let (d3, d4) = (ab.dot(bx), ac.dot(bx));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let cx = x - c;
    let (d5, d6) = (ab.dot(cx), ac.dot(cx));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let sum = va + vb + vc;
    [va / sum, vb / sum, vc / sum]
}

/// At each wall vertex the reach of the faces around it: the largest of [`REACH`] displacements and [`LEAST_REACH`] shortest
/// edges.
fn reaches(wall: &[WallFace], displacement: &[DVec3], points: &[DVec3], linear_nodes: usize) -> Vec<f64> {
    let mut reaches = vec![0.0_f64; linear_nodes];
    for face in wall {
        let corners = face.corners();
        let farthest = face.nodes.iter().map(|n| displacement[n.index()].length()).fold(0.0, f64::max);
        let edges = face.cell.edges().iter().map(|&[a, b]| {
            let [a, b] = [a, b].map(|q| points[corners[usize::from(q)].index()]);
            a.distance(b)
        });
        let own = (REACH * farthest).max(LEAST_REACH * edges.fold(f64::INFINITY, f64::min));
        for corner in corners {
            reaches[corner.index()] = reaches[corner.index()].max(own);
        }
    }
    reaches
}

/// At each root the distance of the nearest of its nodes beyond the layers that may be curved; nothing where all may be.
fn ends(points: &[DVec3], roots: &[Option<u32>], beyond: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut ends = Vec::new();
    for (n, root) in roots.iter().enumerate().filter(|(n, _)| beyond(*n)) {
        ends.resize(roots.len(), f64::MAX);
        if let Some(root) = root.map(|root| root as usize) {
            ends[root] = ends[root].min(points[n].distance(points[root]));
        }
    }
    ends
}
