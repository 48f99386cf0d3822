//! Do the two sides of a periodic pair correspond under their transform?

use linkage_schema::{Code, Findings, MeshModel, Resolution};

use super::linked_mesh::LinkedMesh;
use crate::associate::{periodic_records, periodic_sheets};

pub(super) fn check(linked: &LinkedMesh<'_>, resolution: &Resolution<'_>, findings: &mut Findings) {
    for pair in &resolution.pairs {
        let Some(sheets) = periodic_sheets(pair, resolution) else { continue };
        let node = |model: &MeshModel, index| linked.within(model).node(index);
        if let Err(error) = periodic_records(pair, sheets, linked.mesh, linked.boundary, &node) {
            findings.push(Code::NotPeriodic, pair.linkage.origin, || error.to_string());
        }
    }
}
