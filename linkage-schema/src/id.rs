//! The numbers by which elements of a document refer to one another. Each kind has its own space and its own type.

use std::fmt;
use std::num::NonZeroU32;

/// What the four kinds of id have in common, for the reader.
pub(crate) trait Id: Copy {
    fn from_number(number: NonZeroU32) -> Self;
}

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(NonZeroU32);

        impl $name {
            /// The id with this number; none for 0, which is no id.
            pub fn new(number: u32) -> Option<Self> {
                NonZeroU32::new(number).map(Self)
            }

            /// The number as the file has it.
            pub fn get(self) -> u32 {
                self.0.get()
            }
        }

        impl Id for $name {
            fn from_number(number: NonZeroU32) -> Self {
                Self(number)
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id! {
    /// `attid` of an attribute or of a group of them; `aref` refers to it.
    AttributeId
}
id! {
    /// `gid` of a geometry reference or of a group of them; `gref` refers to it.
    GeometryId
}
id! {
    /// `mid` of a mesh element.
    MeshId
}
id! {
    /// `xid` of a transform; `xref` refers to it.
    TransformId
}
