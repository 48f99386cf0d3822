//! The stages of the paper (§2.3): shape alone while sub-elements are inverted, then shape and Jacobian, the survey
//! denser from stage to stage up to that of the closing survey. Within a stage the elements below [`LOW`] come first.
//!
//! A stage goes on in rounds: survey, choose the active elements, descend, survey again. Elements outside the patch do
//! not change and are not surveyed again. The smallest costs are not monotone along the way (an objective that sums
//! can lower the sum and the worst at once), so the best state of all stages is kept: fewest inverted elements first,
//! then the largest smallest cost, by the closing survey.

use glam::DVec3;

use super::density::Density;
use super::descend::descend;
use super::kernel::Weights;
use super::objective::Objective;
use super::patch::Patch;
use super::problem::Kernels;
use super::{Constraint, ElementCost, Problem};
use crate::quality;

/// Sweeps between two surveys.
const ROUND: usize = 10;
/// A descent ends at a sweep that gains less than this share of the objective.
const GAIN: f64 = 1e-4;
/// A stage ends when two rounds in a row raise the smallest cost by less.
const PROGRESS: f64 = 2e-3;
/// Rings of neighbours that are activated around the elements below the threshold.
const RINGS: usize = 2;
/// Most rings around elements below [`LOW`] that do not come out of it.
const MOST_RINGS: usize = 8;
/// Weight of the square of a sample's term: how much the worst samples count.
const EMPHASIS: f64 = 20.0;
/// Below this cost an element is as good as inverted: the elements below it are worked on first, alone with their
/// surroundings, and the barrier at `J = 0` is softened. A barrier that steep (`1/r^4` near `r = 0.004`) lets a few
/// elements dictate the step of all others: wing_blunt at scale 0.4, P4, ended at C_JAC 0.008 after 200 sweeps, where it
/// now ends at 0.59; the nozzle at scale 0.4, P4, did not come out of 17 inverted elements at all, and now ends at 0.81.
const LOW: f64 = 0.3;
/// Regularisation of determinants, as a share of what the worst is below [`LOW`] (after Garanzha et al.,
/// doi:10.1145/3450626.3459847).
const REGULARISATION: f64 = 0.5;

/// What the user can set.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Elements whose cost is below are worked on, with their neighbours. Default 0.8 (paper §2.3).
    pub threshold: f64,
    /// Weight of shape in equation (2), 0 to 1; `None` is `(p - 1) / p`.
    pub alpha: Option<f64>,
    /// Most sweeps over the active nodes, all stages together. Default 200.
    pub max_sweeps: usize,
    /// Density of the closing survey: this many times `p` divisions an edge. Default 4.
    pub survey_factor: usize,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { threshold: 0.8, alpha: None, max_sweeps: 200, survey_factor: 4 }
    }
}

/// Where the smoother stands after a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Stage, from 1.
    pub stage: usize,
    /// Sweeps so far, all stages.
    pub sweep: usize,
    /// Most sweeps there can be.
    pub max_sweeps: usize,
    /// Nodes that move.
    pub active_nodes: usize,
    /// Smallest cost at the last survey, either component.
    pub worst: f64,
    /// Middle of the element that has it.
    pub at: DVec3,
    /// Elements with a cost of 0 or less at the last survey.
    pub inverted: usize,
}

/// What smoothing did.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// Sweeps, all stages together.
    pub sweeps: usize,
    /// Whether `watch` ended it.
    pub stopped: bool,
    /// Costs of every volume element, by the closing survey.
    pub costs: Vec<ElementCost>,
    /// Smallest costs before the first sweep, by the closing survey.
    pub start: Summary,
    /// Smallest costs at the end.
    pub end: Summary,
}

/// The smallest costs of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Summary {
    /// Smallest `C_WCN`.
    pub c_wcn: f64,
    /// Smallest `C_JAC`.
    pub c_jac: f64,
    /// Elements with a cost of 0 or less.
    pub inverted: usize,
}

impl Smoothed {
    /// Takes the costs anew, after nodes were moved by others.
    pub fn survey(&mut self, problem: &Problem, x: &[DVec3], survey_factor: usize) {
        let all: Vec<usize> = (0..problem.element_count()).collect();
        self.costs = problem.costs(&Kernels::new(problem, problem.order.get() * survey_factor), x, &all);
        self.end = Summary::of(&self.costs);
    }
}

