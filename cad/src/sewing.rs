//! Doubled edges of unsewn models: IGES files in surface mode give every face edges of its own. Two open edges that run along each other
//! within tolerance are one edge of the part, whatever the topology says. Projection on faces needs none of this.

use crate::ids::{EdgeId, VertexId};
use crate::leaf::EdgeGeometry;
use crate::model::{Edge, Model};
use crate::newton;
use crate::tolerance::SEWING;
use glam::DVec3;

/// Points inside an edge that are held against another.
const SAMPLES: u32 = 9;

/// Which open edges are one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sewing {
    /// Sets of edges that are the same curve within tolerance, each ascending, ordered by their first.
    pub merged: Vec<Vec<EdgeId>>,
    /// Edges that bound one face, on one side, and match no other.
    pub open: Vec<EdgeId>,
}

impl Sewing {
    pub(crate) fn of(model: &Model) -> Self {
        let open: Vec<&Edge> = model.edges().iter().filter(|edge| is_open(edge)).collect();
        let mut sewing = Self::default();
        let mut taken = vec![false; open.len()];
        for (i, edge) in open.iter().enumerate() {
            if taken[i] {
                continue;
            }
            let twins: Vec<usize> =
                (i + 1..open.len()).filter(|&k| !taken[k] && model.are_one(edge, open[k])).collect();
            twins.iter().for_each(|&k| taken[k] = true);
            if twins.is_empty() {
                sewing.open.push(edge.id);
            } else {
                let ids = std::iter::once(i).chain(twins).map(|k| open[k].id);
                sewing.merged.push(ids.collect());
            }
        }
        sewing
    }

    /// All edges that are the same as `edge`, itself included.
    pub fn same_as(&self, edge: EdgeId) -> Vec<EdgeId> {
        let set = self.merged.iter().find(|set| set.contains(&edge));
        set.cloned().unwrap_or_else(|| vec![edge])
    }
}

fn is_open(edge: &Edge) -> bool {
    edge.faces.len() == 1 && !edge.seam && !edge.degenerate
}

/// Distance of a point from an edge.
fn distance(edge: &EdgeGeometry, x: DVec3) -> f64 {
    let local = |range: [f64; 2]| newton::on_curve(&edge.curve, range, x, 0.5 * (range[0] + range[1])).distance_squared;
    edge.leaves.iter().map(|leaf| local(leaf.range)).fold(f64::INFINITY, f64::min).sqrt()
}

impl Model {
    /// Doubled edges and those that stay open, found once and kept.
    pub fn sewing(&self) -> &Sewing {
        self.sewing.get_or_init(|| Sewing::of(self))
    }

    fn place(&self, vertex: Option<VertexId>) -> Option<DVec3> {
        Some(self.vertex(vertex?)?.point)
    }

    /// Whether two edges have the same ends and run along each other, within the file's tolerances of both (at least [`SEWING`]).
    fn are_one(&self, a: &Edge, b: &Edge) -> bool {
        let tolerance = a.tolerance.max(b.tolerance).max(SEWING * self.diagonal());
        let near = |p: Option<DVec3>, q: Option<DVec3>| p.zip(q).is_some_and(|(p, q)| p.distance(q) <= 2.0 * tolerance);
        let ([a0, a1], [b0, b1]) = (a.ends.map(|v| self.place(v)), b.ends.map(|v| self.place(v)));
        let (along, against) = (near(a0, b0) && near(a1, b1), near(a0, b1) && near(a1, b0));
        if !along && !against {
            return false;
        }
        let geometry = |edge: &Edge| self.geometry().edges[edge.id.index()].as_ref();
        let (Some(one), Some(other)) = (geometry(a), geometry(b)) else { return false };
        let follows = |one: &EdgeGeometry, other: &EdgeGeometry| {
            (1..SAMPLES).all(|k| {
                let t = one.range[0] + (one.range[1] - one.range[0]) * f64::from(k) / f64::from(SAMPLES);
                distance(other, one.curve.d2(t)[0]) <= 2.0 * tolerance
            })
        };
        follows(one, other) && follows(other, one)
    }
}
