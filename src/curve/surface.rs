//! Meshes of faces on the CAD's surfaces, without a volume: what they must be, and on which side of the CAD their faces lie.
//!
//! The faces go through the steps of walls: projected, fitted, and proven free of folds. There is nothing behind them to carry along or to
//! smooth. A curved face is proven to stand upright on its linear face; that the linear face does not lie upside down on the CAD, folded back
//! over others, is seen by the CAD's normal at its middle.

use std::collections::BTreeMap;

use super::error::{Error, listed};
use crate::associate::{Association, Classification, normal_at, sides};
use crate::mesh::{Boundary, ElementId, Mesh};

/// A mesh of faces that do not all lie in one plane.
pub(super) fn checked(linear: Mesh) -> Result<Mesh, Error> {
    match linear.dimension() {
        3 => Err(Error::NotSurface("has volume elements")),
        2 if linear.plane(linear.points()).is_some() => Err(Error::NotSurface("lies in one plane")),
        2 => Ok(linear),
        _ => Err(Error::NoCells),
    }
}

/// Refuses faces that lie upside down: against the CAD's normal where most on their surface go with it, or the other way round.
pub(super) fn check_sides(linear: &Mesh, boundary: &Boundary, association: &Association) -> Result<(), Error> {
    let cells: Vec<ElementId> = linear.cells().ids().collect();
    let mut by_surface: BTreeMap<usize, [Vec<ElementId>; 2]> = BTreeMap::new();
    for ((side, on), id) in sides(linear, boundary).iter().zip(&association.faces).zip(cells) {
        let (Classification::Surface(surface), Some(group)) = (*on, association.group_of(*on)) else { continue };
        if let Some(normal) = normal_at(group, side.middle) {
            by_surface.entry(surface).or_default()[usize::from(normal.dot(side.normal) > 0.0)].push(id);
        }
    }
    let mut wrong: Vec<ElementId> =
        by_surface.into_values().flat_map(|both| both.into_iter().min_by_key(Vec::len)).flatten().collect();
    wrong.sort_unstable();
    if wrong.is_empty() {
        return Ok(());
    }
    Err(Error::UpsideDown { count: wrong.len(), listed: listed(&linear.cells(), &wrong) })
}
