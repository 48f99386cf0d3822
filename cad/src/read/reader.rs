//! Parsing a file with OCCT: in this process, or in a child that rehearses everything and hands the model to its parent.

use crate::child;
use crate::closest::group::Group;
use crate::geometry::chart::{Chart, Rect};
use crate::geometry::curve::Curve;
use crate::geometry::leaf::FaceGeometry;
use crate::ids::{EdgeId, EntityId, FaceId};
use crate::model::{Model, SourceFormat};
use crate::read::assemble;
use crate::read::format;
use crate::read::payload::{self, Answer, Description, RawLabel};
use crate::tolerance::INFINITE;
use glam::DVec3;
use opencascade_sys as sys;
use std::path::Path;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};

/// First argument at which a program that serves as [`Reader`](crate::Reader) must call [`serve_reader`]; the second is the file.
pub const READER_SUBCOMMAND: &str = "__read-cad";

/// Variable in which the parent hands [`ReadOptions::scale`](crate::ReadOptions::scale) to the child.
pub(crate) const SCALE_VARIABLE: &str = "SAGITTA_READER_SCALE";

/// Body of the hidden subcommand: reads the file with OCCT, rehearses on every entity what the parent will do, and writes the model to
/// standard output. Nothing else reaches standard output, whatever OCCT prints.
pub fn serve_reader(path: &Path) -> ExitCode {
    child::keep_to_limits();
    sys::tell_crashes();
    let Some(out) = child::take_stdout() else { return ExitCode::FAILURE };
    let (answer, shape) = match rehearsed(path) {
        Ok((description, shape)) => (Answer::Model(description), shape),
        Err(cause) => (Answer::Failure(cause), Vec::new()),
    };
    match payload::write(std::io::BufWriter::new(out), &answer, &shape) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

fn scale() -> f64 {
    std::env::var(SCALE_VARIABLE).ok().and_then(|text| text.parse().ok()).unwrap_or(1.0)
}

/// What the parent will need, after all has gone well that it will do with it.
fn rehearsed(path: &Path) -> Result<(Description, Vec<u8>), String> {
    let scale = scale();
    let Parsed { description, shape, bytes } = parse(path, scale, true)?;
    sys::stand_at("the shapes");
    let model = assemble::model(path, &shape, description.clone(), scale)?;
    check(&model)?;
    rehearse(&model);
    Ok((description, bytes))
}

/// Readers of OCCT share settings: one at a time.
static ONE: Mutex<()> = Mutex::new(());

/// Reads a file in this process. What makes OCCT crash ends it.
///
/// # Errors
/// What OCCT or [`check`] said.
pub(crate) fn read_here(path: &Path, scale: f64) -> Result<Model, String> {
    let Parsed { description, shape, .. } = {
        let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner); // it guards no data
        parse(path, scale, false)?
    };
    let model = assemble::model(path, &shape, description, scale)?;
    check(&model).map(|()| model)
}

/// What OCCT made of a file.
struct Parsed {
    description: Description,
    /// As it comes out of `bytes`: the same shape whoever read the file.
    shape: sys::UniquePtr<sys::Shape>,
    bytes: Vec<u8>,
}

fn parse(path: &Path, scale: f64, announce: bool) -> Result<Parsed, String> {
    let format = match format::detect(path) {
        Ok(Some(format)) => format,
        Ok(None) => return Err("it is neither STEP nor IGES nor BREP".into()),
        Err(error) => return Err(error.to_string()),
    };
    let name = path.to_str().ok_or("its path is not UTF-8, which OCCT needs")?;
    let asked = match format {
        SourceFormat::Step => sys::Format::Step,
        SourceFormat::Iges => sys::Format::Iges,
        SourceFormat::Brep => sys::Format::Brep,
    };
    let import = sys::read_file(name, asked, scale, announce).map_err(|error| error.to_string())?;
    let label = |label: sys::Label| RawLabel {
        kind: label.kind,
        index: label.index,
        reference: label.reference,
        name: label.name,
    };
    let description = Description {
        format,
        unit_name: import.unit(),
        millimetres: import.millimetres_per_unit(),
        labels: import.labels().into_iter().map(label).collect(),
        dropped: import.dropped(),
        warnings: import.warnings(),
    };
    let bytes = import.shape().bytes().map_err(|error| error.to_string())?;
    let shape = sys::shape_from_bytes(&bytes).map_err(|error| error.to_string())?;
    Ok(Parsed { description, shape, bytes })
}

