//! The trim of a face: which parameters lie inside its boundary.
//!
//! The pcurves are kept as rational Bezier curves, and a ray from the parameters is intersected with them by subdivision of their control
//! polygons, so the answer is exact up to rounding on the curves themselves. Where pcurves of a wire do not
//! quite meet they are joined by straight segments. Even–odd rule: orientation in files cannot be trusted.

use crate::geometry::bezier::restrict;
use crate::geometry::chart::Rect;
use crate::tolerance::TOUCH;
use glam::{DVec2, DVec4};
use opencascade_sys as sys;

/// Halvings of a piece when a ray or a window is held against it.
const DEPTH: u32 = 52;
const WINDOW_DEPTH: u32 = 10;

/// One Bezier piece of the boundary, homogeneous `(w u, w v, 0, w)`, and its box.
#[derive(Clone, Debug)]
struct Piece {
    points: Vec<DVec4>,
    min: DVec2,
    max: DVec2,
}

/// The boundary of a face in its parameters.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trim {
    pieces: Vec<Piece>,
}

fn flat(p: DVec4) -> DVec2 {
    DVec2::new(p.x, p.y) / p.w
}

fn halves(points: &[DVec4]) -> [Vec<DVec4>; 2] {
    let degree = points.len() - 1;
    let (mut left, mut right) = (points.to_vec(), points.to_vec());
    restrict(&mut left, 0, 1, degree, 0.0, 0.5);
    restrict(&mut right, 0, 1, degree, 0.5, 1.0);
    [left, right]
}

impl Piece {
    fn new(points: Vec<DVec4>) -> Self {
        let corners = points.iter().map(|&p| flat(p));
        let (min, max) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| (a.min(p), b.max(p)));
        Self { points, min, max }
    }

    fn start(&self) -> DVec2 {
        flat(self.points[0])
    }

    fn end(&self) -> DVec2 {
        flat(self.points[self.points.len() - 1])
    }

    /// Whether the ray from `p` towards larger `u` crosses the piece an odd number of times.
    fn is_crossed(&self, p: DVec2) -> bool {
        if self.max.x <= p.x || self.max.y <= p.y || self.min.y > p.y {
            return false;
        }
        crossed(&self.points, p, DEPTH)
    }

    fn enters(&self, min: DVec2, max: DVec2) -> bool {
        if self.max.cmplt(min).any() || self.min.cmpgt(max).any() {
            return false;
        }
        enters(&self.points, min, max, WINDOW_DEPTH)
    }
}

fn crossed(points: &[DVec4], p: DVec2, depth: u32) -> bool {
    let above = |q: DVec2| q.y > p.y;
    let right = |q: DVec2| q.x > p.x;
    let (first, last) = (flat(points[0]), flat(points[points.len() - 1]));
    let ups = points.iter().filter(|&&q| above(flat(q))).count();
    if ups == 0 || ups == points.len() {
        return false;
    }
    let rights = points.iter().filter(|&&q| right(flat(q))).count();
    if rights == 0 {
        return false;
    }
    if rights == points.len() {
        return above(first) != above(last);
    }
    if depth == 0 || points.len() == 2 {
        let at = first.x + (last.x - first.x) * (p.y - first.y) / (last.y - first.y);
        return above(first) != above(last) && at > p.x;
    }
    let [left, rest] = halves(points);
    crossed(&left, p, depth - 1) != crossed(&rest, p, depth - 1)
}

fn enters(points: &[DVec4], min: DVec2, max: DVec2, depth: u32) -> bool {
    let piece = Piece::new(points.to_vec());
    if piece.max.cmplt(min).any() || piece.min.cmpgt(max).any() {
        return false;
    }
    let within = |p: DVec2| p.cmpge(min).all() && p.cmple(max).all();
    if depth == 0 || within(piece.start()) || within(piece.end()) {
        return true;
    }
    let [left, right] = halves(points);
    enters(&left, min, max, depth - 1) || enters(&right, min, max, depth - 1)
}

/// The pieces of one wire.
pub(crate) struct Wire(Vec<Piece>);

