//! What is proven of a curved mesh: that its elements are valid, and that its faces on the CAD do not fold.

use cad::Group;
use glam::DVec3;
use rustc_hash::FxHashSet;

use crate::associate::{Association, Classification, normal_at};
use crate::certify::{self, Certificate, WallFace, Walls};
use crate::element::{Cell, Order, Samples, basis};
use crate::mesh::{Boundary, Mesh, NodeId};

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
    /// Judges a mesh; `linear` are the places of its linear nodes before they were moved.
    #[must_use]
    pub fn of(mesh: &Mesh, linear: &[DVec3], boundary: &Boundary, association: &Association) -> Proof {
        let certificate = certify::mesh(mesh, &mesh.points, Some(linear), &certify::Settings::default());
        Proof { certificate, walls: walls(mesh, linear, boundary, association, |_| true) }
    }

    /// Whether every element is proven valid and every face on the CAD free of folds.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.certificate.holds() && self.walls.hold()
    }

    /// Numbers of the elements that are not proven valid or have a face that is not proven free of folds, rising.
    #[must_use]
    pub fn failing(&self, mesh: &Mesh, boundary: &Boundary) -> Vec<usize> {
        let mut failing: Vec<usize> = self.certificate.failures.iter().map(|judged| judged.element).collect();
        failing.extend(behind(mesh, boundary, &self.walls));
        failing.sort_unstable();
        failing.dedup();
        failing
    }
}

/// Judges those of the faces on the CAD that are `asked` for, by their index in [`Boundary::faces`].
pub(crate) fn walls(
    mesh: &Mesh,
    linear: &[DVec3],
    boundary: &Boundary,
    association: &Association,
    asked: impl Fn(usize) -> bool,
) -> Walls {
    let tied = |f: usize| matches!(association.faces[f], Classification::Surface(_));
    let numbers: Vec<usize> = (0..boundary.faces.len()).filter(|&f| tied(f) && asked(f)).collect();
    let face = |f: usize| {
        let own = &boundary.faces[f];
        let points = mesh.points_of(boundary.nodes(f, mesh)).collect();
        let corners = boundary.corners[f].iter().map(|n| linear[n.index()]).collect();
        WallFace { cell: own.cell, order: mesh.order, points, corners }
    };
    let other = |f: usize| {
        let Classification::Surface(surface) = association.faces[f] else { return None };
        axis(mesh, boundary, f, &association.surfaces.get(surface)?.group)
    };
    certify::walls(&numbers, face, other, &certify::Settings::default())
}

/// The middle of a face's normals, where they are all on the side of the CAD's normals beside them; as surveyed, not proven.
fn axis(mesh: &Mesh, boundary: &Boundary, face: usize, group: &Group) -> Option<DVec3> {
    let (cell, order) = (boundary.faces[face].cell, mesh.order);
    let nodes: Vec<DVec3> = mesh.points_of(boundary.nodes(face, mesh)).collect();
    let samples = Samples::survey(cell, Order::LINEAR, SURVEY * order.get());
    let (mut own, mut agreement) = (Vec::new(), Vec::new());
    for &at in &samples.points()[..samples.count()] {
        let (values, slopes) = (basis::values(cell, order, at), basis::gradients(cell, order, at));
        let place: DVec3 = nodes.iter().zip(values).map(|(x, v)| *x * v).sum();
        let along = |axis: usize| -> DVec3 { nodes.iter().zip(&slopes).map(|(x, s)| *x * s[axis]).sum() };
        let normal = along(0).cross(along(1)).try_normalize()?;
        agreement.extend(normal_at(group, place).map(|cad| cad.dot(normal)));
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
pub(crate) fn behind(mesh: &Mesh, boundary: &Boundary, walls: &Walls) -> Vec<usize> {
    if walls.hold() {
        return Vec::new();
    }
    let faces: FxHashSet<usize> = walls.failures.iter().map(|own| own.face).collect();
    let elements = mesh.blocks_of(3).flat_map(|(_, block)| block.elements(mesh.order).map(|nodes| (block.cell, nodes)));
    let corners = faces.iter().flat_map(|&face| boundary.corners[face].iter().copied());
    let corners: FxHashSet<NodeId> = corners.collect();
    let has_face = |cell: Cell, nodes: &[NodeId]| {
        nodes.iter().any(|n| corners.contains(n))
            && cell.faces().iter().any(|face| {
                let corners: Vec<NodeId> = face.corners.iter().map(|&c| nodes[usize::from(c)]).collect();
                boundary.face(&corners).is_some_and(|face| faces.contains(&face))
            })
    };
    elements.enumerate().filter(|(_, (cell, nodes))| has_face(*cell, nodes)).map(|(e, _)| e).collect()
}
