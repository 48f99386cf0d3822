//! The objective over a patch, and its derivatives by every node.
//!
//! Elements are evaluated in parallel into slots of their own; a node's sum runs over its slots in rising order, so
//! that the result does not depend on the number of threads.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::Anchor;
use super::density::Density;
use super::derivative::NodeDerivative;
use super::kernel::{Element, Kernel, Weights};
use super::patch::{Patch, Run};
use super::survey::Scratch;
use crate::quality::Cut;

/// Elements that one task evaluates.
const TASK: usize = 64;

pub(super) struct Objective<'a> {
    pub(super) patch: &'a Patch,
    /// One kernel a run of the patch.
    pub(super) kernels: Vec<&'a Kernel>,
    /// How each element is cut, in the order of [`Patch::elements`].
    pub(super) cuts: Vec<Cut>,
    /// Each element's regularisation of determinants, in the same order; it takes the place of that in `weights`.
    pub(super) deltas: Vec<f64>,
    pub(super) weights: Weights,
    /// Nodes of the patch that are drawn back, rising.
    pub(super) anchors: Vec<(usize, Anchor)>,
}

/// Buffers of a task.
#[derive(Default)]
pub(super) struct Gathered {
    points: Vec<DVec3>,
    targets: Vec<DVec3>,
    scratch: Scratch,
}

impl Gathered {
    fn element<'s>(
        &'s mut self,
        nodes: &[u32],
        x: &[DVec3],
        patch: &Patch,
        cut: Cut,
    ) -> (Element<'s>, &'s mut Scratch) {
        // Relative to the first corner: the offset of the model from the origin must not cost digits.
        let (origin, straight) = (x[nodes[0] as usize], patch.targets[nodes[0] as usize]);
        self.points.clear();
        self.points.extend(nodes.iter().map(|&n| x[n as usize] - origin));
        self.targets.clear();
        self.targets.extend(nodes.iter().map(|&n| patch.targets[n as usize] - straight));
        patch.view.turn(&mut self.points);
        patch.view.turn(&mut self.targets);
        (Element { points: &self.points, targets: &self.targets, cut }, &mut self.scratch)
    }
}

impl Objective<'_> {
    /// The objective at the positions `x` of the patch's nodes.
    pub(super) fn value(&self, x: &[DVec3]) -> f64 {
        let mut values = vec![0.0; self.patch.elements.len()];
        for (run, kernel) in self.patch.runs.iter().zip(&self.kernels) {
            let own = &mut values[run.first..run.first + run.count];
            own.par_chunks_mut(TASK).enumerate().for_each_init(Gathered::default, |gathered, (task, values)| {
                for (value, e) in values.iter_mut().zip(task * TASK..) {
                    let (element, scratch) = self.gather(run, e, x, gathered);
                    *value = kernel.value(&element, &self.weights_of(run, e), scratch);
                }
            });
        }
        values.iter().sum::<f64>() + self.springs(x)
    }

    /// The objective and its derivatives by every node of the patch; `slots` is a buffer.
    pub(super) fn derivatives(
        &self,
        x: &[DVec3],
        slots: &mut Vec<NodeDerivative>,
        nodes: &mut Vec<NodeDerivative>,
    ) -> f64 {
        slots.clear();
        slots.resize(self.patch.slots.len(), NodeDerivative::ZERO);
        let mut values = vec![0.0; self.patch.elements.len()];
        for (run, kernel) in self.patch.runs.iter().zip(&self.kernels) {
            let own = &mut values[run.first..run.first + run.count];
            let out = &mut slots[run.slot..run.slot + run.count * run.stride];
            own.par_chunks_mut(TASK).zip(out.par_chunks_mut(TASK * run.stride)).enumerate().for_each_init(
                Gathered::default,
                |gathered, (task, (values, out))| {
                    for ((value, out), e) in values.iter_mut().zip(out.chunks_mut(run.stride)).zip(task * TASK..) {
                        let (element, scratch) = self.gather(run, e, x, gathered);
                        *value = kernel.derivatives(&element, &self.weights_of(run, e), scratch, out);
                    }
                },
            );
        }
        let sum = |node: usize| {
            let mut total = NodeDerivative::ZERO;
            for &slot in self.patch.incident(node) {
                total.gradient += slots[slot as usize].gradient;
                total.hessian += slots[slot as usize].hessian;
            }
            self.patch.view.derivative(total)
        };
        (0..self.patch.nodes.len()).into_par_iter().with_min_len(256).map(sum).collect_into_vec(nodes);
        for &(node, anchor) in &self.anchors {
            let stiffness = 2.0 / (anchor.slack * anchor.slack);
            nodes[node].gradient += (x[node] - anchor.place) * stiffness;
            nodes[node].hessian += DMat3::from_diagonal(DVec3::splat(stiffness));
        }
        values.iter().sum::<f64>() + self.springs(x)
    }

    fn weights_of(&self, run: &Run, element: usize) -> Weights {
        let delta = self.deltas[run.first + element];
        Weights { density: Density { delta, ..self.weights.density }, ..self.weights }
    }

    fn springs(&self, x: &[DVec3]) -> f64 {
        let spring = |(node, anchor): &(usize, Anchor)| {
            (x[*node] - anchor.place).length_squared() / (anchor.slack * anchor.slack)
        };
        self.anchors.iter().map(spring).sum()
    }

    pub(super) fn gather<'s>(
        &self,
        run: &Run,
        element: usize,
        x: &[DVec3],
        gathered: &'s mut Gathered,
    ) -> (Element<'s>, &'s mut Scratch) {
        let nodes = &self.patch.slots[run.slot + element * run.stride..][..run.stride];
        gathered.element(nodes, x, self.patch, self.cuts[run.first + element])
    }
}
