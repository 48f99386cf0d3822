//! Doubled edges of unsewn models: IGES files in surface mode give every face edges of its own. Two open edges that run along each other
//! within tolerance are one edge of the part, whatever the topology says, and so is one that two or more shorter ones cover together.
//! Projection on faces needs none of this.

use crate::geometry::leaf::EdgeGeometry;
use crate::geometry::newton;
use crate::ids::{EdgeId, VertexId};
use crate::model::{Edge, Model, Sewing};
use crate::tolerance::SEWING;
use glam::DVec3;

/// Points inside an edge that are held against another.
const SAMPLES: u32 = 9;

/// Points inside an edge that are held against pieces that may cover it.
const COVER_SAMPLES: u32 = 32;

impl Sewing {
    pub(crate) fn of(model: &Model) -> Self {
        let mut open: Vec<&Edge> = model.edges().iter().filter(|edge| edge.is_open()).collect();
        let mut merged = Vec::new();
        for find in [Model::twins, Model::pieces] {
            let mut taken = vec![false; open.len()];
            for i in 0..open.len() {
                let free: Vec<usize> = (0..open.len()).filter(|&k| k != i && !taken[k]).collect();
                let found = if taken[i] { Vec::new() } else { find(model, open[i], &open, &free) };
                if !found.is_empty() {
                    let mut set: Vec<EdgeId> =
                        std::iter::once(i).chain(found.iter().copied()).map(|k| open[k].id).collect();
                    set.sort_unstable();
                    merged.push(set);
                    taken[i] = true;
                    found.into_iter().for_each(|k| taken[k] = true);
                }
            }
            open = open.into_iter().zip(taken).filter(|(_, taken)| !taken).map(|(edge, _)| edge).collect();
        }
        merged.sort_unstable();
        Self { merged, open: open.into_iter().map(|edge| edge.id).collect() }
    }
}

/// Distance of a point from an edge.
fn distance(edge: &EdgeGeometry, x: DVec3) -> f64 {
    let local = |range: [f64; 2]| newton::on_curve(&edge.curve, range, x, 0.5 * (range[0] + range[1])).distance_squared;
    edge.leaves.iter().map(|leaf| local(leaf.range)).fold(f64::INFINITY, f64::min).sqrt()
}

/// Points strictly inside an edge.
fn samples(edge: &EdgeGeometry, count: u32) -> impl Iterator<Item = DVec3> {
    let at = move |k: u32| edge.range[0] + (edge.range[1] - edge.range[0]) * f64::from(k) / f64::from(count);
    (1..count).map(move |k| edge.curve.d2(at(k))[0])
}

/// Whether points of `one` lie on `other`.
fn follows(one: &EdgeGeometry, other: &EdgeGeometry, count: u32, slack: f64) -> bool {
    samples(one, count).all(|x| distance(other, x) <= slack)
}

impl Model {
    /// Doubled edges and those that stay open, found once and kept.
    pub fn sewing(&self) -> &Sewing {
        self.sewing.get_or_init(|| Sewing::of(self))
    }

    fn place(&self, vertex: Option<VertexId>) -> Option<DVec3> {
        Some(self.vertex(vertex?)?.point)
    }

    /// Among `free` edges, those that have the ends of `edge` and run along it.
    fn twins(&self, edge: &Edge, open: &[&Edge], free: &[usize]) -> Vec<usize> {
        free.iter().copied().filter(|&k| self.are_one(edge, open[k])).collect()
    }

    /// Among `free` edges, those that lie on `edge`, if together they cover it.
    fn pieces(&self, edge: &Edge, open: &[&Edge], free: &[usize]) -> Vec<usize> {
        let Some(whole) = self.curve(edge) else { return Vec::new() };
        let lies_on = |piece: &Edge| {
            let tolerance = self.tolerance(edge, piece);
            let near = edge.bounds.grown(2.0 * tolerance);
            let inside =
                [piece.bounds.min, piece.bounds.max].iter().all(|corner| near.distance_squared(*corner) == 0.0);
            inside && self.curve(piece).is_some_and(|piece| follows(piece, whole, SAMPLES, 2.0 * tolerance))
        };
        let pieces: Vec<usize> = free.iter().copied().filter(|&k| lies_on(open[k])).collect();
        let curves: Vec<_> =
            pieces.iter().filter_map(|&k| Some((self.curve(open[k])?, self.tolerance(edge, open[k])))).collect();
        let covered = samples(whole, COVER_SAMPLES)
            .all(|x| curves.iter().any(|(piece, tolerance)| distance(piece, x) <= 2.0 * tolerance));
        if pieces.len() > 1 && covered { pieces } else { Vec::new() }
    }

    /// Of two edges that run along each other the one that is a piece of the other, the first where they are equally long.
    pub(crate) fn doubled_part(&self, a: &Edge, b: &Edge) -> Option<EdgeId> {
        if a.id == b.id {
            return None;
        }
        let first = if self.are_one(a, b) { a.id < b.id } else { a.bounds.diagonal() < b.bounds.diagonal() };
        let (one, other) = if first { (a, b) } else { (b, a) };
        let slack = 2.0 * self.tolerance(a, b);
        follows(self.curve(one)?, self.curve(other)?, SAMPLES, slack).then_some(one.id)
    }

    fn curve(&self, edge: &Edge) -> Option<&EdgeGeometry> {
        self.geometry().edges[edge.id.index()].as_ref()
    }

    /// The file's tolerances of both edges, at least [`SEWING`].
    fn tolerance(&self, a: &Edge, b: &Edge) -> f64 {
        a.tolerance.max(b.tolerance).max(SEWING * self.diagonal())
    }

    /// Whether two edges have the same ends and run along each other, within tolerance.
    fn are_one(&self, a: &Edge, b: &Edge) -> bool {
        let slack = 2.0 * self.tolerance(a, b);
        let near = |p: Option<DVec3>, q: Option<DVec3>| p.zip(q).is_some_and(|(p, q)| p.distance(q) <= slack);
        let ([a0, a1], [b0, b1]) = (a.ends.map(|v| self.place(v)), b.ends.map(|v| self.place(v)));
        let (along, against) = (near(a0, b0) && near(a1, b1), near(a0, b1) && near(a1, b0));
        if !along && !against {
            return false;
        }
        let (Some(one), Some(other)) = (self.curve(a), self.curve(b)) else { return false };
        follows(one, other, SAMPLES, slack) && follows(other, one, SAMPLES, slack)
    }
}
