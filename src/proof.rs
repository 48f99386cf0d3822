//! What is proven of a curved mesh: that its elements are valid, and that its faces on the CAD do not fold.

use glam::DVec3;
use rustc_hash::FxHashSet;

use crate::associate::{Association, Boundary, Host, normal_at};
use crate::certify::{self, Certificate, WallFace, Walls};
use crate::element::Cell;
use crate::mesh::{Mesh, NodeId};

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
        let certificate = certify::mesh(mesh, Some(linear), &certify::Settings::default());
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
    let tied = |f: usize| matches!(association.faces[f], Host::Surface(_));
    let numbers: Vec<usize> = (0..boundary.faces.len()).filter(|&f| tied(f) && asked(f)).collect();
    let face = |f: usize| {
        let own = &boundary.faces[f];
        let points = mesh.points_of(boundary.nodes(f, mesh)).collect();
        let corners = boundary.corners[f].iter().map(|n| linear[n.index()]).collect();
        WallFace { cell: own.cell, order: mesh.order, points, corners }
    };
    let other = |f: usize| {
        let Host::Surface(surface) = association.faces[f] else { return None };
        let group = &association.surfaces.get(surface)?.group;
        let normals = mesh.points_of(boundary.nodes(f, mesh)).filter_map(|x| normal_at(group, x));
        let corners: Vec<DVec3> = boundary.corners[f].iter().map(|n| linear[n.index()]).collect();
        middle(&towards(certify::mean_normal(&corners), normals.collect()))
    };
    certify::walls(&numbers, face, other, &certify::Settings::default())
}

/// Normals of a surface, turned to the side of `m` all together: one of them alone may rightly be on the other side.
fn towards(m: DVec3, mut normals: Vec<DVec3>) -> Vec<DVec3> {
    if normals.iter().map(|n| n.dot(m)).sum::<f64>() < 0.0 {
        normals.iter_mut().for_each(|normal| *normal = -*normal);
    }
    normals
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
