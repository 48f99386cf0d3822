//! From OCCT's shape to a [`Model`]: the same code runs in the reading child, as a rehearsal, and in the parent.

use crate::boxes::Aabb;
use crate::geometry::chart::{Chart, Rect};
use crate::geometry::curve::Curve;
use crate::geometry::leaf::{EdgeGeometry, FaceGeometry, Side, edge_leaves, face_leaves};
use crate::geometry::trim::{Trim, Wire};
use crate::ids::{EdgeId, EntityId, FaceId, VertexId};
use crate::model::{Edge, Face, Geometry, Kind, Label, Model, NamedGroup, Vertex};
use crate::read::payload::{Description, RawLabel};
use glam::DVec3;
use opencascade_sys as sys;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

fn kind_of(kind: sys::Kind) -> Kind {
    match kind {
        sys::Kind::Plane => Kind::Plane,
        sys::Kind::Cylinder => Kind::Cylinder,
        sys::Kind::Cone => Kind::Cone,
        sys::Kind::Sphere => Kind::Sphere,
        sys::Kind::Torus => Kind::Torus,
        sys::Kind::Revolution => Kind::Revolution,
        sys::Kind::Extrusion => Kind::Extrusion,
        sys::Kind::Offset => Kind::Offset,
        sys::Kind::Bezier => Kind::Bezier,
        sys::Kind::Bspline => Kind::Bspline,
        sys::Kind::Line => Kind::Line,
        sys::Kind::Circle => Kind::Circle,
        sys::Kind::Ellipse => Kind::Ellipse,
        sys::Kind::Parabola => Kind::Parabola,
        sys::Kind::Hyperbola => Kind::Hyperbola,
        _ => Kind::Other,
    }
}

/// Names the entity in front of OCCT's message.
fn at<T>(what: &str, i: usize, result: Result<T, sys::Exception>) -> Result<T, String> {
    result.map_err(|error| format!("{what}:{}: {error}", i + 1))
}

/// A face's data before its leaves are cut.
struct OpenFace {
    geometry: FaceGeometry,
    face: Face,
}

fn open_face(shape: &sys::Shape, i: usize) -> Result<OpenFace, String> {
    let name = "face";
    let data = at(name, i, shape.face(i))?;
    let mut rect = Rect { u: [data.u_min, data.u_max], v: [data.v_min, data.v_max] };
    let finite = [rect.u, rect.v].as_flattened().iter().all(|t| t.abs() < 1e50);
    if !finite {
        return Err(format!("face:{}: its parameters have no finite bounds", i + 1));
    }
    let handle = Arc::new(at(name, i, shape.surface(i))?);
    let kind = kind_of(at(name, i, handle.form())?.kind);
    let chart = at(name, i, Chart::new(Arc::clone(&handle), rect))?;
    let (sides, wires) = at(name, i, sides_of(shape, i))?;
    let (trim, outer) = Trim::new(wires, chart.periods());
    if let Some(outer) = outer {
        let within = |a: [f64; 2], b: [f64; 2]| [a[0].max(b[0]), a[1].min(b[1])];
        rect = Rect { u: within(rect.u, outer.u), v: within(rect.v, outer.v) };
    }
    let mut edges: Vec<EdgeId> = sides.iter().filter_map(|side| side.edge).map(EdgeId::new).collect();
    edges.sort_unstable();
    edges.dedup();
    let face = Face {
        id: FaceId::new(i),
        label: Label::default(),
        kind,
        tolerance: data.tolerance,
        bounds: Aabb::EMPTY,
        reversed: data.reversed,
        parameters: [rect.u, rect.v],
        edges,
    };
    let geometry = FaceGeometry { handle, chart, rect, trim, sides, leaves: Vec::new(), reversed: data.reversed };
    Ok(OpenFace { geometry, face })
}

