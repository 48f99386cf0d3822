//! What comes in is checked, and the mesh associated with its CAD.

use cad::Model;

use super::error::Error;
use super::settings::Settings;
use crate::associate::{Association, Candidates, Linkage, classify, open_faces, open_notes};
use crate::certify;
use crate::element::Order;
use crate::mesh::{Boundary, Mesh, Periodic};

/// Elements that an error lists by number.
const LISTED: usize = 10;

/// Refuses a mesh that cannot be curved.
pub(super) fn check_mesh(linear: &Mesh) -> Result<(), Error> {
    if linear.order() != Order::LINEAR {
        return Err(Error::NotLinear { order: linear.order() });
    }
    if !linear.is_volume() {
        return Err(Error::NoVolume);
    }
    let certificate = certify::mesh(linear, linear.points(), None, &certify::Settings::default());
    if certificate.holds() {
        return Ok(());
    }
    let cells = linear.cells();
    let some = certificate.failures.iter().take(LISTED).map(|f| format!("{} {}", f.cell, cells.get(f.element).tag));
    let count = certificate.failures.len();
    let more = if count > LISTED { ", ..." } else { "" };
    Err(Error::Inverted { count, listed: some.collect::<Vec<_>>().join(", ") + more })
}

/// Refuses CAD that nothing can be curved onto.
pub(super) fn check_cad(cad: &Model) -> Result<(), Error> {
    if cad.faces().is_empty() { Err(Error::NoFaces) } else { Ok(()) }
}

/// A mesh associated with its CAD.
pub(super) struct Associated {
    pub(super) boundary: Boundary,
    pub(super) association: Association,
    /// Faces that belong to the CAD and stay straight, as it could not be decided where they lie.
    pub(super) open_faces: Vec<usize>,
    /// Periodic pairs of which the linkage knows and the mesh does not.
    pub(super) periodic: Vec<Periodic>,
    pub(super) cad_unit: String,
    pub(super) cad_scale: f64,
}

impl Associated {
    /// Says what of the mesh lies on what of the CAD.
    pub(super) fn new(
        linear: &Mesh,
        cad: &Model,
        linkage: Option<&Linkage>,
        settings: &Settings,
    ) -> Result<Associated, Error> {
        let boundary = Boundary::new(linear);
        let straight = settings.patches.straight(linear, &boundary)?;
        let choose = |candidates: &mut Candidates| candidates.leave_straight(&boundary, &straight);
        let classified = classify(linkage, linear, &boundary, cad, settings.max_offset, &choose)?;
        let known: Vec<_> = linear.periodic().iter().map(|pair| pair.slave).collect();
        let unknown = classified.candidates.periodic.into_iter().filter(|pair| !known.contains(&pair.slave));
        let periodic = unknown.collect();
        let mut association = classified.association;
        let inference = classified.inference.as_ref();
        let open = |inference| open_faces(&boundary, &association, inference, &straight);
        let open_faces = inference.map_or_else(Vec::new, open);
        association.notes.extend(open_notes(linear, &boundary, &open_faces));
        let (cad_unit, cad_scale) = (cad.unit().name.clone(), cad.scale());
        Ok(Associated { association, open_faces, periodic, boundary, cad_unit, cad_scale })
    }
}