impl Summary {
    fn of(costs: &[ElementCost]) -> Summary {
        let worst = |f: fn(&ElementCost) -> f64| costs.iter().map(f).fold(1.0, f64::min);
        let inverted = costs.iter().filter(|c| c.worst() <= 0.0).count();
        Summary { c_wcn: worst(|c| c.c_wcn), c_jac: worst(|c| c.c_jac), inverted }
    }

    fn worst(self) -> f64 {
        self.c_wcn.min(self.c_jac)
    }

    fn beats(self, other: Summary) -> bool {
        self.inverted < other.inverted || (self.inverted == other.inverted && self.worst() > other.worst())
    }
}

/// Moves the nodes `x` of a perturbed mesh to better places; `watch` is told after every sweep and ends the work by
/// returning false.
pub fn smooth(
    problem: &Problem,
    constraint: &dyn Constraint,
    settings: &Settings,
    x: &mut Vec<DVec3>,
    mut watch: impl FnMut(Progress) -> bool,
) -> Smoothed {
    let p = problem.order.get();
    let closing = Kernels::new(problem, p * settings.survey_factor);
    let all: Vec<usize> = (0..problem.element_count()).collect();
    let mut costs = problem.costs(&closing, x, &all);
    let start = Summary::of(&costs);
    let mut best = Best { summary: start, costs: costs.clone(), x: x.clone() };
    let mut run = Run { problem, constraint, settings, sweeps: 0, stopped: false, watch: &mut watch };
    for (number, stage) in stages(settings.survey_factor).into_iter().enumerate() {
        if run.stopped || run.sweeps >= settings.max_sweeps || best.summary.worst() >= settings.threshold {
            break;
        }
        if stage.shape_only && best.summary.c_wcn > 0.0 {
            continue;
        }
        let touched = run.stage(number + 1, stage, x);
        for (&e, cost) in touched.iter().zip(problem.costs(&closing, x, &touched)) {
            costs[e] = cost;
        }
        let summary = Summary::of(&costs);
        if summary.beats(best.summary) {
            best = Best { summary, costs: costs.clone(), x: x.clone() };
        } else if best.summary.inverted == 0 {
            x.clone_from(&best.x);
            costs.clone_from(&best.costs);
        }
    }
    *x = best.x;
    Smoothed { sweeps: run.sweeps, stopped: run.stopped, costs: best.costs, start, end: best.summary }
}

/// The best state so far.
struct Best {
    summary: Summary,
    costs: Vec<ElementCost>,
    x: Vec<DVec3>,
}

/// Which samples a stage looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stage {
    shape_only: bool,
    /// Survey density in multiples of p.
    factor: usize,
}

/// Shape alone, then the density p, doubled until it is that of the closing survey.
fn stages(survey_factor: usize) -> Vec<Stage> {
    let mut stages = vec![Stage { shape_only: true, factor: 1 }];
    let mut factor = 1;
    while factor < survey_factor {
        stages.push(Stage { shape_only: false, factor });
        factor *= 2;
    }
    stages.push(Stage { shape_only: false, factor: survey_factor });
    stages
}

/// The state that goes from stage to stage.
struct Run<'a, 'p> {
    problem: &'a Problem<'p>,
    constraint: &'a dyn Constraint,
    settings: &'a Settings,
    sweeps: usize,
    stopped: bool,
    watch: &'a mut dyn FnMut(Progress) -> bool,
}

