//! Which side of a boundary face the cells are on.

use glam::DVec3;

use crate::mesh::{Boundary, Mesh, NodeId, Plane};

/// Two mesh faces go on in one another if the cosine between their normals is at least this.
pub(super) const SMOOTH: f64 = 0.5;

/// A boundary face's place in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Mean of its corners.
    pub middle: DVec3,
    /// Unit normal, out of the volume; by the order of the corners where no cell has the face. Zero for a face without area. That of a
    /// line of a plane mesh is in the plane.
    pub normal: DVec3,
    /// Longest edge.
    pub size: f64,
    /// Cells that have the face as a side: 1 on the boundary, 2 inside the volume, 0 in a mesh of faces alone.
    pub cells: usize,
}

/// The sides of all boundary faces.
#[must_use]
pub fn sides(mesh: &Mesh, boundary: &Boundary) -> Vec<Side> {
    let mut sides: Vec<Side> =
        boundary.corners.iter().map(|corners| by_corners(mesh, corners, boundary.plane)).collect();
    for cell in mesh.cells().iter() {
        for key in cell.sides() {
            let Some(index) = boundary.face_of(key) else { continue };
            let side = &mut sides[index];
            let center = mesh.points_of(cell.corners()).sum::<DVec3>() / cell.corners().len() as f64;
            if side.cells == 0 && side.normal.dot(side.middle - center) < 0.0 {
                side.normal = -side.normal;
            }
            side.cells += 1;
        }
    }
    sides
}

fn by_corners(mesh: &Mesh, corners: &[NodeId], plane: Option<Plane>) -> Side {
    let points: Vec<DVec3> = mesh.points_of(corners).collect();
    let count = points.len();
    let area: DVec3 = match (plane, &points[..]) {
        (Some(plane), &[a, b]) => (b - a).cross(plane.normal),
        // The sum over the loop is twice the area vector of a triangle, and that of the mean plane of a quadrilateral.
        _ => (0..count).map(|q| points[q].cross(points[(q + 1) % count])).sum(),
    };
    let size = (0..count).map(|q| points[q].distance(points[(q + 1) % count])).fold(0.0, f64::max);
    Side { middle: points.iter().sum::<DVec3>() / count as f64, normal: area.normalize_or_zero(), size, cells: 0 }
}
