//! Do the two sides of a periodic pair correspond under their transform?

use linkage_schema::{Findings, Resolution};

use super::linked_mesh::LinkedMesh;

pub(super) fn check(_linked: &LinkedMesh<'_>, _resolution: &Resolution<'_>, _findings: &mut Findings) {}
