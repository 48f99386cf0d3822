//! Carrying the wall's displacement into the volume, equation (1).
//!
//! A node takes the displacement of its *foot* on the linear wall, times a share that falls with the distance `d` to the
//! foot. Two feet are used:
//!
//! * **Roots.** Every linear node has a root, the wall vertex nearest to it along mesh edges. Where the roots of a
//!   node's carrier (the edge, face or cell that it lies in) are corners of one wall face, the foot is the same
//!   barycentric combination of the roots. A layer then moves as one, whatever else is near; in a concave corner the
//!   closest point of the wall jumps from side to side within a layer, and tears it.
//! * **The closest point** of the linear wall, exact, where the roots form no wall face.
//!
//! The displacement is the wall polynomial at the foot. Taking it from the nearest wall node instead is wrong by many
//! times the wall spacing.
//!
//! # The share
//!
//! The paper's `min(1, |P| / d)` falls with slope -1 where `d = |P|`: a bulging wall squeezes the cells there to nothing,
//! and `|P|`, taken point by point, is no polynomial. Here the share is `1 / (1 + (d / (5 R))^2)`, `R` the largest
//! displacement of the wall faces around the foot, linear between wall vertices. Measured on the weeble before any
//! smoothing, min C_WCN / C_JAC (inverted elements):
//!
//! | share | P2 | P4 |
//! |---|---|---|
//! | `min(1, P/d)`, the paper's | -0.04 / -1.10 (1245) | -0.21 / -7.9 (2744) |
//! | `min(1, 4 P/d)` | 0.89 / 0.35 (0) | 0.76 / -0.85 (880) |
//! | `min(1, 4 R/d)` | 0.88 / 0.32 (0) | 0.83 / -0.10 (1) |
//! | `max(0, 1 - d/(10 R))` | 0.94 / 0.57 (0) | 0.89 / 0.61 (0) |
//! | `exp(-(d/(6 R))^2)` | 0.94 / 0.51 (0) | 0.91 / 0.58 (0) |
//! | `1 / (1 + (d/(5 R))^2)` | 0.94 / 0.53 (0) | 0.91 / 0.57 (0) |
//!
//! The straight hat starts as well, but its kinks cut through cells of high order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use cad::{Aabb, BoxTree};
use glam::DVec3;
use rayon::prelude::*;

use crate::element::{Cell, Order, basis};
use crate::elevate::{Carriers, Elevated};
use crate::mesh::{Mesh, NodeId};

/// Reach of the displacement, in sagittas of the wall around the foot.
const REACH: f64 = 5.0;

/// A boundary face of the elevated mesh that moves the nodes around it.
#[derive(Clone, Debug, PartialEq)]
pub struct WallFace {
    /// Triangle or quadrilateral.
    pub cell: Cell,
    /// Its nodes, in internal order.
    pub nodes: Vec<NodeId>,
}

impl WallFace {
    fn corners(&self) -> &[NodeId] {
        &self.nodes[..self.cell.corner_count()]
    }
}

/// Displacements of all nodes: those of `moved` nodes as given in `displacement`, the others carried from the wall.
///
/// `wall` holds the faces whose displacement is carried along; all their nodes are `moved`.
#[must_use]
pub fn perturb(elevated: &Elevated, wall: &[WallFace], displacement: &[DVec3], moved: &[bool]) -> Vec<DVec3> {
    let mut result = displacement.to_vec();
    if wall.is_empty() {
        return result;
    }
    let field = Field::new(&elevated.mesh, elevated.linear_nodes, wall, displacement);
    let vertices: Vec<DVec3> = (0..elevated.linear_nodes)
        .into_par_iter()
        .map(|n| if moved[n] { displacement[n] } else { field.at(&[n], &[1.0]) })
        .collect();
    result[..elevated.linear_nodes].copy_from_slice(&vertices);
    for carriers in &elevated.carriers {
        carry(&field, carriers, moved, &mut result);
    }
    result
}

