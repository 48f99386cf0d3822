//! Boundary conditions, as mesh files name them.

use super::EntityKey;

/// The boundary condition that a file gives to an entity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// The entity that it holds on.
    pub entity: EntityKey,
    /// Its own name, which need not be that of a physical group.
    pub name: String,
    /// Its kind in the words of CGNS (`BCType_t`), as `BCWallViscous`.
    pub kind: String,
}
