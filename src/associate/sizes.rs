//! Do mesh and CAD fit: their boxes, and planes of patches without CAD.

use cad::{Aabb, EntityId, Model};
use glam::DVec3;

use super::{AssociateError, Candidates, Plane};
use crate::mesh::{Boundary, Mesh};

/// How far mesh and CAD boxes may differ in size before the unit is taken to differ.
const SAME_SIZE: f64 = 1.5;

/// The plane of points that lie in one, within `slack`.
pub(super) fn plane_through(points: &[DVec3], slack: f64) -> Option<Plane> {
    let &origin = points.first()?;
    let far = |from: DVec3| points.iter().copied().max_by(|a, b| a.distance(from).total_cmp(&b.distance(from)));
    let across = (far(origin)? - origin).try_normalize()?;
    let aside = points.iter().map(|&p| (p - origin).cross(across));
    let normal = aside.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?.try_normalize()?;
    let plane = Plane { point: origin, normal };
    points.iter().all(|&p| plane.closest(p).distance(p) <= slack).then_some(plane)
}

/// Refuses a CAD of another size or at another place than what is associated with it.
pub fn check_boxes(
    mesh: &Mesh,
    boundary: &Boundary,
    model: &Model,
    candidates: &Candidates,
) -> Result<(), AssociateError> {
    let linked = || candidates.sheets.iter().filter(|s| !s.entities.is_empty());
    let corners = linked().flat_map(|s| s.items.iter()).flat_map(|&f| boundary.corners[f].iter());
    let own = Aabb::of_points(corners.map(|n| mesh.points()[n.index()]));
    let entities = linked()
        .flat_map(|s| s.entities.iter())
        .filter_map(|e| model.face(if let EntityId::Face(id) = e { *id } else { return None }));
    let theirs = entities.fold(Aabb::EMPTY, |all, face| all.union(face.bounds));
    let (size, cad) = (own.diagonal(), theirs.diagonal());
    let ratio = size / cad;
    if !(1.0 / SAME_SIZE..=SAME_SIZE).contains(&ratio) {
        return Err(match cad::unit_factor(size, cad) {
            Some(factor) => AssociateError::Scale { mesh: size, cad, factor },
            None => AssociateError::Size { mesh: size, cad, factor: ratio },
        });
    }
    let distance = own.center().distance(theirs.center());
    if distance > 0.5 * size {
        return Err(AssociateError::Place { mesh: size, distance });
    }
    Ok(())
}