/// Displacements of the nodes inside edges, faces or cells of one kind.
fn carry(field: &Field, carriers: &Carriers, moved: &[bool], result: &mut [DVec3]) {
    let all: Vec<(&[NodeId], NodeId)> = carriers.iter().collect();
    let own: Vec<Vec<DVec3>> = all
        .par_iter()
        .with_min_len(256)
        .map(|(corners, first)| {
            if (0..carriers.weights().len()).all(|k| moved[first.index() + k]) {
                return Vec::new();
            }
            let corners: Vec<usize> = corners.iter().map(|c| c.index()).collect();
            carriers.weights().iter().map(|weights| field.at(&corners, weights)).collect()
        })
        .collect();
    for ((_, first), own) in all.into_iter().zip(own) {
        for (k, d) in own.into_iter().enumerate() {
            if !moved[first.index() + k] {
                result[first.index() + k] = d;
            }
        }
    }
}

/// The displacement of the wall, ready to be asked at any place.
struct Field<'a> {
    order: Order,
    points: &'a [DVec3],
    wall: &'a [WallFace],
    displacement: &'a [DVec3],
    /// At each wall vertex, the largest displacement of the wall faces around it.
    sagitta: Vec<f64>,
    /// Root of every linear node: a wall vertex; `None` where no path leads to a wall.
    roots: Vec<Option<u32>>,
    /// Wall faces around each wall vertex, by node: ranges of `around`.
    starts: Vec<u32>,
    around: Vec<u32>,
    tree: BoxTree,
}

/// A place on the linear wall: a face and a point of its chart.
#[derive(Clone, Copy)]
struct Foot {
    face: usize,
    at: [f64; 3],
    place: DVec3,
}

