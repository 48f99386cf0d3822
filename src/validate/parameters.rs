//! Do parameter vertices evaluate to their points? Only where the writer's parametrisation is this kernel's, or goes over into it by a factor and
//! an offset per parameter (degrees, normalised ranges).

use std::collections::BTreeMap;

use cad::{EntityId, Model};
use glam::DVec3;
use linkage_schema::{Code, Findings, GeometryId, ModelLinks, Origin, ParamVertex, Parameters, VertexRef};

use super::distances::group;
use super::linked_mesh::LinkedMesh;
use super::references::Geometry;

/// Parametrisations match if at least this fraction of an entity's vertices evaluate to their points.
const MATCH: f64 = 0.5;
/// Vertices below which no factor and offset are sought.
const ENOUGH: usize = 4;

/// A vertex, its point and its parameters.
struct Vertex<'a> {
    vertex: &'a ParamVertex,
    place: DVec3,
    given: [f64; 2],
}

pub(super) fn check(
    linked: &LinkedMesh<'_>,
    models: &[&ModelLinks<'_>],
    model: &Model,
    geometry: &Geometry,
    tolerance: f64,
    findings: &mut Findings,
) {
    let mut by_entity: BTreeMap<GeometryId, Vec<Vertex<'_>>> = BTreeMap::new();
    for links in models {
        let linked = linked.within(links.model);
        let of_sheets = links.sheets.iter().flat_map(|sheet| sheet.parameters());
        let of_strings = links.strings.iter().flat_map(|string| string.parameters());
        for vertex in of_sheets.chain(of_strings).chain(&links.model.parameters) {
            let VertexRef::Index(index) = vertex.vertex else { continue };
            let Some(node) = linked.node(index) else { continue };
            let given = match vertex.parameters {
                Parameters::Curve(t) => [t, 0.0],
                Parameters::Surface(u, v) => [u, v],
            };
            let place = linked.mesh.points()[node.index()];
            by_entity.entry(vertex.gref).or_default().push(Vertex { vertex, place, given });
        }
    }
    let mut foreign: Option<Origin> = None;
    let mut count = 0;
    for (id, vertices) in by_entity {
        let &[entity] = geometry.of_id(id) else { continue };
        match misplaced(&vertices, entity, model, tolerance) {
            Some(wrong) => wrong.into_iter().for_each(|(vertex, distance)| tell(vertex, entity, distance, findings)),
            None => {
                foreign.get_or_insert(vertices[0].vertex.origin);
                count += 1;
            }
        }
    }
    if let Some(origin) = foreign {
        findings.push(Code::ForeignParameters, origin, || {
            format!("the parameters on {count} CAD entities are not this kernel's")
        });
    }
}

fn tell(vertex: &ParamVertex, entity: EntityId, distance: f64, findings: &mut Findings) {
    findings.push(Code::WrongParameters, vertex.origin, || {
        format!("the parameters of point {} on {entity} evaluate to a position {distance:.3e} away", vertex.vertex)
    });
}

/// Vertices that do not evaluate to their points, where most do; `None` where the parametrisation is another.
fn misplaced<'a, 'b>(
    vertices: &'b [Vertex<'a>],
    entity: EntityId,
    model: &Model,
    tolerance: f64,
) -> Option<Vec<(&'a ParamVertex, f64)>> {
    let group = group(model, &[entity])?.ok()?;
    // A point off the CAD is reported otherwise, and has no parameters.
    let on_entity = |vertex: &'b Vertex<'a>| {
        let foot = group.closest(vertex.place, None).filter(|foot| foot.distance <= tolerance)?;
        Some((vertex, foot.parameters))
    };
    let (vertices, own): (Vec<&Vertex<'a>>, Vec<Option<[f64; 2]>>) = vertices.iter().filter_map(on_entity).unzip();
    let same = |given: [f64; 2]| given;
    judge(&vertices, entity, model, tolerance, &same).or_else(|| {
        let maps = [fit(&vertices, &own, 0)?, fit(&vertices, &own, 1)?];
        let moved = |given: [f64; 2]| std::array::from_fn(|axis| maps[axis][0] * given[axis] + maps[axis][1]);
        judge(&vertices, entity, model, tolerance, &moved)
    })
}

fn judge<'a>(
    vertices: &[&Vertex<'a>],
    entity: EntityId,
    model: &Model,
    tolerance: f64,
    map: &dyn Fn([f64; 2]) -> [f64; 2],
) -> Option<Vec<(&'a ParamVertex, f64)>> {
    let mut wrong = Vec::new();
    for vertex in vertices {
        let at = model.evaluate(entity, map(vertex.given)).map(|found| found.point().distance(vertex.place));
        let distance = at.unwrap_or(f64::INFINITY);
        if distance > 2.0 * tolerance {
            wrong.push((vertex.vertex, distance));
        }
    }
    ((wrong.len() as f64) <= (1.0 - MATCH) * vertices.len() as f64).then_some(wrong)
}

/// Factor and offset that take most given parameters of one axis to the CAD's own: medians over pairs.
fn fit(vertices: &[&Vertex<'_>], own: &[Option<[f64; 2]>], axis: usize) -> Option<[f64; 2]> {
    let pair = |(vertex, own): (&&Vertex<'_>, &Option<[f64; 2]>)| Some([vertex.given[axis], own.as_ref()?[axis]]);
    let pairs: Vec<[f64; 2]> = vertices.iter().zip(own).filter_map(pair).collect();
    if pairs.len() < ENOUGH {
        return None;
    }
    let half = pairs.len() / 2;
    let slopes = pairs.iter().zip(&pairs[half..]).filter(|([a, _], [b, _])| a != b);
    let slope = median(slopes.map(|([a, x], [b, y])| (y - x) / (b - a)).collect()).unwrap_or(0.0);
    let offset = median(pairs.iter().map(|[given, own]| own - slope * given).collect())?;
    Some([slope, offset])
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
