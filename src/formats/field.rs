//! Named values to show on a mesh.

/// A named array of values, one a node or one an element.
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
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// Nodes, in the order of `Mesh::points`.
    Points,
    /// Elements of the mesh's top dimension, in the order of `ElementId`. Boundary elements show NaN or -1.
    Elements,
}

/// Values of a field.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Real numbers.
    Real(Vec<f64>),
    /// Whole numbers. On the nodes of pyramids of order 2 to 4, which VTU shows by points in between, the nearest.
    Integer(Vec<i64>),
}

impl Values {
    /// Number of values.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Values::Real(values) => values.len(),
            Values::Integer(values) => values.len(),
        }
    }

    /// Whether there are no values.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
