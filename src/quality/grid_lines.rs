//! How smooth grid lines off the wall are: the angles at which they bend from layer to layer.
//!
//! A *grid line* begins at a boundary node with the edge off the boundary that is nearest to the boundary's normal, and goes
//! on, node by node, along the edge that continues its direction best. It ends where the layers do: its edges are
//! shorter than [`FLAT`] times the boundary's edges at its foot, and no edge bends off the last by more than [`SHARP`] in the
//! linear mesh. The *grid-line angle* at each of its inner nodes is that between the tangents of the two curved edges that
//! meet there; 0 where the line goes straight on.

use glam::DVec3;
use rayon::prelude::*;

use crate::element::{Cell, basis, edge_nodes};
use crate::mesh::{ElementId, Elements, Incidence, Mesh, NodeId};

/// Longest edge of a grid line, as a fraction of the mean boundary edge at its foot.
const FLAT: f64 = 0.5;
/// Cosine of the largest angle of a grid line in the linear mesh, and of its first edge with the normal: 45 degrees.
const SHARP: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Most edges of a grid line.
const LONGEST: usize = 1000;

/// Angles at the inner nodes of grid lines, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridLineAngles {
    /// Number of grid lines with at least one inner node.
    pub lines: usize,
    /// Number of angles: inner nodes of grid lines.
    pub angles: usize,
    /// The angle that 99 % of the angles do not exceed.
    pub p99: f64,
    /// The largest angle.
    pub max: f64,
}

/// An edge of the volume, seen from one of its ends.
#[derive(Clone, Copy)]
struct Ray {
    from: NodeId,
    to: NodeId,
    /// An element that has the edge, and which of its edges it is.
    element: ElementId,
    edge: u8,
}

/// The grid lines of a mesh: each the rays that follow each other.
pub struct GridLines<'a> {
    cells: Elements<'a>,
    lines: Vec<Vec<Ray>>,
}

impl<'a> GridLines<'a> {
    /// Finds the grid lines of `mesh`, an elevated mesh, in its unperturbed state: `straight` are the coordinates of its nodes then.
    /// Its sides are the boundary.
    #[must_use]
    pub fn new(mesh: &'a Mesh, straight: &[DVec3]) -> GridLines<'a> {
        let rays = Rays::new(mesh);
        let feet = feet(mesh, straight);
        let lines = feet.par_iter().map(|foot| line(&rays, foot, straight));
        GridLines { lines: lines.filter(|line| line.len() > 1).collect(), cells: rays.cells }
    }

    /// Angles between curved edges, their nodes at `x`.
    #[must_use]
    pub fn curved(&self, x: &[DVec3]) -> GridLineAngles {
        let order = self.cells.order();
        let slopes = [0.0, 1.0].map(|s| basis::gradients(Cell::Line, order, [s, 0.0, 0.0]));
        let tangent = |ray: &Ray, at_end: bool| {
            let own = self.cells.get(ray.element);
            let (nodes, edge) = (own.nodes, &edge_nodes(own.cell, order)[usize::from(ray.edge)]);
            let forth = nodes[edge[0]] == ray.from;
            let table = &slopes[usize::from(at_end == forth)];
            let along: DVec3 = edge.iter().zip(table).map(|(&n, slope)| x[nodes[n].index()] * slope[0]).sum();
            if forth { along } else { -along }
        };
        self.angles(|below, above| angle(tangent(below, true), tangent(above, false)))
    }

    /// Angles between straight edges, their corners at `x`.
    #[must_use]
    pub fn linear(&self, x: &[DVec3]) -> GridLineAngles {
        let along = |ray: &Ray| x[ray.to.index()] - x[ray.from.index()];
        self.angles(|below, above| angle(along(below), along(above)))
    }

    fn angles(&self, angle: impl Fn(&Ray, &Ray) -> f64 + Sync) -> GridLineAngles {
        let of_line = |line: &'_ Vec<Ray>| line.windows(2).map(|w| angle(&w[0], &w[1])).collect::<Vec<_>>();
        let mut angles: Vec<f64> = self.lines.par_iter().flat_map_iter(of_line).collect();
        angles.par_sort_unstable_by(f64::total_cmp);
        let rank = (angles.len() * 99).div_ceil(100).max(1) - 1;
        GridLineAngles {
            lines: self.lines.len(),
            angles: angles.len(),
            p99: angles.get(rank).copied().unwrap_or(0.0),
            max: angles.last().copied().unwrap_or(0.0),
        }
    }
}

/// The angle between two vectors, in degrees; exact for small angles too.
fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b)).to_degrees()
}

