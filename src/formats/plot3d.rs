//! PLOT3D.
use std::path::Path;
pub(super) fn is_name(_: &Path) -> bool {
    false
}
pub(super) fn read(_: impl std::io::BufRead, _: &Path, _: u64) -> Result<crate::mesh::Mesh, super::Flaw> {
    Ok(crate::mesh::Mesh::default())
}
