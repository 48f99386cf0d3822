//! Fields of a curved mesh for pictures.

use crate::curve::Curved;
use crate::curve::layers::straight_elements;
use crate::formats::{Field, Support, Values};

/// Values of every cell: whether it is straight, a proven lower bound of its J/J_c, and its worst `C_WCN`.
#[must_use]
pub fn fields(curved: &Curved) -> Vec<Field> {
    let field = |name: &str, values| Field { name: name.to_owned(), support: Support::Elements, values };
    let real = |name: &str, values| field(name, Values::Real(values));
    let straight = straight_elements(&curved.mesh, &curved.straight);
    vec![
        field("straight", Values::Integer(straight.into_iter().map(i64::from).collect())),
        real("certified_min_J_over_Jc", curved.certificate.minima.clone()),
        real("C_WCN", curved.smoothed.costs.iter().map(|c| c.c_wcn).collect()),
    ]
}
