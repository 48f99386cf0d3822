//! Meshes that others made: what can be certified at all.

use glam::DVec3;

use super::{Certificate, Settings, certificate};
use crate::mesh::Mesh;

/// Why nothing can be proven of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotCertifiable {
    /// It has no elements, or only points and lines.
    #[error("it has no cells to certify, neither volumes nor faces")]
    NoCells,
    /// Its cells are faces of a curved surface.
    #[error(
        "its cells are triangles and quadrilaterals that do not lie in one plane; only volume meshes and plane meshes are certified"
    )]
    NotPlane,
}

/// Certifies a mesh as [`mesh`](super::mesh) does; refuses one of which nothing can be proven.
///
/// # Errors
/// [`NotCertifiable`].
pub fn check(
    mesh: &Mesh,
    positions: &[DVec3],
    linear_corners: Option<&[DVec3]>,
    settings: &Settings,
) -> Result<Certificate, NotCertifiable> {
    let Some(block) = mesh.cell_blocks().next().filter(|block| block.cell.sides().next().is_some()) else {
        return Err(NotCertifiable::NoCells);
    };
    let certificate = certificate::mesh(mesh, positions, linear_corners, settings);
    if block.cell.has_jacobian(certificate.normal.iter().count()) {
        Ok(certificate)
    } else {
        Err(NotCertifiable::NotPlane)
    }
}
