//! The engine: preconditioned L-BFGS on the whole patch.
//!
//! The preconditioner is the inverse of every node's exact 3x3 Hessian block, so that the first step is a Newton
//! step of each node alone, layer-normal and tangential directions each at their own scale (they differ by the aspect
//! ratio, 5 000 and more); the memory adds what couples the nodes, along a column of layers above all. All nodes
//! move together, so a layer can move as one.

use std::collections::VecDeque;

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::block::positive_inverse;
use super::derivative::NodeDerivative;
use super::objective::Objective;
use super::{Constraint, Freedom};

/// Pairs of steps and gradient changes that are remembered.
const MEMORY: usize = 8;
/// Share of the predicted decrease that a step must bring (Armijo).
const SUFFICIENT: f64 = 1e-4;
/// A line search gives up at this fraction of the full step.
const SHORTEST: f64 = 1e-6;
/// Eigenvalues of a block below this fraction of the largest count as zero.
const FLAT: f64 = 1e-13;

/// Lowers the objective by at most `sweeps` steps and returns their number; ends when a step gains less than the share
/// `gain`, when no step downhill is found, or when `watch` returns false.
pub(super) fn descend(
    objective: &Objective,
    constraint: &dyn Constraint,
    x: &mut Vec<DVec3>,
    sweeps: usize,
    gain: f64,
    mut watch: impl FnMut(usize) -> bool,
) -> usize {
    let mut state = State::new(objective, constraint, x);
    let mut memory: VecDeque<Pair> = VecDeque::new();
    let mut done = 0;
    while done < sweeps {
        let direction = state.direction(&memory);
        let slope = dot(&direction, &state.gradient);
        let before = state.value;
        match (slope < 0.0).then(|| state.search(x, &direction, slope)).flatten() {
            Some(pair) => remember(&mut memory, pair),
            None if memory.is_empty() => break,
            None => {
                memory.clear();
                continue;
            }
        }
        done += 1;
        if !watch(done) || before - state.value < gain * before {
            break;
        }
    }
    done
}

struct Pair {
    step: Vec<DVec3>,
    change: Vec<DVec3>,
    /// `1 / (step . change)`.
    rho: f64,
}

fn remember(memory: &mut VecDeque<Pair>, pair: Pair) {
    if pair.rho.is_finite() && pair.rho > 0.0 {
        if memory.len() == MEMORY {
            memory.pop_front();
        }
        memory.push_back(pair);
    }
}

struct State<'a> {
    objective: &'a Objective<'a>,
    constraint: &'a dyn Constraint,
    value: f64,
    freedom: Vec<Freedom>,
    derivatives: Vec<NodeDerivative>,
    /// The gradient within each node's free directions.
    gradient: Vec<DVec3>,
    /// The inverse of each node's Hessian block, on its free directions.
    inverses: Vec<DMat3>,
    slots: Vec<NodeDerivative>,
}

