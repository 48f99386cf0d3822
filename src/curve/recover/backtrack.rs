//! Where elements stay invalid or wall faces folded: the displacement of the nodes around them is taken back, just as far as it
//! must be.
//!
//! Each round halves the displacement of all nodes of the elements that are not proven valid or have a face that is not proven free
//! of folds (below an eighth it is taken back whole) and of their neighbours, and judges what that touches. What is gone back to is a valid mesh, the curved mesh of a
//! lower order or the straight one, so the rounds end in a valid mesh; every wall face that is no longer on the CAD is listed.

use glam::DVec3;

use crate::associate::{Association, Classification};
use crate::certify::{self, Buffer, Elements, MeshElements};
use crate::curve::periodic::PeriodicConstraint;
use crate::curve::proof::{Proof, behind, walls};
use crate::element::{Cell, Order};
use crate::mesh::{Boundary, Mesh};

/// A share of the displacement below this counts as none.
const LEAST_SHARE: f64 = 0.125;

/// A valid mesh to go back to.
#[derive(Clone, Debug, PartialEq)]
pub struct Fallback {
    /// Its order: linear where it is straight.
    pub order: Order,
    /// Places of all nodes.
    pub places: Vec<DVec3>,
}

/// A boundary face that was taken off the CAD so that the elements behind it are valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivenUp {
    /// Its index in [`Boundary::faces`].
    pub face: usize,
    /// The share of its displacement from the fallback that it has, 0 to 1: the least of its nodes.
    pub share: f64,
    /// Order of the fallback.
    pub order: Order,
}

/// Takes displacements back until the proof holds, or nothing is left to take back; `linear` are the places of the linear nodes
/// before they were moved, `proof` that of the mesh as it is. Returns the share of its displacement from the fallback that each
/// node keeps, and the proof.
#[must_use]
pub fn retreat(
    mesh: &mut Mesh,
    fallback: &Fallback,
    linear: &[DVec3],
    boundary: &Boundary,
    association: &Association,
    periodic: &PeriodicConstraint,
    proof: Proof,
) -> (Vec<f64>, Proof) {
    let curved = mesh.points.clone();
    let mut shares = vec![1.0; curved.len()];
    if proof.holds() {
        return (shares, proof);
    }
    let mut failing = proof.failing(mesh, boundary);
    while !failing.is_empty() {
        let touched = take_back(mesh, periodic, &failing, &mut shares);
        if touched.is_empty() {
            break;
        }
        for (n, &share) in shares.iter().enumerate() {
            if share < 1.0 {
                mesh.points[n] = fallback.places[n].lerp(curved[n], share);
            }
        }
        periodic.apply(&mut mesh.points);
        let subset = Subset { whole: MeshElements::new(mesh, &mesh.points, Some(linear)), elements: &touched };
        let outcome = certify::certify(&subset, &certify::Settings::default());
        failing = outcome.failures.iter().map(|judged| touched[judged.element]).collect();
        let moved = |f: usize| boundary.nodes(f, mesh).iter().any(|n| shares[n.index()] < 1.0);
        failing.extend(behind(mesh, boundary, &walls(mesh, linear, boundary, association, moved)));
    }
    let proof = Proof::of(mesh, linear, boundary, association);
    (shares, proof)
}

/// Halves the shares around failing elements; returns all elements that have a node with a changed share, none where all shares
/// were zero already.
fn take_back(mesh: &Mesh, periodic: &PeriodicConstraint, failing: &[usize], shares: &mut [f64]) -> Vec<usize> {
    let mut changed = vec![false; shares.len()];
    let elements: Vec<&[crate::mesh::NodeId]> =
        mesh.blocks_of(3).flat_map(|(_, block)| block.elements(mesh.order)).collect();
    failing.iter().flat_map(|&e| elements[e]).for_each(|n| changed[n.index()] = true);
    let near = |changed: &[bool], e: usize| elements[e].iter().any(|n| changed[n.index()]);
    let ring: Vec<usize> = (0..elements.len()).filter(|&e| near(&changed, e)).collect();
    ring.iter().flat_map(|&e| elements[e]).for_each(|n| changed[n.index()] = true);
    periodic.spread(&mut changed);
    changed.iter_mut().zip(&*shares).for_each(|(changed, &share)| *changed &= share > 0.0);
    for (share, _) in shares.iter_mut().zip(&changed).filter(|(_, changed)| **changed) {
        *share = if *share <= LEAST_SHARE { 0.0 } else { 0.5 * *share };
    }
    (0..elements.len()).filter(|&e| near(&changed, e)).collect()
}

/// The faces tied to the CAD that have a node with less than its whole displacement from a fallback of this order.
#[must_use]
pub fn given_up(
    mesh: &Mesh,
    boundary: &Boundary,
    association: &Association,
    shares: &[f64],
    order: Order,
) -> Vec<GivenUp> {
    let mut faces = Vec::new();
    for face in 0..boundary.faces.len() {
        let share = boundary.nodes(face, mesh).iter().map(|n| shares[n.index()]).fold(1.0, f64::min);
        if share < 1.0 && matches!(association.faces[face], Classification::Surface(_)) {
            faces.push(GivenUp { face, share, order });
        }
    }
    faces
}

/// Some elements of a mesh.
struct Subset<'a> {
    whole: MeshElements<'a>,
    elements: &'a [usize],
}

impl Elements for Subset<'_> {
    fn count(&self) -> usize {
        self.elements.len()
    }

    fn read(&self, element: usize, into: &mut Buffer) -> (Cell, Order) {
        self.whole.read(self.elements[element], into)
    }
}
