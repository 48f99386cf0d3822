//! What comes in is checked, and the mesh associated with its CAD.

use cad::Model;

use super::error::{Error, listed};
use super::settings::Settings;
use super::surface;
use crate::associate::{Classified, Linkage, OpenFace, Sources, classify, open_faces, open_notes};
use crate::certify;
use crate::element::Order;
use crate::mesh::{Boundary, ElementId, Mesh, Periodic, Skin};

/// A mesh that can be curved, every side of its skin marked by a boundary element; what of it is amiss stands in its notes. One of faces on
/// `surface`s has no skin, and its faces are judged when it is known on what they lie.
pub(super) fn checked(linear: Mesh, surface: bool) -> Result<Mesh, Error> {
    if linear.order() != Order::LINEAR {
        return Err(Error::NotLinear { order: linear.order() });
    }
    if surface {
        return surface::checked(linear);
    }
    if !linear.is_volume() && linear.plane(linear.points()).is_none() {
        return Err(Error::NoCells);
    }
    let skin = Skin::of(&linear);
    if !skin.crossed.is_empty() {
        let (count, listed) = (skin.crossed.len(), listed(&linear.sides(), &skin.crossed));
        return Err(Error::Crossed { count, listed });
    }
    let certificate = certify::mesh(&linear, linear.points(), None, &certify::Settings::default());
    if certificate.holds() {
        return Ok(linear.with_unmarked(&skin));
    }
    let failures: Vec<ElementId> = certificate.failures.iter().map(|own| own.element).collect();
    Err(Error::Inverted { count: failures.len(), listed: listed(&linear.cells(), &failures) })
}

/// Refuses CAD that nothing of a mesh can be curved onto.
pub(super) fn check_cad(mesh: &Mesh, cad: &Model, surface: bool) -> Result<(), Error> {
    if (surface || mesh.is_volume()) && cad.faces().is_empty() { Err(Error::NoFaces) } else { Ok(()) }
}

/// A mesh associated with its CAD.
pub(super) struct Associated {
    pub(super) boundary: Boundary,
    pub(super) classified: Classified,
    /// Faces that belong to the CAD and stay straight, as it could not be decided where they lie.
    pub(super) open_faces: Vec<OpenFace>,
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
        let &Settings { by_tags, tolerance, max_offset, .. } = settings;
        let sources = Sources { linkage, by_tags, tolerance, max_offset, straight: &straight };
        let mut classified = classify(&sources, linear, &boundary, cad)?;
        let known: Vec<_> = linear.periodic().iter().map(|pair| pair.slave).collect();
        let unknown = classified.candidates.periodic.iter().filter(|pair| !known.contains(&pair.slave));
        let periodic = unknown.cloned().collect();
        let inference = classified.inference.as_ref();
        let open = |inference| open_faces(linear, &boundary, &classified.association, inference, &straight);
        let open_faces = inference.map_or_else(Vec::new, open);
        classified.association.notes.extend(open_notes(linear, &boundary, &open_faces));
        if settings.surface {
            surface::check_sides(linear, &boundary, &classified.association)?;
        }
        let (cad_unit, cad_scale) = (cad.unit().name.clone(), cad.scale());
        Ok(Associated { classified, open_faces, periodic, boundary, cad_unit, cad_scale })
    }
}
