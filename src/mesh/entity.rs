//! Geometric entities that a mesh file classifies its elements on, and the groups that name them.

use std::fmt;

use super::NodeId;

/// Tag of no entity of a file.
const UNMARKED: i32 = i32::MIN;

/// A geometric entity of a mesh file: dimension and tag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EntityKey {
    /// 0 to 3.
    pub dimension: u8,
    /// The file's number of the entity, unique among those of its dimension.
    pub tag: i32,
}

impl EntityKey {
    /// The entity `tag` of a dimension.
    #[must_use]
    pub fn new(dimension: u8, tag: i32) -> EntityKey {
        EntityKey { dimension, tag }
    }

    /// What sides of the skin lie on that the file gives no boundary element.
    #[must_use]
    pub fn unmarked(dimension: u8) -> EntityKey {
        EntityKey { dimension, tag: UNMARKED }
    }

    /// Whether it is that of sides that the file gives no boundary element.
    #[must_use]
    pub fn is_unmarked(self) -> bool {
        self.tag == UNMARKED
    }

    /// Whether it is a surface.
    #[must_use]
    pub fn is_surface(self) -> bool {
        self.dimension == 2
    }
}

impl fmt::Display for EntityKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_unmarked() {
            return f.write_str("unmarked boundary");
        }
        let noun = ["point", "curve", "surface", "volume"].get(usize::from(self.dimension)).unwrap_or(&"entity");
        write!(f, "{noun} {}", self.tag)
    }
}

/// What a file says of an entity (MSH 4.1 `$Entities`).
#[derive(Clone, Debug, PartialEq)]
pub struct Entity {
    /// Which entity.
    pub key: EntityKey,
    /// Its box: lower corner, upper corner; a point has both alike.
    pub bounds: [[f64; 3]; 2],
    /// Physical groups it belongs to; a negative tag means reversed orientation.
    pub physical_tags: Vec<i32>,
    /// Signed tags of the entities of one dimension less that bound it.
    pub boundary: Vec<i32>,
}

/// The name of a physical group.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhysicalName {
    /// 0 to 3.
    pub dimension: u8,
    /// Tag of the group.
    pub tag: i32,
    /// Its name.
    pub name: String,
}

impl PhysicalName {
    /// Whether the group is one of surfaces.
    #[must_use]
    pub fn is_of_surfaces(&self) -> bool {
        self.dimension == 2
    }

    /// Whether the group is one of curves.
    #[must_use]
    pub fn is_of_curves(&self) -> bool {
        self.dimension == 1
    }
}

/// Two entities whose nodes correspond (MSH `$Periodic`).
#[derive(Clone, Debug, PartialEq)]
pub struct Periodic {
    /// The entity whose nodes follow.
    pub slave: EntityKey,
    /// Tag of the entity, of the same dimension, that they follow.
    pub master: i32,
    /// Row-major 4x4 map from master to slave, or empty.
    pub affine: Vec<f64>,
    /// `(slave, master)` nodes.
    pub pairs: Vec<(NodeId, NodeId)>,
}
