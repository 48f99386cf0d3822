//! The stages of the paper (§2.3): shape alone, then shape and Jacobian, then denser surveys.

use glam::DVec3;

use super::density::Density;
use super::descend::descend;
use super::kernel::Weights;
use super::objective::Objective;
use super::patch::Patch;
use super::problem::Kernels;
use super::{Constraint, ElementCost, Problem};
use crate::quality;

/// What the user can set.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Elements whose cost is below are worked on, with their neighbours. Default 0.8 (paper §2.3).
    pub threshold: f64,
    /// Weight of shape in equation (2), 0 to 1; `None` is `(p - 1) / p`.
    pub alpha: Option<f64>,
    /// Most sweeps over the active nodes, all stages together.
    pub max_sweeps: usize,
    /// Density of the closing survey: this many times `p` divisions an edge. Default 4.
    pub survey_factor: usize,
    /// How much the worst samples count.
    pub emphasis: f64,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { threshold: 0.8, alpha: None, max_sweeps: 200, survey_factor: 4, emphasis: 20.0 }
    }
}

/// Where the smoother stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    pub stage: usize,
    pub sweep: usize,
    pub active: usize,
    pub value: f64,
    pub c_wcn: f64,
    pub c_jac: f64,
    pub inverted: usize,
}

/// What smoothing did.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    pub sweeps: usize,
    pub costs: Vec<ElementCost>,
}

/// Moves the nodes `x` of a perturbed mesh to better places.
pub fn smooth(
    problem: &Problem,
    constraint: &dyn Constraint,
    settings: &Settings,
    x: &mut Vec<DVec3>,
    mut watch: impl FnMut(Progress) -> bool,
) -> Smoothed {
    let p = problem.order.get();
    let alpha = settings.alpha.unwrap_or_else(|| quality::alpha(problem.order));
    let all: Vec<usize> = (0..problem.element_count()).collect();
    let density = std::env::var("SURVEY").ok().and_then(|s| s.parse().ok()).unwrap_or(2);
    let rounds = std::env::var("ROUNDS").ok().and_then(|s| s.parse().ok()).unwrap_or(4);
    let per = std::env::var("PER").ok().and_then(|s| s.parse().ok()).unwrap_or(20);
    let kernels = Kernels::new(problem, p * density);
    let mut sweeps = 0;
    for round in 0..rounds {
        let costs = problem.costs(&kernels, x, &all);
        let worst = |f: fn(&ElementCost) -> f64| costs.iter().map(f).fold(1.0, f64::min);
        let (c_wcn, c_jac) = (worst(|c| c.c_wcn), worst(|c| c.c_jac));
        let inverted = costs.iter().filter(|c| c.worst() <= 0.0).count();
        let active = activate(problem, &costs, settings.threshold);
        watch(Progress { stage: round, sweep: sweeps, active: active.len(), value: 0.0, c_wcn, c_jac, inverted });
        let shape_only = round == 0 && std::env::var("SHAPEFIRST").is_ok();
        let low = if shape_only { c_wcn } else { c_wcn.min(c_jac) };
        let delta = if low > 0.0 { 0.0 } else { (1e-6 + 0.04 * low * low).sqrt() };
        let patch = Patch::new(problem, &active);
        let weights = Weights {
            shape: alpha,
            jacobian: if shape_only { 0.0 } else { 1.0 - alpha },
            density: Density { emphasis: settings.emphasis, delta },
        };
        let cuts = patch.elements.iter().map(|&e| costs[e].cut).collect();
        let own = patch.runs.iter().map(|run| kernels.of(run.cell)).collect();
        let objective = Objective { patch: &patch, kernels: own, cuts, weights };
        let mut local: Vec<DVec3> = patch.nodes.iter().map(|n| x[n.index()]).collect();
        let done = descend(&objective, constraint, &mut local, per, 1e-5, |sweep, value| {
            if std::env::var("VERBOSE").is_ok() {
                eprintln!("   {sweep} {value:.6e}");
            }
            true
        });
        sweeps += done.sweeps;
        eprintln!("round {round}: delta {delta:.2e} {done:?}");
        for (node, place) in patch.nodes.iter().zip(local) {
            x[node.index()] = place;
        }
    }
    let costs = problem.costs(&Kernels::new(problem, p * settings.survey_factor), x, &all);
    Smoothed { sweeps, costs }
}

/// Elements below the threshold, and those that share a node with them, twice.
fn activate(problem: &Problem, costs: &[ElementCost], threshold: f64) -> Vec<usize> {
    let mut active: Vec<bool> = costs.iter().map(|c| c.worst() < threshold).collect();
    for _ in 0..2 {
        let mut touched = vec![false; problem.node_count()];
        for e in (0..active.len()).filter(|&e| active[e]) {
            for node in problem.nodes(e) {
                touched[node.index()] = true;
            }
        }
        for (e, active) in active.iter_mut().enumerate() {
            *active |= problem.nodes(e).iter().any(|n| touched[n.index()]);
        }
    }
    (0..active.len()).filter(|&e| active[e]).collect()
}