fn sides_of(shape: &sys::Shape, face: usize) -> Result<(Vec<Side>, Vec<Wire>), sys::Exception> {
    let loops = shape.loops(face)?;
    let mut sides = Vec::new();
    let mut spans = Vec::new();
    for k in 0..loops.count() {
        let coedge = loops.coedge(k)?;
        let pcurve = loops.pcurve(k)?;
        spans.push((pcurve.spans()?, coedge.reversed));
        let edge = usize::try_from(coedge.edge).ok();
        sides.push(Side { edge, wire: coedge.wire, seam: coedge.seam, range: [coedge.first, coedge.last], pcurve });
    }
    let mut wires = Vec::new();
    for wire in sides.chunk_by(|a, b| a.wire == b.wire) {
        let rest = spans.split_off(wire.len());
        wires.push(Wire::new(spans.iter().map(|(spans, reversed)| (spans, *reversed))));
        spans = rest;
    }
    Ok((sides, wires))
}

fn open_edge(shape: &sys::Shape, i: usize) -> Result<(Edge, Option<EdgeGeometry>), String> {
    let data = at("edge", i, shape.edge(i))?;
    let vertex = |number: i32| usize::try_from(number).ok().map(VertexId::new);
    let range = [data.first, data.last];
    let mut edge = Edge {
        id: EdgeId::new(i),
        label: Label::default(),
        kind: Kind::Degenerate,
        tolerance: data.tolerance,
        bounds: Aabb::EMPTY,
        degenerate: data.degenerate,
        seam: false,
        parameters: range,
        ends: [vertex(data.start), vertex(data.end)],
        faces: Vec::new(),
    };
    if data.degenerate {
        return Ok((edge, None));
    }
    if range.iter().any(|t| t.abs() > 1e50 || t.is_nan()) {
        return Err(format!("edge:{}: its curve has no finite bounds", i + 1));
    }
    let handle = Arc::new(at("edge", i, shape.curve(i))?);
    edge.kind = kind_of(at("edge", i, handle.form())?.kind);
    let curve = at("edge", i, Curve::new(Arc::clone(&handle), range[0], range[1]))?;
    Ok((edge, Some(EdgeGeometry { handle, curve, range, tolerance: data.tolerance, leaves: Vec::new() })))
}

/// Builds the model from a shape and what the child said about it.
///
/// # Errors
/// What OCCT said and about which entity.
pub(crate) fn model(path: &Path, shape: &sys::Shape, description: Description, scale: f64) -> Result<Model, String> {
    let vertices: Vec<Vertex> = (0..shape.vertex_count())
        .map(|i| {
            let data = at("vertex", i, shape.vertex(i))?;
            let point = DVec3::new(data.x, data.y, data.z);
            Ok(Vertex { id: VertexId::new(i), label: Label::default(), point, tolerance: data.tolerance })
        })
        .collect::<Result<_, String>>()?;
    let (mut edges, mut curves): (Vec<Edge>, Vec<Option<EdgeGeometry>>) =
        (0..shape.edge_count()).map(|i| open_edge(shape, i)).collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
    let (mut faces, mut surfaces): (Vec<Face>, Vec<FaceGeometry>) = (0..shape.face_count())
        .map(|i| open_face(shape, i).map(|open| (open.face, open.geometry)))
        .collect::<Result<Vec<_>, _>>()?
        .into_iter()
        .unzip();
    cut_into_leaves(&mut faces, &mut surfaces, &mut edges, &mut curves);
    link(&mut faces, &surfaces, &mut edges, &vertices);
    let bounds =
        faces.iter().map(|face| face.bounds).chain(edges.iter().map(|edge| edge.bounds)).fold(Aabb::EMPTY, Aabb::union);
    let bounds = vertices.iter().fold(bounds, |all, vertex| all.with_point(vertex.point));
    let geometry = Geometry {
        faces: surfaces,
        ends: edges.iter().map(|edge| edge.ends).collect(),
        edges: curves,
        vertices: vertices.iter().map(|vertex| (vertex.point, vertex.tolerance)).collect(),
    };
    let mut model = Model {
        path: path.to_path_buf(),
        format: description.format,
        unit: description.unit(),
        scale,
        faces,
        edges,
        vertices,
        groups: Vec::new(),
        dropped: Vec::new(),
        warnings: Vec::new(),
        sewing: OnceLock::new(),
        bounds,
        geometry: Arc::new(geometry),
    };
    describe(&mut model, description);
    Ok(model)
}

