//! Do mesh and CAD fit: their boxes, and planes of patches without CAD.

use cad::{Aabb, Model};

use super::host::bounds_of;
use super::{AssociateError, Candidates};
use crate::mesh::{Boundary, Mesh};

/// How far mesh and CAD boxes may differ in size before the unit is taken to differ.
const SAME_SIZE: f64 = 1.5;

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
    let entities = linked().flat_map(|s| s.entities.iter()).filter_map(|&e| bounds_of(model, e));
    let theirs = entities.fold(Aabb::EMPTY, Aabb::union);
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
