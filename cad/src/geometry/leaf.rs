//! Faces and edges cut into leaves: small pieces with a hull box each and, where possible, a certificate.

use crate::boxes::Aabb;
use crate::geometry::certificate::Certificate;
use crate::geometry::chart::{Chart, Rect, SurfaceHandle};
use crate::geometry::curve::{Curve, CurveHandle, Hull};
use crate::geometry::slab::Slab;
use crate::geometry::trim::Trim;
use crate::tolerance::{LEAF_DEPTH, LEAF_TURN, POINT, TRIM_DEPTH};
use opencascade_sys as sys;

/// A piece of a face.
#[derive(Clone, Debug)]
pub(crate) struct FaceLeaf {
    pub(crate) rect: Rect,
    pub(crate) bounds: Aabb,
    pub(crate) slab: Slab,
    pub(crate) certificate: Option<Certificate>,
    /// The trim passes through: a foot in here must be held against it.
    pub(crate) crossed: bool,
    pub(crate) sound: bool,
}

/// A piece of an edge.
#[derive(Clone, Debug)]
pub(crate) struct EdgeLeaf {
    pub(crate) range: [f64; 2],
    pub(crate) bounds: Aabb,
    pub(crate) slab: Slab,
    pub(crate) certificate: Option<Certificate>,
    pub(crate) sound: bool,
}

/// One use of an edge by a face.
pub(crate) struct Side {
    /// Edge number; `None` where the edge is not among those of the model.
    pub(crate) edge: Option<usize>,
    pub(crate) wire: i32,
    pub(crate) seam: bool,
    /// Range of the pcurve.
    pub(crate) range: [f64; 2],
    pub(crate) pcurve: sys::UniquePtr<sys::Pcurve>,
}

/// All that queries need of one face.
pub(crate) struct FaceGeometry {
    pub(crate) handle: SurfaceHandle,
    pub(crate) chart: Chart,
    pub(crate) rect: Rect,
    pub(crate) trim: Trim,
    pub(crate) sides: Vec<Side>,
    pub(crate) leaves: Vec<FaceLeaf>,
    pub(crate) reversed: bool,
}

/// All that queries need of one edge that has a curve.
pub(crate) struct EdgeGeometry {
    pub(crate) handle: CurveHandle,
    pub(crate) curve: Curve,
    pub(crate) range: [f64; 2],
    pub(crate) tolerance: f64,
    pub(crate) leaves: Vec<EdgeLeaf>,
}

impl FaceLeaf {
    pub(crate) fn new(chart: &Chart, rect: Rect, crossed: bool) -> Self {
        let hull = chart.hull(rect);
        let closed_form = matches!(chart, Chart::Plane { .. } | Chart::Spun { flat: true, .. });
        let certificate = if closed_form { None } else { Certificate::of_surface(chart, &rect, &hull) };
        let jet = chart.d2_within(&rect, rect.center());
        let slab = Slab::new(&hull, jet[1], jet[2]);
        Self { rect, bounds: hull.bounds(), slab, certificate, crossed, sound: hull.sound }
    }
}

impl EdgeLeaf {
    pub(crate) fn new(curve: &Curve, range: [f64; 2]) -> Self {
        let hull: Hull = curve.hull(range[0], range[1]);
        let certificate = Certificate::of_curve(curve, range, &hull);
        let [_, d, dd] = curve.d2(0.5 * (range[0] + range[1]));
        Self { range, bounds: hull.bounds(), slab: Slab::new(&hull, d, dd), certificate, sound: hull.sound }
    }

    pub(crate) fn halves(&self, curve: &Curve) -> [Self; 2] {
        let [a, b] = self.range;
        let middle = 0.5 * (a + b);
        [Self::new(curve, [a, middle]), Self::new(curve, [middle, b])]
    }
}

fn is_flat(certificate: Option<&Certificate>) -> bool {
    certificate.is_some_and(|c| c.turn() < LEAF_TURN)
}

/// Leaves of a face: the smooth pieces of its parameter range, cut until flat, those outside the trim dropped.
pub(crate) fn face_leaves(chart: &Chart, rect: Rect, trim: &Trim) -> Vec<FaceLeaf> {
    let mut leaves = Vec::new();
    for piece in chart.pieces(rect) {
        let crossed = trim.enters(&piece);
        cut_face(chart, trim, FaceLeaf::new(chart, piece, crossed), 0, &mut leaves);
    }
    leaves
}

fn cut_face(chart: &Chart, trim: &Trim, leaf: FaceLeaf, depth: u32, leaves: &mut Vec<FaceLeaf>) {
    if !leaf.crossed && !trim.contains(leaf.rect.center()) {
        return;
    }
    let closed_form = matches!(chart, Chart::Plane { .. } | Chart::Spun { flat: true, .. });
    let flat = closed_form || is_flat(leaf.certificate.as_ref()) || leaf.bounds.diagonal() < POINT;
    if (flat && (!leaf.crossed || depth >= TRIM_DEPTH)) || depth >= LEAF_DEPTH {
        leaves.push(leaf);
        return;
    }
    for half in leaf.rect.halves(chart.direction(&leaf.rect)) {
        let crossed = leaf.crossed && trim.enters(&half);
        cut_face(chart, trim, FaceLeaf::new(chart, half, crossed), depth + 1, leaves);
    }
}

/// Leaves of an edge: its smooth pieces, cut until flat.
pub(crate) fn edge_leaves(curve: &Curve, range: [f64; 2]) -> Vec<EdgeLeaf> {
    let mut leaves = Vec::new();
    for [a, b] in curve.pieces(range[0], range[1]) {
        cut_edge(curve, EdgeLeaf::new(curve, [a, b]), 0, &mut leaves);
    }
    leaves
}

fn cut_edge(curve: &Curve, leaf: EdgeLeaf, depth: u32, leaves: &mut Vec<EdgeLeaf>) {
    if is_flat(leaf.certificate.as_ref()) || depth >= LEAF_DEPTH {
        leaves.push(leaf);
        return;
    }
    for half in leaf.halves(curve) {
        cut_edge(curve, half, depth + 1, leaves);
    }
}

impl FaceGeometry {
    /// A close box: the hulls of leaves inside the trim, and points of those that it crosses.
    pub(crate) fn bounds(&self) -> Aabb {
        let points = self.leaves.iter().flat_map(|leaf| {
            let steps: u32 = if matches!(self.chart, Chart::Plane { .. }) { 1 } else { 8 };
            let at = move |k: u32| {
                leaf.rect
                    .at(f64::from(k / (steps + 1)) / f64::from(steps), f64::from(k % (steps + 1)) / f64::from(steps))
            };
            (0..(steps + 1) * (steps + 1)).map(at).filter(|&p| !leaf.crossed || self.trim.contains(p))
        });
        Aabb::of_points(points.map(|[u, v]| self.chart.d2(u, v)[0]))
    }
}

impl EdgeGeometry {
    /// Box of points of the curve, close but not rigorous (see [`crate::Face::bounds`]).
    pub(crate) fn bounds(&self) -> Aabb {
        let at = |leaf: &EdgeLeaf, k: u32| leaf.range[0] + (leaf.range[1] - leaf.range[0]) * f64::from(k) / 16.0;
        Aabb::of_points(self.leaves.iter().flat_map(|leaf| (0..=16).map(move |k| self.curve.d2(at(leaf, k))[0])))
    }
}
