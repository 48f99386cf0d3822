//! Fields of a mesh for pictures.

#[cfg(feature = "cad")]
use crate::curve::Curved;
#[cfg(feature = "cad")]
use crate::curve::layers::straight_elements;
use crate::formats::{Field, Support, Values};
use crate::mesh::Mesh;
use crate::scene::Measures;

/// The measures of every cell, and the numbers of cells and nodes in the file.
#[must_use]
pub fn measure_fields(mesh: &Mesh, measures: &Measures) -> Vec<Field> {
    let real = |name, values: &[f64]| of_elements(name, Values::Real(values.to_vec()));
    let number = |tags: &mut dyn Iterator<Item = u64>| Values::Integer(tags.map(|tag| tag.cast_signed()).collect());
    vec![
        real("certified_min_J_over_Jc", &measures.j_over_jc),
        real("scaled_Jacobian", &measures.scaled_jacobian),
        real("C_WCN", &measures.c_wcn),
        real("C_JAC", &measures.c_jac),
        of_elements("element", number(&mut mesh.cells().iter().map(|own| own.tag))),
        Field {
            name: "node".to_owned(),
            support: Support::Points,
            values: number(&mut mesh.node_tags().iter().copied()),
        },
    ]
}

/// Those of a curved mesh, and whether each cell is straight.
#[cfg(feature = "cad")]
#[must_use]
pub fn fields(curved: &Curved, measures: &Measures) -> Vec<Field> {
    let straight = straight_elements(&curved.mesh, &curved.straight).into_iter().map(i64::from).collect();
    let mut fields = vec![of_elements("straight", Values::Integer(straight))];
    fields.extend(measure_fields(&curved.mesh, measures));
    fields
}

fn of_elements(name: &str, values: Values) -> Field {
    Field { name: name.to_owned(), support: Support::Elements, values }
}