impl Run<'_, '_> {
    /// One stage; returns the elements that it may have changed.
    fn stage(&mut self, number: usize, stage: Stage, x: &mut [DVec3]) -> Vec<usize> {
        let problem = self.problem;
        let kernels = Kernels::new(problem, problem.order.get() * stage.factor);
        let all: Vec<usize> = (0..problem.element_count()).collect();
        let mut costs = problem.costs(&kernels, x, &all);
        let mut touched = vec![false; all.len()];
        let (mut idle, mut low_rings) = (0, RINGS);
        while !self.stopped && self.sweeps < self.settings.max_sweeps {
            let before = self.lowest(stage, &costs);
            let low = before < LOW;
            let (level, rings) = if low { (LOW, low_rings) } else { (self.settings.threshold, RINGS) };
            let active = activate(problem, &costs, stage, level, rings);
            if active.is_empty() {
                break;
            }
            let patch = Patch::new(problem, &active);
            self.round(number, stage, &kernels, &costs, &patch, x);
            for (&e, cost) in patch.elements.iter().zip(problem.costs(&kernels, x, &patch.elements)) {
                costs[e] = cost;
                touched[e] = true;
            }
            let gained = self.lowest(stage, &costs) - before;
            idle = if gained < PROGRESS { idle + 1 } else { 0 };
            if idle == 2 {
                if !low || low_rings >= MOST_RINGS {
                    break;
                }
                (low_rings, idle) = (2 * low_rings, 0);
            }
        }
        (0..touched.len()).filter(|&e| touched[e]).collect()
    }

    fn lowest(&self, stage: Stage, costs: &[ElementCost]) -> f64 {
        costs.iter().map(|c| stage.cost(c)).fold(1.0, f64::min)
    }

    /// Descends on a patch.
    fn round(
        &mut self,
        number: usize,
        stage: Stage,
        kernels: &Kernels,
        costs: &[ElementCost],
        patch: &Patch,
        x: &mut [DVec3],
    ) {
        let alpha = self.settings.alpha.unwrap_or_else(|| quality::alpha(self.problem.order));
        let lowest = self.lowest(stage, costs);
        let delta = REGULARISATION * (LOW - lowest).max(0.0);
        let (shape, jacobian) = if stage.shape_only { (1.0, 0.0) } else { (alpha, 1.0 - alpha) };
        let weights = Weights { shape, jacobian, density: Density { emphasis: EMPHASIS, delta } };
        let cuts = patch.elements.iter().map(|&e| costs[e].cut).collect();
        let own = patch.runs.iter().map(|run| kernels.of(run.cell)).collect();
        let anchored =
            |i: usize| patch.movable[i].then(|| self.constraint.anchor(patch.nodes[i])).flatten().map(|a| (i, a));
        let anchors = (0..patch.nodes.len()).filter_map(anchored).collect();
        let objective = Objective { patch, kernels: own, cuts, weights, anchors };
        let progress = self.progress(number, stage, costs, patch);
        let left = ROUND.min(self.settings.max_sweeps - self.sweeps);
        let first = self.sweeps;
        let (watch, stopped) = (&mut *self.watch, &mut self.stopped);
        let mut local: Vec<DVec3> = patch.nodes.iter().map(|n| x[n.index()]).collect();
        self.sweeps += descend(&objective, self.constraint, &mut local, left, GAIN, |sweep| {
            *stopped = !watch(Progress { sweep: first + sweep, ..progress });
            !*stopped
        });
        for (node, place) in patch.nodes.iter().zip(local) {
            x[node.index()] = place;
        }
    }

    fn progress(&self, stage: usize, kind: Stage, costs: &[ElementCost], patch: &Patch) -> Progress {
        let worst = |&a: &usize, &b: &usize| kind.cost(&costs[a]).total_cmp(&kind.cost(&costs[b]));
        let element = patch.elements.iter().copied().min_by(worst).unwrap_or(0);
        let nodes = self.problem.nodes(element);
        let middle: DVec3 = nodes.iter().map(|n| self.problem.straight[n.index()]).sum();
        Progress {
            stage,
            sweep: self.sweeps,
            max_sweeps: self.settings.max_sweeps,
            active_nodes: patch.movable.iter().filter(|&&m| m).count(),
            worst: kind.cost(&costs[element]),
            at: middle / nodes.len() as f64,
            inverted: costs.iter().filter(|c| kind.cost(c) <= 0.0).count(),
        }
    }
}

impl Stage {
    /// The cost that the stage works on.
    fn cost(self, cost: &ElementCost) -> f64 {
        if self.shape_only { cost.c_wcn } else { cost.worst() }
    }
}

/// Elements below the level, and rings of elements around them.
fn activate(problem: &Problem, costs: &[ElementCost], stage: Stage, level: f64, rings: usize) -> Vec<usize> {
    let mut active: Vec<bool> = costs.iter().map(|c| stage.cost(c) < level).collect();
    for _ in 0..rings {
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
