//! Typed numbers of nodes and elements: `u32`, with a checked error beyond.

/// More items than a 32-bit number can tell apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{count} {what} are more than the {} that this build can number", u32::MAX)]
pub struct TooMany {
    /// What was counted.
    pub what: &'static str,
    /// How many there are.
    pub count: usize,
}

macro_rules! id {
    ($(#[$doc:meta])* $name:ident, $what:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, bytemuck::Pod, bytemuck::Zeroable)]
        #[repr(transparent)]
        pub struct $name(u32);

        impl $name {
            /// The id of the item at a place in its list.
            ///
            /// # Errors
            /// [`TooMany`] beyond 32 bits.
            pub fn new(index: usize) -> Result<Self, TooMany> {
                u32::try_from(index).map(Self).map_err(|_| TooMany { what: $what, count: index })
            }

            /// The item's place in its list.
            #[must_use]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    /// A node of a mesh: its place in [`Mesh::points`](super::Mesh::points).
    NodeId, "nodes"
);
id!(
    /// An element: counted over all blocks of its dimension in file order. Where nothing else is said, a cell of the mesh
    /// ([`Mesh::cells`](super::Mesh::cells)).
    ElementId, "elements"
);

impl NodeId {
    /// Filler beyond the corners of a key: no node has it, as a mesh of that many nodes has no room for elements.
    pub(crate) const NONE: NodeId = NodeId(u32::MAX);
}

impl ElementId {
    /// The id of an element of a mesh, whose elements are known to be few enough.
    pub(super) fn numbered(index: usize) -> ElementId {
        ElementId(index as u32)
    }
}