/// The first entity whose points, poles or axes are not finite. What OCCT alone evaluates is not looked at.
fn infinite(model: &Model) -> Option<EntityId> {
    let geometry = model.geometry();
    let face = |id: FaceId| {
        let FaceGeometry { chart, leaves, .. } = &geometry.faces[id.index()];
        leaves.iter().any(|leaf| surface_is_infinite(chart, leaf.rect))
    };
    let edge = |id: EdgeId| {
        let edge = geometry.edges[id.index()].as_ref();
        edge.is_some_and(|edge| edge.leaves.iter().any(|leaf| curve_is_infinite(&edge.curve, leaf.range)))
    };
    let faces = model.faces().iter().map(|f| f.id).filter(|&id| face(id)).map(EntityId::Face);
    let edges = model.edges().iter().map(|e| e.id).filter(|&id| edge(id)).map(EntityId::Edge);
    let vertices = model.vertices().iter().filter(|v| is_infinite(v.point)).map(|v| EntityId::Vertex(v.id));
    faces.chain(edges).chain(vertices).next()
}

fn is_infinite(p: DVec3) -> bool {
    !(p.is_finite() && p.abs().max_element() < INFINITE)
}

fn surface_is_infinite(chart: &Chart, rect: Rect) -> bool {
    match chart {
        Chart::Offset { basis, .. } => surface_is_infinite(basis, rect),
        Chart::Opaque { .. } => false,
        _ => chart.hull(rect).points.iter().any(|&p| is_infinite(p)),
    }
}

fn curve_is_infinite(curve: &Curve, range: [f64; 2]) -> bool {
    match curve {
        Curve::Offset { basis, .. } => curve_is_infinite(basis, range),
        Curve::Opaque { .. } => false,
        _ => curve.hull(range[0], range[1]).points.iter().any(|&p| is_infinite(p)),
    }
}

/// Whether there is something to project on, and all of it is finite.
fn check(model: &Model) -> Result<(), String> {
    if model.faces().is_empty() && model.edges().is_empty() {
        return Err("no face and no edge came out of it".into());
    }
    if let Some(id) = infinite(model) {
        let of = model.label(id).map(|label| label.reference.as_str()).filter(|reference| !reference.is_empty());
        let known = of.map_or_else(String::new, |reference| format!(" ({reference})"));
        return Err(format!("{id}{known} has a coordinate that is not a number, or is infinite"));
    }
    Ok(())
}

/// Does on every entity what the parent's queries do, so that what makes OCCT crash does it here.
fn rehearse(model: &Model) {
    for face in model.faces() {
        sys::stand_at(&face.id.to_string());
        let [u, v] = face.parameters;
        for (s, t) in
            [(u[0], v[0]), (u[1], v[0]), (u[0], v[1]), (u[1], v[1]), (0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]))]
        {
            let _ = model.evaluate(face.id.into(), [s, t]);
        }
        for side in &model.geometry().faces[face.id.index()].sides {
            for t in [side.range[0], 0.5 * (side.range[0] + side.range[1]), side.range[1]] {
                let _ = side.pcurve.d1(t, &mut [0.0; 4]);
            }
        }
        if let Ok(group) = Group::of_faces(model, &[face.id]) {
            let _ = group.closest(face.bounds.center(), None);
        }
    }
    for edge in model.edges() {
        sys::stand_at(&edge.id.to_string());
        for t in edge.parameters {
            let _ = model.evaluate(edge.id.into(), [t, 0.0]);
        }
    }
}
