//! Flat faces and straight edges, whatever kind of surface or curve they are written as: exporters write planes as B-splines.

use glam::DVec3;

use crate::geometry::curve::Hull;
use crate::ids::{EdgeId, EntityId, FaceId};
use crate::model::{Kind, Model};
use crate::tolerance::FLAT;

impl Model {
    /// Whether a face lies in a plane, or an edge in a straight line: by its kind, or by the control points of all its pieces. `false` of
    /// vertices, and of what the model does not have.
    #[must_use]
    pub fn is_flat(&self, entity: EntityId) -> bool {
        match entity {
            EntityId::Face(id) => self.is_plane(id),
            EntityId::Edge(id) => self.is_line(id),
            EntityId::Vertex(_) => false,
        }
    }

    fn is_plane(&self, id: FaceId) -> bool {
        let (Some(face), Some(own)) = (self.face(id), self.geometry().faces.get(id.index())) else { return false };
        face.kind == Kind::Plane || {
            let pieces = own.chart.pieces(own.rect);
            is_thin(&pieces.into_iter().map(|piece| own.chart.hull(piece)).collect::<Vec<_>>(), 2)
        }
    }

    fn is_line(&self, id: EdgeId) -> bool {
        let own = self.geometry().edges.get(id.index()).and_then(Option::as_ref);
        let (Some(edge), Some(own)) = (self.edge(id), own) else { return false };
        edge.kind == Kind::Line || {
            let pieces = own.curve.pieces(own.range[0], own.range[1]);
            is_thin(&pieces.into_iter().map(|[a, b]| own.curve.hull(a, b)).collect::<Vec<_>>(), 1)
        }
    }
}

/// Whether hulls lie in one flat of so many dimensions: 1 is a line, 2 a plane.
fn is_thin(hulls: &[Hull], dimensions: usize) -> bool {
    let points = || hulls.iter().flat_map(|hull| &hull.points).copied();
    let (Some(origin), true) = (points().next(), hulls.iter().all(|hull| hull.sound)) else { return false };
    let farthest = |off: &dyn Fn(DVec3) -> DVec3| {
        points().map(|p| off(p - origin)).max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
    };
    let size = farthest(&|r| r).map_or(0.0, DVec3::length);
    let Some(along) = farthest(&|r| r).and_then(DVec3::try_normalize) else { return false };
    let off_line = |r: DVec3| r - r.dot(along) * along;
    let mut rest = farthest(&off_line).unwrap_or_default();
    if dimensions == 2
        && let Some(across) = rest.try_normalize()
    {
        rest = farthest(&|r| off_line(r) - off_line(r).dot(across) * across).unwrap_or_default();
    }
    let pad = hulls.iter().map(|hull| hull.pad).fold(0.0, f64::max);
    rest.length() + pad <= FLAT * size
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_tilted_plane_are_flat_until_one_leaves_it() {
        let at = |u: f64, v: f64, w: f64| DVec3::new(3e3 + u - 2.0 * v, u + v, 0.5 * u - v + w);
        let mut points: Vec<DVec3> = (0..25).map(|k| at(f64::from(k / 5) * 0.7, f64::from(k % 5) * 1.3, 0.0)).collect();
        let plane = |points: &[DVec3]| is_thin(&[Hull::of(points.to_vec())], 2);
        assert!(plane(&points) && !is_thin(&[Hull::of(points.clone())], 1));
        points[12] = at(1.4, 2.6, 1e-7);
        assert!(!plane(&points));
    }

    #[test]
    fn points_of_a_line_are_straight_until_one_leaves_it() {
        let mut points: Vec<DVec3> = (0..7).map(|k| DVec3::new(1.0, 2.0, 3.0) * f64::from(k) + DVec3::X).collect();
        assert!(is_thin(&[Hull::of(points.clone())], 1));
        points[3].z += 1e-7;
        assert!(!is_thin(&[Hull::of(points.clone())], 1) && is_thin(&[Hull::of(points)], 2));
        assert!(!is_thin(&[Hull::of(vec![DVec3::ONE; 4])], 1), "a point is no line");
    }
}