impl Wire {
    /// The pcurves of a wire, each given by its spans and whether it runs backwards, in the order in which they connect.
    pub(crate) fn new<'a>(pcurves: impl Iterator<Item = (&'a sys::Spans, bool)>) -> Self {
        let mut wire = Self(Vec::new());
        for (spans, reversed) in pcurves {
            let count = spans.degree_u as usize + 1;
            let poles = crate::geometry::curve::homogeneous(&spans.poles);
            let mut pieces: Vec<Piece> = poles.chunks_exact(count).map(|points| Piece::new(points.to_vec())).collect();
            if reversed {
                pieces.reverse();
                pieces.iter_mut().for_each(|piece| piece.points.reverse());
            }
            wire.join(pieces.first().map(Piece::start));
            wire.0.extend(pieces);
        }
        wire.join(wire.0.first().map(Piece::start));
        wire
    }

    /// Leads the wire on to a point, by a straight line.
    fn join(&mut self, to: Option<DVec2>) {
        let from = self.0.last().map(Piece::end);
        if let (Some(from), Some(to)) = (from, to.filter(|&to| Some(to) != from)) {
            self.0.push(Piece::new([from, to].map(|p| DVec4::new(p.x, p.y, 0.0, 1.0)).to_vec()));
        }
    }

    fn bounds(&self) -> (DVec2, DVec2) {
        self.0
            .iter()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(min, max), piece| (min.min(piece.min), max.max(piece.max)))
    }

    fn moved(mut self, by: DVec2) -> Self {
        for piece in &mut self.0 {
            piece.points.iter_mut().for_each(|p| *p += (by * p.w).extend(0.0).extend(0.0));
            (piece.min, piece.max) = (piece.min + by, piece.max + by);
        }
        self
    }
}

/// Whole periods that bring the middle of `inner` into `outer`.
fn periods_off(outer: [f64; 2], inner: [f64; 2], period: f64) -> f64 {
    let middle = 0.5 * (inner[0] + inner[1]);
    let inside = middle >= outer[0] && middle <= outer[1];
    if period > 0.0 && !inside { -period * ((middle - outer[0]) / period).floor() } else { 0.0 }
}

impl Trim {
    /// The boundary by its wires. On a surface with `periods` (0 for none) a hole may stand whole periods beside the outer wire; it
    /// is brought back, and the box of the outer wire handed out: the range of parameters that the face has then.
    pub(crate) fn new(wires: Vec<Wire>, periods: [f64; 2]) -> (Self, Option<Rect>) {
        let area = |(min, max): (DVec2, DVec2)| (max - min).element_product();
        let boxes = wires.iter().map(Wire::bounds);
        let Some((min, max)) = boxes.max_by(|&a, &b| area(a).total_cmp(&area(b))) else {
            return (Self::default(), None);
        };
        let mut moved = None;
        let mut pieces = Vec::new();
        for wire in wires {
            let (a, b) = wire.bounds();
            let by = DVec2::new(
                periods_off([min.x, max.x], [a.x, b.x], periods[0]),
                periods_off([min.y, max.y], [a.y, b.y], periods[1]),
            );
            if by == DVec2::ZERO {
                pieces.extend(wire.0);
            } else {
                moved = Some(Rect { u: [min.x, max.x], v: [min.y, max.y] });
                pieces.extend(wire.moved(by).0);
            }
        }
        (Self { pieces }, moved)
    }

    /// Whether the parameters lie inside. A face without wires has no trim: everything is inside.
    pub(crate) fn contains(&self, [u, v]: [f64; 2]) -> bool {
        let p = DVec2::new(u, v);
        self.pieces.is_empty() || self.pieces.iter().filter(|piece| piece.is_crossed(p)).count() % 2 == 1
    }

    /// Whether the boundary may enter the inside of `rect` (never a false no, by more than [`TOUCH`]).
    pub(crate) fn enters(&self, rect: &Rect) -> bool {
        let [a, b] = rect.size().map(|size| TOUCH * size);
        let min = DVec2::new(rect.u[0] + a, rect.v[0] + b);
        let max = DVec2::new(rect.u[1] - a, rect.v[1] - b);
        self.pieces.iter().any(|piece| piece.enters(min, max))
    }
}
