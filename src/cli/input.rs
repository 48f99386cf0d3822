//! How commands read mesh files.

use std::path::Path;

use crate::formats::{self, Error, ReadOptions};
use crate::mesh::Mesh;

/// CGNS is parsed by this program in a process of its own, which may crash.
pub(super) fn reading() -> ReadOptions {
    ReadOptions { reader: Some(cad::child::this_program()) }
}

/// Reads a mesh.
pub(super) fn mesh(path: &Path) -> Result<Mesh, Error> {
    formats::read_with(path, &reading())
}
