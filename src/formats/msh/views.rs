//! Fields as Gmsh's views: `$NodeData` and `$ElementData`, alike in all versions. Where a field has no value the view has none.

use super::sink::Sink;
use crate::formats::field::{Field, Support, Values};
use crate::formats::part::Unwritten;
use crate::mesh::Mesh;

/// Writes all fields, each as a view.
pub(super) fn write(sink: &mut impl Sink, mesh: &Mesh, fields: &[Field]) -> Result<(), Unwritten> {
    fields.iter().try_for_each(|field| view(sink, mesh, field))
}

fn view(sink: &mut impl Sink, mesh: &Mesh, field: &Field) -> Result<(), Unwritten> {
    let (section, places) = places(mesh, &field.support);
    let mut rows: Vec<(i32, usize)> = Vec::with_capacity(places.len());
    for (tag, place) in places {
        let Ok(tag) = i32::try_from(tag) else {
            let reason = format!("number {tag} is too large for a view of Gmsh's, which has 32 bits for it");
            return Err(Unwritten::Inexpressible(reason));
        };
        if value(&field.values, place)[..components(&field.values)].iter().all(|x| x.is_finite()) {
            rows.push((tag, place));
        }
    }
    let (components, name) = (components(&field.values), field.name.replace(['"', '\n'], "_"));
    sink.open(section)?;
    // A name; a time; the step, the number of components, that of values.
    sink.text(&format!("1\n\"{name}\"\n1\n0.0\n3\n0\n{components}\n{}\n", rows.len()))?;
    sink.rows(rows.len(), |sink, n| {
        let (tag, place) = rows[n];
        sink.int(tag)?;
        sink.reals(&value(&field.values, place)[..components])?;
        sink.end_line()
    })?;
    Ok(sink.close(section)?)
}

/// The section of a field, and number in the file and place of all that may have a value.
fn places(mesh: &Mesh, support: &Support) -> (&'static str, Vec<(u64, usize)>) {
    match support {
        Support::Points => ("NodeData", mesh.node_tags().iter().copied().zip(0..).collect()),
        Support::Elements => ("ElementData", mesh.cells().iter().map(|own| own.tag).zip(0..).collect()),
        Support::Sides(places) => {
            let sides = mesh.sides();
            let own = sides.iter().filter_map(|side| Some((side.tag, places.of(side.corners())?)));
            ("ElementData", own.collect())
        }
    }
}

fn components(values: &Values) -> usize {
    if matches!(values, Values::Vectors(_)) { 3 } else { 1 }
}

fn value(values: &Values, place: usize) -> [f64; 3] {
    match values {
        Values::Real(values) => [values[place], 0.0, 0.0],
        Values::Integer(values) => [values[place] as f64, 0.0, 0.0],
        Values::Vectors(values) => values[place],
    }
}
