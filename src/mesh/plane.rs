//! Planes, and the one that a mesh of faces lies in.

use cad::Aabb;
use glam::DVec3;

use super::Mesh;

/// Farthest that a node of a plane mesh may be from its plane, as a fraction of the mesh's diagonal: what single precision and few
/// digits leave.
const FLAT: f64 = 1e-6;

/// A plane by a point and a unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of it.
    pub point: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
}

impl Plane {
    /// The plane of points that lie in one, within `slack`; `None` also where they lie on a line.
    #[must_use]
    pub fn through(points: &[DVec3], slack: f64) -> Option<Plane> {
        let &origin = points.first()?;
        let far = |from: DVec3| points.iter().copied().max_by(|a, b| a.distance(from).total_cmp(&b.distance(from)));
        let across = (far(origin)? - origin).try_normalize()?;
        let aside = points.iter().map(|&p| (p - origin).cross(across));
        let normal = aside.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?.try_normalize()?;
        let plane = Plane { point: origin, normal };
        points.iter().all(|&p| plane.closest(p).distance(p) <= slack).then_some(plane)
    }

    /// The plane that stands upright on this one and holds points that lie on a line, within `slack`.
    #[must_use]
    pub fn upright(self, points: &[DVec3], slack: f64) -> Option<Plane> {
        let &point = points.first()?;
        let far = points.iter().copied().max_by(|a, b| a.distance(point).total_cmp(&b.distance(point)))?;
        let normal = exact((far - point).cross(self.normal).try_normalize()?);
        let upright = Plane { point, normal };
        points.iter().all(|&x| upright.closest(x).distance(x) <= slack).then_some(upright)
    }

    /// The point of the plane nearest to `x`.
    #[must_use]
    pub fn closest(&self, x: DVec3) -> DVec3 {
        x - self.normal * self.normal.dot(x - self.point)
    }

    /// Whether the normal points along its largest component: along +z for the plane of x and y.
    #[must_use]
    pub fn is_along_axis(&self) -> bool {
        let largest = self.normal.to_array().into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs()));
        largest.is_some_and(|component| component > 0.0)
    }

    fn turned(self) -> Plane {
        Plane { normal: -self.normal, ..self }
    }
}

/// A unit vector; exactly that of an axis where it lies along it.
fn exact(normal: DVec3) -> DVec3 {
    let along = |axis: DVec3| normal * axis == normal;
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().find(|&axis| along(axis)).map_or(normal, |axis| axis.copysign(normal))
}

impl Mesh {
    /// The plane of a mesh whose cells are faces, with its nodes at `positions`: its normal is the one against which most cells are
    /// positive, by their corners, and along its largest component where as many are negative.
    ///
    /// `None` where the cells are no faces, or a node of them is off the plane by more than a millionth of the mesh's diagonal.
    #[must_use]
    pub fn plane(&self, positions: &[DVec3]) -> Option<Plane> {
        if self.dimension() != 2 {
            return None;
        }
        let cells = self.cells();
        let mut used = vec![false; positions.len()];
        cells.blocks().iter().flat_map(|block| &block.nodes).for_each(|n| used[n.index()] = true);
        let points: Vec<DVec3> = positions.iter().zip(used).filter(|(_, used)| *used).map(|(x, _)| *x).collect();
        let plane = Plane::through(&points, FLAT * Aabb::of_points(points.iter().copied()).diagonal())?;
        let plane = Plane { normal: exact(plane.normal), ..plane };
        let plane = if plane.is_along_axis() { plane } else { plane.turned() };
        let areas = cells.iter().map(|cell| {
            let at = |n: usize| positions[cell.nodes[n].index()];
            let fan = (2..cell.corners().len()).map(|n| (at(n - 1) - at(0)).cross(at(n) - at(0)));
            fan.sum::<DVec3>().dot(plane.normal)
        });
        let most = areas.map(|area| i64::from(area > 0.0) - i64::from(area < 0.0)).sum::<i64>();
        Some(if most < 0 { plane.turned() } else { plane })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::Cell;
    use crate::mesh::{EntityKey, NodeId, Parts};

    /// A quadrilateral and two triangles on it, the last of them numbered the other way round.
    fn mesh(place: impl Fn(DVec3) -> DVec3) -> Mesh {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 2.0], [1.5, 1.5]];
        let points = corners.map(|[x, y]| place(DVec3::new(x, y, 0.0))).to_vec();
        let mut parts = Parts { points, ..Parts::default() };
        for (cell, nodes) in
            [(Cell::Quad, &[0, 1, 2, 3][..]), (Cell::Triangle, &[3, 2, 4]), (Cell::Triangle, &[5, 2, 4])]
        {
            let nodes: Vec<NodeId> = nodes.iter().map(|&n| NodeId::new(n).unwrap()).collect();
            parts.push(cell, EntityKey::new(2, 1), &nodes);
        }
        Mesh::new(parts).unwrap()
    }

    #[test]
    fn the_normal_is_the_one_of_most_cells() {
        let turn = glam::DMat3::from_rotation_x(0.4) * glam::DMat3::from_rotation_y(-2.0);
        let plane = |map: &dyn Fn(DVec3) -> DVec3| {
            let mesh = mesh(map);
            mesh.plane(mesh.points())
        };
        let normal = |map: &dyn Fn(DVec3) -> DVec3| plane(map).unwrap().normal;
        assert!(normal(&|x| x + DVec3::ONE).distance(DVec3::Z) < 1e-15);
        assert!(normal(&|x| DVec3::new(x.y, x.x, 0.0)).distance(-DVec3::Z) < 1e-15);
        let there = normal(&|x| turn * x * 1e-3 + DVec3::splat(7.0));
        assert!(there.distance(turn * DVec3::Z) < 1e-9, "{there}");
        assert_eq!(plane(&|x| x + DVec3::Z * 1e-3 * x.x * x.x), None, "a curved surface");
        assert_eq!(plane(&|x| x * DVec3::X), None, "a line");
    }
}