fn cut_into_leaves(
    faces: &mut [Face],
    surfaces: &mut [FaceGeometry],
    edges: &mut [Edge],
    curves: &mut [Option<EdgeGeometry>],
) {
    edges.par_iter_mut().zip(curves.par_iter_mut()).for_each(|(edge, curve)| {
        if let Some(curve) = curve {
            curve.leaves = edge_leaves(&curve.curve, curve.range);
            edge.bounds = curve.bounds();
        }
    });
    faces.par_iter_mut().zip(surfaces.par_iter_mut()).for_each(|(face, surface)| {
        surface.leaves = face_leaves(&surface.chart, surface.rect, &surface.trim);
        face.bounds = surface.bounds();
    });
}

/// What needs all entities: which faces an edge bounds, seams, boxes that take in the boundary.
fn link(faces: &mut [Face], surfaces: &[FaceGeometry], edges: &mut [Edge], vertices: &[Vertex]) {
    for edge in edges.iter_mut() {
        let points = edge.ends.iter().flatten().map(|id| vertices[id.index()].point);
        edge.bounds = edge.bounds.union(if edge.degenerate { Aabb::of_points(points) } else { Aabb::EMPTY });
    }
    for (face, surface) in faces.iter_mut().zip(surfaces) {
        for side in &surface.sides {
            let Some(edge) = side.edge.and_then(|edge| edges.get_mut(edge)) else { continue };
            edge.seam |= side.seam;
            if edge.faces.last() != Some(&face.id) {
                edge.faces.push(face.id);
            }
            face.bounds = face.bounds.union(edge.bounds);
        }
    }
}

/// Names, references, groups, what was dropped.
fn describe(model: &mut Model, description: Description) {
    let mut named: [BTreeMap<String, Vec<EntityId>>; 2] = Default::default();
    let mut groups: BTreeMap<(String, String), Vec<EntityId>> = BTreeMap::new();
    for label in description.labels {
        let index = label.index as usize;
        let own = Label { name: label.name.clone(), reference: label.reference.clone() };
        match label.kind {
            RawLabel::FACE => {
                named[0].entry(label.name).or_default().push(FaceId::new(index).into());
                set(&mut model.faces, index, |face| face.label = own);
            }
            RawLabel::EDGE => {
                named[1].entry(label.name).or_default().push(EdgeId::new(index).into());
                set(&mut model.edges, index, |edge| edge.label = own);
            }
            RawLabel::VERTEX => set(&mut model.vertices, index, |vertex| vertex.label = own),
            kind => {
                let member =
                    if kind == RawLabel::FACE_OF_GROUP { FaceId::new(index).into() } else { EdgeId::new(index).into() };
                groups.entry((label.reference, label.name)).or_default().push(member);
            }
        }
    }
    let ready = groups.into_iter().map(|((reference, name), members)| NamedGroup { name, reference, members });
    let [faces, mut edges] = named;
    edges.retain(|name, _| !faces.contains_key(name));
    let shared = faces.into_iter().chain(edges).filter(|(name, members)| !name.is_empty() && members.len() > 1);
    let shared = shared.map(|(name, members)| NamedGroup { name, reference: String::new(), members });
    model.groups = ready.chain(shared).collect();
    for group in &mut model.groups {
        group.members.sort_unstable();
        group.members.dedup();
    }
    model.dropped = description.dropped;
    model.warnings = description.warnings;
}

/// Edits the entity with this index, if there is one.
fn set<T>(entities: &mut [T], index: usize, edit: impl FnOnce(&mut T)) {
    if let Some(entity) = entities.get_mut(index) {
        edit(entity);
    }
}