impl<'a> State<'a> {
    fn new(objective: &'a Objective<'a>, constraint: &'a dyn Constraint, x: &[DVec3]) -> State<'a> {
        let mut state = State {
            objective,
            constraint,
            value: 0.0,
            freedom: Vec::new(),
            derivatives: Vec::new(),
            gradient: Vec::new(),
            inverses: Vec::new(),
            slots: Vec::new(),
        };
        state.look(x);
        state
    }

    /// Evaluates everything at `x`.
    fn look(&mut self, x: &[DVec3]) {
        self.value = self.objective.derivatives(x, &mut self.slots, &mut self.derivatives);
        let patch = self.objective.patch;
        self.freedom = (0..patch.nodes.len())
            .into_par_iter()
            .map(|i| if patch.movable[i] { self.constraint.freedom(patch.nodes[i], x[i]) } else { Freedom::Fixed })
            .collect();
        self.gather_images();
        let blocks = self.derivatives.par_iter().zip(&self.freedom).with_min_len(256);
        blocks.map(|(d, &f)| positive_inverse(d.hessian, f, FLAT)).collect_into_vec(&mut self.inverses);
        self.gradient = self.derivatives.iter().zip(&self.freedom).map(|(d, f)| f.keep(d.gradient)).collect();
    }

    /// An image `y = R x + t` moves with its original `x` alone, which takes its derivatives: `R^T g` and `R^T H R`.
    fn gather_images(&mut self) {
        for &(image, of, map) in &self.objective.patch.periodic {
            let NodeDerivative { gradient, hessian } =
                std::mem::replace(&mut self.derivatives[image], NodeDerivative::ZERO);
            let (turn, back) = (map.matrix3, map.matrix3.transpose());
            self.derivatives[of].gradient += back * gradient;
            self.derivatives[of].hessian += back * hessian * turn;
            self.freedom[image] = Freedom::Fixed;
        }
    }

    /// `-H g` by the two-loop recursion, with the blocks as the first estimate of `H`.
    fn direction(&self, memory: &VecDeque<Pair>) -> Vec<DVec3> {
        let mut q = self.gradient.clone();
        let mut weights = Vec::with_capacity(memory.len());
        for pair in memory.iter().rev() {
            let weight = pair.rho * dot(&pair.step, &q);
            add(&mut q, -weight, &pair.change);
            weights.push(weight);
        }
        let mut r = self.preconditioned(&q);
        if let Some(last) = memory.back() {
            let gamma = 1.0 / (last.rho * dot(&last.change, &self.preconditioned(&last.change)));
            r.par_iter_mut().for_each(|r| *r *= gamma);
        }
        for (pair, weight) in memory.iter().zip(weights.into_iter().rev()) {
            let own = pair.rho * dot(&pair.change, &r);
            add(&mut r, weight - own, &pair.step);
        }
        r.par_iter().zip(&self.freedom).map(|(&r, f)| -f.keep(r)).collect()
    }

    fn preconditioned(&self, vector: &[DVec3]) -> Vec<DVec3> {
        self.inverses.par_iter().zip(vector).with_min_len(4096).map(|(&inverse, &v)| inverse * v).collect()
    }

    /// Backtracks from the full step; on success `x` and the state are those of the new place.
    fn search(&mut self, x: &mut Vec<DVec3>, direction: &[DVec3], slope: f64) -> Option<Pair> {
        let mut share = 1.0;
        while share > SHORTEST {
            let tried = self.moved(x, direction, share);
            let value = self.objective.value(&tried);
            if value <= self.value + SUFFICIENT * share * slope {
                let old = std::mem::take(&mut self.gradient);
                self.look(&tried);
                let step: Vec<DVec3> = tried.iter().zip(x.iter()).map(|(new, old)| *new - *old).collect();
                let change: Vec<DVec3> = self.gradient.iter().zip(&old).map(|(new, old)| *new - *old).collect();
                *x = tried;
                let rho = 1.0 / dot(&step, &change);
                return Some(Pair { step, change, rho });
            }
            share *= 0.5;
        }
        None
    }

    fn moved(&self, x: &[DVec3], direction: &[DVec3], share: f64) -> Vec<DVec3> {
        let nodes = &self.objective.patch.nodes;
        let mut moved: Vec<DVec3> = (0..x.len())
            .into_par_iter()
            .with_min_len(256)
            .map(|i| match self.freedom[i] {
                Freedom::Fixed => x[i],
                Freedom::Space => x[i] + direction[i] * share,
                Freedom::Plane(_) | Freedom::Line(_) => {
                    self.constraint.restrict(nodes[i], x[i], x[i] + direction[i] * share)
                }
            })
            .collect();
        for &(image, of, map) in
            self.objective.patch.periodic.iter().filter(|(_, of, _)| self.objective.patch.movable[*of])
        {
            moved[image] = map.transform_point3(moved[of]);
        }
        moved
    }
}

/// Sum of `a . b`, in chunks of fixed size so that it does not depend on the number of threads.
fn dot(a: &[DVec3], b: &[DVec3]) -> f64 {
    const CHUNK: usize = 4096;
    let parts: Vec<f64> = a
        .par_chunks(CHUNK)
        .zip(b.par_chunks(CHUNK))
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum())
        .collect();
    parts.iter().sum()
}

fn add(a: &mut [DVec3], factor: f64, b: &[DVec3]) {
    a.par_iter_mut().with_min_len(4096).zip(b).for_each(|(a, b)| *a += *b * factor);
}
