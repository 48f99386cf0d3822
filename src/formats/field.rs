//! Named values to show on a mesh.

use std::sync::Arc;

use rustc_hash::FxHashMap;

use crate::mesh::{FaceKey, NodeId};

/// A named array of values, one a node, an element or a boundary element.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Name of the array in the file.
    pub name: String,
    /// What the values belong to.
    pub support: Support,
    /// The values.
    pub values: Values,
}

/// What a field's values belong to.
#[derive(Clone, Debug, PartialEq)]
pub enum Support {
    /// Nodes, in the order of `Mesh::points`.
    Points,
    /// Elements of the mesh's top dimension, in the order of `ElementId`. Boundary elements show NaN or -1.
    Elements,
    /// Boundary elements. Others show NaN or -1.
    Sides(Places),
}

/// The place of each boundary element's value, by its corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places(Arc<FxHashMap<FaceKey, usize>>);

impl Places {
    /// Those of boundary elements, by the corners of each.
    pub fn new<'a>(corners: impl IntoIterator<Item = &'a [NodeId]>) -> Places {
        Places(Arc::new(
            corners.into_iter().enumerate().map(|(place, corners)| (FaceKey::new(corners), place)).collect(),
        ))
    }

    /// The place of one, by its corners.
    #[must_use]
    pub fn of(&self, corners: &[NodeId]) -> Option<usize> {
        self.0.get(&FaceKey::new(corners)).copied()
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Values of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Real numbers.
    Real(Vec<f64>),
    /// Vectors.
    Vectors(Vec<[f64; 3]>),
    /// Whole numbers. On the nodes of pyramids of order 2 to 4, which VTU shows by points in between, the nearest.
    Integer(Vec<i64>),
}

impl Values {
    /// Number of values.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Values::Real(values) => values.len(),
            Values::Vectors(values) => values.len(),
            Values::Integer(values) => values.len(),
        }
    }

    /// Whether there are no values.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
