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
pub struct Places {
    by_corners: Arc<FxHashMap<FaceKey, usize>>,
    count: usize,
}

impl Places {
    /// Those of boundary elements, by the corners of each; of several with the same corners the last one's counts.
    pub fn new<'a>(corners: impl IntoIterator<Item = &'a [NodeId]>) -> Places {
        let (mut by_corners, mut count) = (FxHashMap::default(), 0);
        for corners in corners {
            by_corners.insert(FaceKey::new(corners), count);
            count += 1;
        }
        Places { by_corners: Arc::new(by_corners), count }
    }

    /// The place of one, by its corners.
    #[must_use]
    pub fn of(&self, corners: &[NodeId]) -> Option<usize> {
        self.by_corners.get(&FaceKey::new(corners)).copied()
    }

    /// How many values there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.count == 0
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
