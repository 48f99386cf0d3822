//! What is proven of a curved mesh: that its elements are valid, and that its faces on the CAD do not fold.

use cad::Group;
use glam::DVec3;
use rustc_hash::FxHashSet;

use super::level::{Case, Level};
use crate::associate::{Classification, normal_at};
use crate::certify::{self, Certificate, WallFace, Walls};
use crate::element::{Order, Samples, basis};
use crate::mesh::{Element, ElementId, NodeId};

/// Divisions an edge, times the order, at which a face that leans far is compared with the CAD's normals.
const SURVEY: usize = 4;
/// Steps towards the middle of normals.
const TURNS: u32 = 30;

/// A mesh's certificate, and that of its faces on the CAD.
#[derive(Clone, Debug)]
pub struct Proof {
    /// Of the elements.
    pub certificate: Certificate,
    /// Of the faces on the CAD.
    pub walls: Walls,
}

impl Proof {
    /// Judges a level's curved mesh.
    #[must_use]
    pub fn of(level: &Level) -> Proof {
        let settings = certify::Settings::default();
        let (mesh, linear) = (level.mesh(), level.linear());
        let certificate = if level.case.settings.surface {
            certify::surface(mesh, &level.curved, linear, &settings)
        } else {
            certify::mesh(mesh, &level.curved, Some(linear), &settings)
        };
        Proof { certificate, walls: walls(level, |_| true) }
    }

    /// Whether every element is proven valid and every face on the CAD free of folds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.certificate.holds() && self.walls.hold()
    }

    /// Numbers of the elements that are not proven valid or have a face that is not proven free of folds, rising.
    #[must_use]
    pub fn failing(&self, level: &Level) -> Vec<ElementId> {
        let mut failing: Vec<ElementId> = self.certificate.failures.iter().map(|judged| judged.element).collect();
        failing.extend(behind(level, &self.walls));
        failing.sort_unstable();
        failing.dedup();
        failing
    }
}

/// Judges those of the faces on the CAD that are `asked` for, by their index in [`Boundary::faces`](crate::mesh::Boundary::faces).
pub(crate) fn walls(level: &Level, asked: impl Fn(usize) -> bool) -> Walls {
    let (Case { boundary, association, .. }, linear) = (level.case, level.linear());
    let on_surface = |f: usize| matches!(association.faces[f], Classification::Surface(_));
    let numbers: Vec<usize> = (0..boundary.faces.len()).filter(|&f| on_surface(f) && asked(f)).collect();
    let face = |f: usize| {
        let corners = boundary.corners[f].iter().map(|n| linear[n.index()]).collect();
        let (cell, order, points) = (boundary.faces[f].cell, level.mesh().order(), positions(level, f));
        WallFace { cell, order, points, corners, plane: boundary.plane.map(|plane| plane.normal) }
    };
    let other = |f: usize| {
        let Classification::Surface(surface) = association.faces[f] else { return None };
        if boundary.plane.is_some() {
            return None;
        }
        axis(level, f, &association.surfaces.get(surface)?.group)
    };
    certify::walls(&numbers, face, other, &certify::Settings::default())
}

/// Curved coordinates of a boundary face's nodes.
fn positions(level: &Level, face: usize) -> Vec<DVec3> {
    level.case.boundary.nodes(face, level.mesh()).iter().map(|n| level.curved[n.index()]).collect()
}

/// The middle of a face's normals, where they are all on the side of the CAD's normals beside them; as surveyed, not proven.
fn axis(level: &Level, face: usize, group: &Group) -> Option<DVec3> {
    let (cell, order) = (level.case.boundary.faces[face].cell, level.mesh().order());
    let nodes = positions(level, face);
    let samples = Samples::survey(cell, Order::LINEAR, SURVEY * order.get());
    let (mut own, mut agreement) = (Vec::new(), Vec::new());
    for &at in &samples.points()[..samples.count()] {
        let (values, slopes) = (basis::values(cell, order, at), basis::gradients(cell, order, at));
        let position: DVec3 = nodes.iter().zip(values).map(|(x, v)| *x * v).sum();
        let along = |axis: usize| -> DVec3 { nodes.iter().zip(&slopes).map(|(x, s)| *x * s[axis]).sum() };
        let normal = along(0).cross(along(1)).try_normalize()?;
        agreement.extend(normal_at(group, position).map(|cad| cad.dot(normal)));
        own.push(normal);
    }
    let alike = |sign: f64| !agreement.is_empty() && agreement.iter().all(|cosine| cosine * sign > 0.0);
    if alike(1.0) || alike(-1.0) { middle(&own) } else { None }
}

/// The axis of the narrowest cone around unit vectors, nearly (Badoiu and Clarkson 2003, "Smaller core-sets for balls").
fn middle(vectors: &[DVec3]) -> Option<DVec3> {
    let mut axis = vectors.iter().sum::<DVec3>().try_normalize()?;
    for step in 0..TURNS {
        let farthest = vectors.iter().min_by(|a, b| a.dot(axis).total_cmp(&b.dot(axis)))?;
        axis = axis.lerp(*farthest, 1.0 / f64::from(step + 2)).try_normalize()?;
    }
    Some(axis)
}

/// Numbers of the elements behind faces that are not proven free of folds, rising.
pub(crate) fn behind(level: &Level, walls: &Walls) -> Vec<ElementId> {
    behind_faces(level, &walls.failures.iter().map(|own| own.face).collect())
}

/// Numbers of the elements behind boundary faces, rising.
pub(crate) fn behind_faces(level: &Level, faces: &FxHashSet<usize>) -> Vec<ElementId> {
    if faces.is_empty() {
        return Vec::new();
    }
    let boundary = level.case.boundary;
    let corners = faces.iter().flat_map(|&face| boundary.corners[face].iter().copied());
    let corners: FxHashSet<NodeId> = corners.collect();
    let has_face = |own: &Element| {
        own.corners().iter().any(|n| corners.contains(n))
            && own.sides().any(|side| boundary.face_of(side).is_some_and(|face| faces.contains(&face)))
    };
    level.mesh().cells().iter().filter(has_face).map(|own| own.id).collect()
}