/// The cells around every corner, from which rays are read.
struct Rays<'a> {
    cells: Elements<'a>,
    around: Incidence<ElementId>,
}

impl<'a> Rays<'a> {
    fn new(mesh: &'a Mesh) -> Rays<'a> {
        let cells = mesh.cells();
        let last = cells.iter().flat_map(|own| own.corners()).max().map_or(0, |n| n.index() + 1);
        let pairs = cells.iter().flat_map(|own| own.corners().iter().map(move |n| (n.index(), own.id)));
        let around = Incidence::new(last, pairs);
        Rays { cells, around }
    }

    /// The rays from a node, each once, by their other ends.
    fn from(&self, node: NodeId) -> Vec<Ray> {
        let mut rays = Vec::new();
        for &element in self.around.at(node.index()) {
            let own = self.cells.get(element);
            for (edge, [a, b]) in own.edges().enumerate() {
                for (from, to) in [(a, b), (b, a)].into_iter().filter(|(from, _)| *from == node) {
                    rays.push(Ray { from, to, element, edge: edge as u8 });
                }
            }
        }
        rays.sort_unstable_by_key(|ray| (ray.to, ray.element));
        rays.dedup_by_key(|ray| ray.to);
        rays
    }
}

/// Where a grid line may begin.
struct Foot {
    node: NodeId,
    /// Unit normal of the boundary, to either side.
    normal: DVec3,
    /// Longest edge of the line.
    longest: f64,
    /// Neighbours on the boundary, sorted.
    ring: Vec<NodeId>,
}

fn feet(mesh: &Mesh, x: &[DVec3]) -> Vec<Foot> {
    let mut sides = Vec::new();
    let plane = mesh.plane(x);
    for side in mesh.sides().iter() {
        let corners = side.corners();
        for (n, &node) in corners.iter().enumerate() {
            let (next, last) = (corners[(n + 1) % corners.len()], corners[(n + corners.len() - 1) % corners.len()]);
            let [at, u, v] = [node, next, last].map(|n| x[n.index()]);
            let normal = plane.map_or_else(
                || (u - at).cross(v - at),
                |plane| (u - at).cross(plane.normal) * if n == 0 { 1.0 } else { -1.0 },
            );
            sides.push((node, next, last, normal.normalize_or_zero()));
        }
    }
    sides.sort_by_key(|side| (side.0, side.1, side.2));
    sides.chunk_by(|a, b| a.0 == b.0).map(|around| foot(around, x)).collect()
}

fn foot(around: &[(NodeId, NodeId, NodeId, DVec3)], x: &[DVec3]) -> Foot {
    let node = around[0].0;
    let mut ring: Vec<NodeId> = around.iter().flat_map(|side| [side.1, side.2]).collect();
    ring.sort_unstable();
    ring.dedup();
    let mean = ring.iter().map(|n| x[n.index()].distance(x[node.index()])).sum::<f64>() / ring.len() as f64;
    let normal = around.iter().map(|side| side.3).sum::<DVec3>().normalize_or_zero();
    Foot { node, normal, longest: FLAT * mean, ring }
}

/// The rays of the grid line from a foot; empty where there are no layers.
fn line(rays: &Rays, foot: &Foot, x: &[DVec3]) -> Vec<Ray> {
    let along = |ray: &Ray| x[ray.to.index()] - x[ray.from.index()];
    let from = |node: NodeId| rays.from(node).into_iter().filter(|ray| along(ray).length() < foot.longest);
    let straightest = |a: &(f64, Ray), b: &(f64, Ray)| a.0.total_cmp(&b.0).then(b.1.to.cmp(&a.1.to));
    let enough = |&(cosine, _): &(f64, Ray)| cosine >= SHARP;
    let rising = from(foot.node).filter(|ray| foot.ring.binary_search(&ray.to).is_err());
    let first = rising.map(|ray| (along(&ray).normalize_or_zero().dot(foot.normal).abs(), ray));
    let mut line = Vec::new();
    let mut next = first.max_by(straightest).filter(enough);
    while let Some((_, ray)) = next.filter(|_| line.len() < LONGEST) {
        line.push(ray);
        let direction = along(&ray).normalize_or_zero();
        let onward = from(ray.to).map(|ray| (along(&ray).normalize_or_zero().dot(direction), ray));
        next = onward.max_by(straightest).filter(enough);
    }
    line
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::{Order, lattice};
    use crate::mesh::{Block, EntityKey, Parts};

    /// Three hexes of height 0.1 on a unit square, the first's bottom on the boundary:
    ///
    /// ```text
    /// z = 0.3 +-----+
    ///         |     |   grid lines at the square's corners
    /// z = 0.0 +=====+   wall
    /// ```
    fn stack(order: Order) -> Mesh {
        let p = order.get();
        let node = |[i, j, k]: [usize; 3]| NodeId::new((k * (p + 1) + j) * (p + 1) + i).unwrap_or_default();
        let mut points = Vec::new();
        for k in 0..=3 * p {
            for (j, i) in (0..=p).flat_map(|j| (0..=p).map(move |i| (j, i))) {
                points.push(DVec3::new(i as f64, j as f64, 0.1 * k as f64) / p as f64);
            }
        }
        let hexes = (0..3).flat_map(|layer| {
            lattice(Cell::Hex, order).iter().map(move |at| {
                let [i, j, k] = at.map(usize::from);
                node([i, j, k + layer * p])
            })
        });
        let wall = lattice(Cell::Quad, order).iter().map(|at| node(at.map(usize::from)));
        let entity = |cell: Cell| EntityKey::new(cell.dimension() as u8, 1);
        let block = |cell, tags, nodes| Block { tags, nodes, ..Block::new(cell, entity(cell)) };
        let blocks = vec![block(Cell::Hex, vec![1, 2, 3], hexes.collect()), block(Cell::Quad, vec![4], wall.collect())];
        Mesh::new(Parts { order, points, blocks, ..Parts::default() }).unwrap()
    }

    #[test]
    fn straight_grid_lines_have_no_angles() {
        for order in Order::all() {
            let mesh = stack(order);
            let lines = GridLines::new(&mesh, mesh.points());
            for angles in [lines.curved(mesh.points()), lines.linear(mesh.points())] {
                assert_eq!((angles.lines, angles.angles), (4, 8), "{order}");
                assert!(angles.max < 1e-9, "{order}: {angles:?}");
            }
        }
    }

    /// Each layer's line is the parabola `x += 4 b s (1 - s)`, `s` from 0 to 1 across the layer: its tangents lean by
    /// `atan(4 b / 0.1)` one way at the top and the other way at the next layer's bottom.
    #[test]
    fn kinked_grid_lines_have_the_known_angle() {
        for order in Order::all().skip(1) {
            let mesh = stack(order);
            let bow = 0.01;
            let bent = |x: &DVec3| {
                let s = (x.z / 0.1 + 1e-9).fract() - 1e-9;
                *x + DVec3::X * (4.0 * bow * s * (1.0 - s))
            };
            let x: Vec<DVec3> = mesh.points().iter().map(bent).collect();
            let lines = GridLines::new(&mesh, mesh.points());
            let expected = 2.0 * (4.0 * bow / 0.1f64).atan().to_degrees();
            let angles = lines.curved(&x);
            assert!((angles.max - expected).abs() < 1e-5 && (angles.p99 - expected).abs() < 1e-5, "{angles:?}");
            assert!(lines.linear(&x).max < 1e-5);
        }
    }

    #[test]
    fn there_are_no_grid_lines_without_layers() {
        let mut mesh = stack(Order::LINEAR);
        mesh.points_mut().iter_mut().for_each(|x| x.z *= 10.0);
        assert_eq!(GridLines::new(&mesh, mesh.points()).linear(mesh.points()), GridLineAngles::default());
    }
}
