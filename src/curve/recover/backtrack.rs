//! Backtracking: where elements stay invalid or wall faces folded, the displacement of the nodes around them is reduced, just as
//! far as it must be.
//!
//! Each round halves the displacement of all nodes of the elements that are not proven valid or have a face that is not proven free
//! of folds (below an eighth to nothing) and of their neighbours, and judges what that touches. What is gone back to is a
//! valid mesh, the curved mesh of a lower order or the straight one, so the rounds end in a valid mesh; every wall face that is no
//! longer on the CAD is listed.

use glam::DVec3;

use crate::certify::{self, Buffer, Elements, MeshElements};
use crate::curve::level::Level;
use crate::curve::proof::{Proof, behind, walls};
use crate::element::{Cell, Order};
use crate::mesh::ElementId;

/// A fraction of the displacement below this counts as none.
const LEAST_FRACTION: f64 = 0.125;

/// A valid mesh to go back to.
#[derive(Clone, Debug, PartialEq)]
pub struct Fallback {
    /// Its order: linear where it is straight.
    pub order: Order,
    /// Positions of all nodes.
    pub positions: Vec<DVec3>,
}

/// Reduces displacements until the proof holds, or nothing is left to reduce; `proof` is that of the level as it is. Returns
/// the fraction of its displacement from the fallback that each node keeps, and the proof.
#[must_use]
pub fn backtrack(level: &mut Level, fallback: &Fallback, proof: Proof) -> (Vec<f64>, Proof) {
    let mut fractions = vec![1.0; level.curved.len()];
    if proof.holds() {
        return (fractions, proof);
    }
    let curved = level.curved.clone();
    let mut failing = proof.failing(level);
    while !failing.is_empty() {
        let touched = take_back(level, &failing, &mut fractions);
        if touched.is_empty() {
            break;
        }
        for (n, &fraction) in fractions.iter().enumerate().filter(|(_, fraction)| **fraction < 1.0) {
            level.curved[n] = fallback.positions[n].lerp(curved[n], fraction);
        }
        level.periodic.apply(&mut level.curved);
        failing = still_failing(level, &touched, &fractions);
    }
    (fractions, Proof::of(level))
}

/// Elements of those touched that still fail, and those behind faces that still fold.
fn still_failing(level: &Level, touched: &[ElementId], fractions: &[f64]) -> Vec<ElementId> {
    let whole = MeshElements::new(level.mesh(), &level.curved, Some(level.linear()));
    let outcome = certify::certify(&Subset { whole, elements: touched }, &certify::Settings::default());
    let mut failing: Vec<ElementId> = outcome.failures.iter().map(|judged| judged.element).collect();
    let nodes = |f: usize| level.case.boundary.nodes(f, level.mesh());
    let moved = |f: usize| nodes(f).iter().any(|n| fractions[n.index()] < 1.0);
    failing.extend(behind(level, &walls(level, moved)));
    failing
}

/// Halves the fractions around failing elements; returns all elements that have a node with a changed fraction, none where all
/// fractions were zero already.
fn take_back(level: &Level, failing: &[ElementId], fractions: &mut [f64]) -> Vec<ElementId> {
    let cells = level.mesh().cells();
    let mut changed = vec![false; fractions.len()];
    failing.iter().flat_map(|&e| cells.nodes(e)).for_each(|n| changed[n.index()] = true);
    let around = |changed: &[bool]| -> Vec<ElementId> {
        let near = cells.iter().filter(|own| own.nodes.iter().any(|n| changed[n.index()]));
        near.map(|own| own.id).collect()
    };
    let ring = around(&changed);
    ring.iter().flat_map(|&e| cells.nodes(e)).for_each(|n| changed[n.index()] = true);
    level.periodic.spread(&mut changed);
    changed.iter_mut().zip(&*fractions).for_each(|(changed, &fraction)| *changed &= fraction > 0.0);
    for (fraction, _) in fractions.iter_mut().zip(&changed).filter(|(_, changed)| **changed) {
        *fraction = if *fraction <= LEAST_FRACTION { 0.0 } else { 0.5 * *fraction };
    }
    around(&changed)
}

/// Some cells of a mesh.
struct Subset<'a> {
    whole: MeshElements<'a>,
    elements: &'a [ElementId],
}

impl Elements for Subset<'_> {
    fn count(&self) -> usize {
        self.elements.len()
    }

    fn id(&self, place: usize) -> ElementId {
        self.elements[place]
    }

    fn place(&self, element: ElementId) -> usize {
        self.elements.partition_point(|&own| own < element)
    }

    fn read(&self, element: ElementId, into: &mut Buffer) -> (Cell, Order) {
        self.whole.read(element, into)
    }
}
