//! Fields of a mesh for pictures.

use crate::formats::{Field, Support, Values};
use crate::mesh::Mesh;
use crate::scene::Measures;

/// The measures of every cell, the least of them at every node, and the numbers of cells and nodes in the file. Viewers cut curved cells by
/// what stands at their nodes.
#[must_use]
pub fn measure_fields(mesh: &Mesh, measures: &Measures) -> Vec<Field> {
    let real = [
        ("certified_min_J_over_Jc", &measures.j_over_jc),
        ("scaled_Jacobian", &measures.scaled_jacobian),
        ("C_WCN", &measures.c_wcn),
        ("C_JAC", &measures.c_jac),
    ];
    let number = |tags: &mut dyn Iterator<Item = u64>| Values::Integer(tags.map(|tag| tag.cast_signed()).collect());
    let mut fields: Vec<Field> =
        real.iter().map(|(name, values)| field(name, Support::Elements, Values::Real(values.to_vec()))).collect();
    let element = number(&mut mesh.cells().iter().map(|own| own.tag));
    fields.push(field("element", Support::Elements, element));
    fields.push(field("node", Support::Points, number(&mut mesh.node_tags().iter().copied())));
    let nodal = real.iter().map(|(name, values)| {
        let name = format!("nodal_{name}");
        field(&name, Support::Points, Values::Real(least_at_nodes(mesh, values)))
    });
    fields.extend(nodal);
    fields
}

/// The least value of the cells at each node; NaN at nodes of none.
fn least_at_nodes(mesh: &Mesh, values: &[f64]) -> Vec<f64> {
    let mut least = vec![f64::NAN; mesh.points().len()];
    for (cell, value) in mesh.cells().iter().zip(values) {
        cell.nodes.iter().for_each(|n| least[n.index()] = least[n.index()].min(*value));
    }
    least
}

pub(super) fn field(name: &str, support: Support, values: Values) -> Field {
    Field { name: name.to_owned(), support, values }
}
