//! Typed numbers of CAD entities.

use std::fmt;

macro_rules! id {
    ($name:ident, $word:literal) => {
        #[doc = concat!("Number of one ", $word, " of a [`Model`](crate::Model): 0-based, in the order of OCCT's `TopExp::MapShapes`.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(u32);

        impl $name {
            /// The entity with this 0-based index.
            pub const fn new(index: usize) -> Self {
                Self(index as u32)
            }

            #[doc = concat!("The entity that files call `", $word, ":tag` (1-based, the number Gmsh gives it); `None` for tag 0.")]
            pub fn from_tag(tag: u32) -> Option<Self> {
                tag.checked_sub(1).map(Self)
            }

            /// 0-based index.
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// 1-based number, as Gmsh and linkage files use it.
            pub const fn tag(self) -> u32 {
                self.0 + 1
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($word, ":{}"), self.tag())
            }
        }
    };
}

id!(FaceId, "face");
id!(EdgeId, "edge");
id!(VertexId, "vertex");

/// One face, edge or vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EntityId {
    /// A face.
    Face(FaceId),
    /// An edge.
    Edge(EdgeId),
    /// A vertex.
    Vertex(VertexId),
}

impl EntityId {
    /// 1-based number among those of its kind: 2 of `face:2`.
    #[must_use]
    pub const fn tag(self) -> u32 {
        match self {
            Self::Face(id) => id.tag(),
            Self::Edge(id) => id.tag(),
            Self::Vertex(id) => id.tag(),
        }
    }
}

impl fmt::Display for EntityId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Face(id) => id.fmt(f),
            Self::Edge(id) => id.fmt(f),
            Self::Vertex(id) => id.fmt(f),
        }
    }
}

impl From<FaceId> for EntityId {
    fn from(id: FaceId) -> Self {
        Self::Face(id)
    }
}

impl From<EdgeId> for EntityId {
    fn from(id: EdgeId) -> Self {
        Self::Edge(id)
    }
}

impl From<VertexId> for EntityId {
    fn from(id: VertexId) -> Self {
        Self::Vertex(id)
    }
}