impl<'a> Field<'a> {
    fn new(mesh: &'a Mesh, linear_nodes: usize, wall: &'a [WallFace], displacement: &'a [DVec3]) -> Field<'a> {
        let (starts, around) = faces_around(wall, linear_nodes);
        let roots = roots(mesh, linear_nodes, wall);
        let points = &mesh.points[..];
        let boxes: Vec<Aabb> =
            wall.iter().map(|f| Aabb::of_points(f.corners().iter().map(|n| points[n.index()]))).collect();
        let sagitta = sagittas(wall, displacement, linear_nodes);
        Field {
            sagitta,
            order: mesh.order,
            points,
            wall,
            displacement,
            roots,
            starts,
            around,
            tree: BoxTree::new(&boxes),
        }
    }

    /// The displacement at the combination `weights` of linear nodes.
    fn at(&self, corners: &[usize], weights: &[f64]) -> DVec3 {
        let x: DVec3 = corners.iter().zip(weights).map(|(&c, &w)| self.points[c] * w).sum();
        let Some(foot) = self.foot_by_roots(corners, weights).or_else(|| self.closest(x)) else {
            return DVec3::ZERO;
        };
        let face = &self.wall[foot.face];
        let values = basis::values(face.cell, self.order, foot.at);
        let p: DVec3 = face.nodes.iter().zip(values).map(|(n, v)| self.displacement[n.index()] * v).sum();
        p * self.share(face, foot.at, x.distance(foot.place))
    }

    /// `1 / (1 + (d / (REACH R))^2)`, `R` the wall's sagitta around the foot.
    fn share(&self, face: &WallFace, at: [f64; 3], distance: f64) -> f64 {
        let weights = basis::values(face.cell, Order::LINEAR, at);
        let sagitta: f64 = face.corners().iter().zip(weights).map(|(n, w)| self.sagitta[n.index()] * w).sum();
        if sagitta <= 0.0 {
            return 0.0;
        }
        let t = distance / (REACH * sagitta);
        1.0 / (1.0 + t * t)
    }

    /// The combination of the corners' roots, where one wall face has them all.
    fn foot_by_roots(&self, corners: &[usize], weights: &[f64]) -> Option<Foot> {
        let mut own = [0u32; 8];
        for (root, &corner) in own.iter_mut().zip(corners) {
            *root = self.roots[corner]?;
        }
        let own = &own[..corners.len()];
        let first = own[0] as usize;
        let faces = &self.around[self.starts[first] as usize..self.starts[first + 1] as usize];
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
        let found = self.tree.nearest(x, f64::INFINITY, |face| Some(nearest(face).1.distance_squared(x)))?;
        let (at, place) = nearest(found.leaf);
        Some(Foot { face: found.leaf, at, place })
    }
}

/// The closest point of a linear wall face, a quadrilateral taken as two triangles: chart coordinates and place.
fn closest_on_face(face: &WallFace, points: &[DVec3], x: DVec3) -> ([f64; 3], DVec3) {
    let corners = face.corners();
    let at = |q: usize| points[corners[q].index()];
    let unit = |q: usize| DVec3::from(face.cell.corners()[q].map(f64::from));
    let mut best: Option<(f64, [f64; 3], DVec3)> = None;
    for second in 1..corners.len() - 1 {
        let triangle = [0, second, second + 1];
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

/// The largest displacement of the faces around each wall vertex.
fn sagittas(wall: &[WallFace], displacement: &[DVec3], linear_nodes: usize) -> Vec<f64> {
    let mut sagittas = vec![0.0_f64; linear_nodes];
    for face in wall {
        let own = face.nodes.iter().map(|n| displacement[n.index()].length()).fold(0.0, f64::max);
        for corner in face.corners() {
            sagittas[corner.index()] = sagittas[corner.index()].max(own);
        }
    }
    sagittas
}

fn faces_around(wall: &[WallFace], linear_nodes: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; linear_nodes + 1];
    for node in wall.iter().flat_map(WallFace::corners) {
        starts[node.index() + 1] += 1;
    }
    for n in 0..linear_nodes {
        starts[n + 1] += starts[n];
    }
    let mut next = starts.clone();
    let mut around = vec![0; starts[linear_nodes] as usize];
    for (face, own) in wall.iter().enumerate() {
        for node in own.corners() {
            around[next[node.index()] as usize] = face as u32;
            next[node.index()] += 1;
        }
    }
    (starts, around)
}

/// For every linear node the wall vertex at the end of the shortest path along mesh edges (Dijkstra from all wall
/// vertices; ties go to the smaller vertex).
fn roots(mesh: &Mesh, linear_nodes: usize, wall: &[WallFace]) -> Vec<Option<u32>> {
    let (starts, neighbours) = neighbours(mesh, linear_nodes);
    let mut roots: Vec<Option<u32>> = vec![None; linear_nodes];
    let mut length = vec![f64::INFINITY; linear_nodes];
    let mut queue = BinaryHeap::new();
    for node in wall.iter().flat_map(WallFace::corners) {
        if length[node.index()] > 0.0 {
            length[node.index()] = 0.0;
            queue.push(Reverse((Length(0.0), node.index() as u32, node.index() as u32)));
        }
    }
    while let Some(Reverse((Length(so_far), root, node))) = queue.pop() {
        let node = node as usize;
        if roots[node].is_some() {
            continue;
        }
        roots[node] = Some(root);
        for &next in &neighbours[starts[node] as usize..starts[node + 1] as usize] {
            let further = so_far + mesh.points[node].distance(mesh.points[next as usize]);
            if further < length[next as usize] || (further == length[next as usize] && roots[next as usize].is_none()) {
                length[next as usize] = further;
                queue.push(Reverse((Length(further), root, next)));
            }
        }
    }
    roots
}

/// A path's length, ordered.
#[derive(PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Nodes at the other ends of the mesh edges at each linear node.
fn neighbours(mesh: &Mesh, linear_nodes: usize) -> (Vec<u32>, Vec<u32>) {
    let mut pairs: Vec<(u32, u32)> = Vec::new();
    for (_, block) in mesh.blocks_of(3) {
        for nodes in block.elements(mesh.order) {
            for &[a, b] in block.cell.edges() {
                let ends = [nodes[usize::from(a)], nodes[usize::from(b)]].map(|n| n.index() as u32);
                pairs.push((ends[0], ends[1]));
                pairs.push((ends[1], ends[0]));
            }
        }
    }
    pairs.par_sort_unstable();
    pairs.dedup();
    let mut starts = vec![0u32; linear_nodes + 1];
    for &(a, _) in &pairs {
        starts[a as usize + 1] += 1;
    }
    for n in 0..linear_nodes {
        starts[n + 1] += starts[n];
    }
    (starts, pairs.into_iter().map(|(_, b)| b).collect())
}
