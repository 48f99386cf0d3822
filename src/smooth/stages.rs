//! The stages of the paper (§2.3): shape alone while sub-elements are inverted, then shape and Jacobian.
//!
//! A stage goes on in rounds: choose the active elements, those below [`LOW`] first, descend, survey. What is reported is
//! what is surveyed: the costs are those of the closing survey, at `survey_factor` times `p` divisions an edge, confirmed by the
//! certificate (`confirm.rs`). The descent
//! looks at `p` divisions; an element on which that is blind (it sees a better Jacobian than there is) is given a denser
//! survey of its own. Elements outside the patch do not change and are not surveyed again.
//!
//! The smallest costs are not monotone along the way (an objective that sums can lower the sum and the worst at once), so
//! the best state of all rounds is kept: fewest inverted elements first, then the better score of the two smallest costs
//! ([`Summary`]).

use glam::DVec3;
use rayon::prelude::*;

use super::best::Best;
use super::confirm::confirmed_costs;
use super::density::Density;
use super::descend::descend;
use super::engine::Engine;
use super::gradient::climb;
use super::kernel::Weights;
use super::objective::Objective;
use super::pace::{PATIENCE, Pace, RINGS, Stage};
use super::patch::Patch;
use super::problem::Kernels;
use super::{Checkpoint, Constraint, ElementCost, Image, Known, Problem, Progress, Settings, Smoothed, Summary, Watch};
use crate::mesh::{ElementId, components};
use crate::quality;

/// A survey is too coarse for an element where it misses this much of its `C_JAC`.
const BLIND: f64 = 0.01;
/// A descent ends at a sweep that gains less than this fraction of the objective.
const GAIN: f64 = 1e-4;
/// Weight of the square of a sample's term: how much the worst samples count.
const EMPHASIS: f64 = 20.0;
/// Below this cost an element is nearly inverted: the elements below it are worked on first, alone with their
/// surroundings, and the barrier at `J = 0` is softened. A barrier that steep (`1/r^4` near `r = 0.004`) lets a few
/// elements dictate the step of all others: wing_blunt at scale 0.4, P4, ended at C_JAC 0.008 after 200 sweeps, where it
/// now ends at 0.59; the nozzle at scale 0.4, P4, did not come out of 17 inverted elements at all, and now ends at 0.81.
const LOW: f64 = 0.3;
/// Where the whole patch gains no more, the elements within this of the worst are worked on alone, with their surroundings:
/// wing_sharp at scale 0.4, P4, goes on from C_JAC 0.42 to 0.50 by it, weeble_hybrid P3 from 0.67 to 0.80.
const FOCUS: f64 = 0.1;
/// Rings of neighbours around them.
const FOCUS_RINGS: usize = 4;
/// How much farther than they are meant to the nodes on walls may slide, step by step, where focused stages leave `C_JAC` below
/// the threshold in elements on walls. On the dish (`fixtures/make_dish.py`) that takes C_JAC from 0.69 to 0.81 at P2 and from 0.60 to
/// 0.71 at P3.
const LOOSENINGS: [f64; 2] = [30.0, 100.0];
/// What a loosening must gain for its places to be kept: nodes that slide take the wall farther from the CAD.
const WORTH: f64 = 0.02;
/// Regularisation of an element's determinants, as a fraction of what the element is below [`LOW`] (after Garanzha et al.,
/// doi:10.1145/3450626.3459847). Capped at 1, cylinder_bl at scale 0.5, P4, did not come out of J = -1.2 J_c.
const REGULARISATION: f64 = 0.5;
/// Regularisation of the elements around an inverted one, at most: enough for its nodes to pass, too little for many to follow it. With
/// that of the worst for all, one element of the torus at scale 0.5, P3, at J = -12 J_c, took 237 others along.
const AROUND: f64 = 0.1;

/// What there is to begin with.
#[derive(Debug, Default)]
pub enum Begin<'k> {
    /// Nothing: all elements are surveyed.
    #[default]
    Anew,
    /// A checkpoint of the same work to go on from.
    From(Checkpoint<'k>),
    /// Costs of positions that differ little from those to begin at.
    Knowing(&'k Known),
}

/// Moves the nodes `x` of a perturbed mesh to better positions; `watch` is called after every sweep and ends the work by returning false.
pub fn smooth(
    problem: &Problem,
    constraint: &dyn Constraint,
    settings: &Settings,
    x: &mut Vec<DVec3>,
    begin: Begin,
    watch: &mut dyn Watch,
) -> Smoothed {
    let surveys: Vec<Kernels> =
        factors(settings.survey_factor).iter().map(|f| Kernels::new(problem, problem.order.get() * f)).collect();
    let threshold = problem.threshold(settings);
    let closing = &surveys[surveys.len() - 1];
    let costs = match begin {
        Begin::Knowing(known) if known.factor() <= settings.survey_factor => {
            known.costs(problem, (closing, settings.survey_factor), threshold, x)
        }
        _ => confirmed_costs(problem, closing, threshold, problem.elements(), x),
    };
    let resumed = if let Begin::From(checkpoint) = begin { Some(checkpoint) } else { None };
    let start = resumed.as_ref().map_or_else(|| Summary::of(&costs), |checkpoint| checkpoint.start);
    let mut run = Run {
        problem,
        constraint,
        settings,
        threshold,
        surveys,
        density: vec![0; costs.len()],
        start,
        best: Best::is_now(start),
        costs,
        pace: Pace::new(if start.c_wcn <= 0.0 { Stage::Shape } else { Stage::Full }, settings.engine),
        sweeps: 0,
        stopped: false,
        looseness: 1.0,
        watch,
    };
    if let Some(checkpoint) = resumed {
        run.resume(checkpoint, x);
    }
    run.stages(x);
    run.go_back(x);
    Smoothed { sweeps: run.sweeps, stopped: run.stopped, costs: run.costs, start, end: run.best.summary }
}

/// Survey densities in multiples of `p`: doubled from 1 to that of the closing survey.
fn factors(survey_factor: usize) -> Vec<usize> {
    let mut factors: Vec<usize> = (0..).map(|k| 1 << k).take_while(|&f| f < survey_factor).collect();
    factors.push(survey_factor);
    factors
}

/// The state that goes from round to round.
struct Run<'a, 'p> {
    problem: &'a Problem<'p>,
    constraint: &'a dyn Constraint,
    settings: &'a Settings,
    /// The costs that elements are to have.
    threshold: f64,
    /// By rising density; the last is the closing survey.
    surveys: Vec<Kernels>,
    /// Each element's survey in the descent: an index into `surveys`.
    density: Vec<u8>,
    /// By the closing survey.
    costs: Vec<ElementCost>,
    /// Before the first sweep.
    start: Summary,
    best: Best,
    pace: Pace,
    sweeps: usize,
    stopped: bool,
    /// How much farther than they are meant to the nodes on walls may slide.
    looseness: f64,
    watch: &'a mut dyn Watch,
}

impl Run<'_, '_> {
    /// What is left of the stages, by the engine that was asked for; each but the first begins at the best state so far.
    fn stages(&mut self, x: &mut Vec<DVec3>) {
        loop {
            match self.settings.engine {
                Engine::QuasiNewton => {
                    self.stage(x);
                    self.loosen(x);
                }
                Engine::Gradient => self.papers_stage(x),
            }
            if self.pace.stage == Stage::Full {
                break;
            }
            self.pace = self.pace.next(self.settings.engine);
            self.go_back(x);
        }
    }

    /// One stage as the paper has it: all elements below the threshold, until there are none; shape alone only as long as that
    /// gains something.
    fn papers_stage(&mut self, x: &mut [DVec3]) {
        let stage = self.pace.stage;
        while self.goes_on() && (stage == Stage::Full || self.pace.idle < 2) {
            let first = self.sweeps;
            let active = self.activate([self.threshold; 2], RINGS);
            self.round(&active, x);
            if self.sweeps == first {
                break; // every node is above the threshold
            }
            self.keep(x);
        }
    }

    /// One stage.
    fn stage(&mut self, x: &mut [DVec3]) {
        while self.goes_on() {
            let (low, focused) = (self.lowest() < LOW, self.pace.focused);
            let (levels, rings) = match (low, focused) {
                (true, _) => ([LOW; 2], self.pace.low_rings),
                (false, true) => (self.focus(), FOCUS_RINGS),
                (false, false) => ([self.threshold; 2], RINGS),
            };
            let active = self.activate(levels, rings);
            if active.is_empty() {
                break;
            }
            self.round(&active, x);
            if self.pace.idle >= if focused { PATIENCE } else { 2 } {
                self.pace.idle = 0;
                match (low, focused) {
                    (true, _) if self.pace.may_widen() => self.pace.widen(),
                    (false, false) if self.lowest() + FOCUS < self.threshold => {
                        self.pace.focused = true;
                        self.go_back(x);
                    }
                    _ => break,
                }
            }
            self.keep(x);
        }
    }

    /// Lets the nodes on walls around the worst elements slide farther, where that gains enough. No checkpoints are kept
    /// meanwhile: a run that goes on from the last one does this again.
    fn loosen(&mut self, x: &mut Vec<DVec3>) {
        for looseness in LOOSENINGS {
            self.go_back(x);
            if !self.goes_on() || self.pace.stage != Stage::Full || !self.walls_hold_back() {
                break;
            }
            let before = self.best.summary;
            let (places, costs) = (x.clone(), self.costs.clone());
            (self.looseness, self.pace.focused, self.pace.idle) = (looseness, true, 0);
            self.stage(x);
            if self.best.summary.score() < before.score() + WORTH {
                (*x, self.costs, self.best) = (places, costs, Best::is_now(before));
                break;
            }
        }
        self.looseness = 1.0;
    }

    /// Whether an element with one of the smallest `C_JAC`, below the threshold, has a node on a wall.
    fn walls_hold_back(&self) -> bool {
        let anchored = |e: ElementId| self.problem.nodes(e).iter().any(|&n| self.constraint.anchor(n).is_some());
        let level = self.focus()[1];
        self.problem.ids().any(|e| self.costs[e.index()].c_jac < level && anchored(e))
    }

    fn goes_on(&self) -> bool {
        !self.stopped && self.pace.left(self.settings.max_sweeps) > 0
    }

    /// Elements with a cost below its level (`C_WCN`, `C_JAC`), and rings of elements around them.
    fn activate(&self, levels: [f64; 2], rings: usize) -> Vec<ElementId> {
        let full = self.pace.stage == Stage::Full;
        let below = |c: &ElementCost| c.c_wcn < levels[0] || (full && c.c_jac < levels[1]);
        if !self.costs.iter().any(below) {
            return Vec::new();
        }
        let mut active: Vec<bool> = self.costs.iter().map(below).collect();
        for _ in 0..rings {
            let mut touched = vec![false; self.problem.node_count()];
            for e in self.problem.ids().filter(|e| active[e.index()]) {
                for node in self.problem.nodes(e) {
                    touched[node.index()] = true;
                }
            }
            Image::spread(self.constraint.images(), &mut touched);
            for (e, active) in self.problem.ids().zip(&mut active) {
                *active |= self.problem.nodes(e).iter().any(|n| touched[n.index()]);
            }
        }
        self.problem.ids().filter(|e| active[e.index()]).collect()
    }

    /// What descends together. Elements nearly inverted do so by connected component: one step length for all would let a spot that cannot
    /// be mended stop those that can. Otherwise all do: on the weeble at P4 that ends at `C_WCN` 0.91, by component at 0.90, and sooner.
    fn parts(&self, active: &[ElementId]) -> Vec<Vec<ElementId>> {
        if self.lowest() >= LOW {
            return vec![active.to_vec()];
        }
        let tied = self.constraint.images().iter().map(|image| [image.node, image.of]);
        components(self.problem.cells(), active, tied)
    }

    /// One round: for each component a survey dense enough and a descent; and what it gained. Its sweeps are those of the component that
    /// takes most.
    fn round(&mut self, active: &[ElementId], x: &mut [DVec3]) {
        let (before, first) = (self.standing(), self.sweeps);
        let images = self.constraint.images();
        let mut local = vec![u32::MAX; self.problem.node_count()];
        let (mut last, mut moved) = (first, 0);
        let progress = self.progress();
        for own in self.parts(active) {
            self.sweeps = first;
            self.densify(&own, x);
            let patch = Patch::new(self.problem, &own, &self.density, images, &mut local);
            self.best.note(&patch, x, &self.costs);
            self.descend(&patch, progress, x);
            self.survey(&patch.elements, x);
            last = last.max(self.sweeps);
            moved += patch.movable.iter().filter(|&&m| m).count();
            if self.stopped {
                break;
            }
        }
        self.sweeps = last;
        self.pace.spend(last - first, moved, self.problem.node_count());
        self.keep_best();
        self.pace.after(self.standing() - before, self.sweeps - first, self.settings.engine);
    }

    /// Offers the state between two rounds to be kept; after one that was cut short there is no going on.
    fn keep(&mut self, x: &[DVec3]) {
        if self.goes_on() && self.looseness == 1.0 {
            let (pace, sweeps) = (self.pace, self.sweeps);
            let best = self.best.places.iter().map(|(&node, &place)| (node, place)).collect();
            let (density, x) = ((&self.density[..]).into(), x.into());
            self.watch.checkpoint(&Checkpoint { pace, start: self.start, sweeps, density, x, best });
        }
    }

    fn resume(&mut self, checkpoint: Checkpoint, x: &mut Vec<DVec3>) {
        let closing = &self.surveys[self.surveys.len() - 1];
        let mut best = checkpoint.x.to_vec();
        for (&node, &place) in &checkpoint.best {
            best[node as usize] = place;
        }
        let own = |x: &[DVec3]| confirmed_costs(self.problem, closing, self.threshold, self.problem.elements(), x);
        let costs = own(&best);
        *x = checkpoint.x.into_owned();
        self.costs = own(x);
        self.best = Best::is_now(Summary::of(&costs));
        for node in (0..best.len()).filter(|&n| best[n] != x[n]) {
            self.best.places.insert(node as u32, best[node]);
        }
        for (e, cost) in self.problem.ids().zip(costs).filter(|(e, cost)| *cost != self.costs[e.index()]) {
            self.best.costs.insert(e, cost);
        }
        let densest = (self.surveys.len() - 1) as u8;
        self.density = checkpoint.density.iter().map(|&density| density.min(densest)).collect();
        (self.pace, self.sweeps) = (checkpoint.pace.limited(self.settings.engine), checkpoint.sweeps);
    }

    /// Back to the best state so far.
    fn go_back(&mut self, x: &mut [DVec3]) {
        self.best.restore(x, &mut self.costs);
    }

    fn lowest(&self) -> f64 {
        self.costs.iter().map(|c| self.pace.stage.cost(c)).fold(1.0, f64::min)
    }

    fn score(&self) -> f64 {
        let summary = Summary::of(&self.costs);
        if self.pace.stage == Stage::Shape { summary.c_wcn } else { summary.score() }
    }

    /// What a round is judged by: the best state where that is valid, so that a fall and its mending are no progress.
    fn standing(&self) -> f64 {
        if self.pace.stage == Stage::Full && self.best.summary.inverted == 0 {
            self.best.summary.score()
        } else {
            self.score()
        }
    }

    /// The levels, `C_WCN` and `C_JAC`, below which elements are within [`FOCUS`] of the worst of their component.
    fn focus(&self) -> [f64; 2] {
        let summary = Summary::of(&self.costs);
        [summary.c_wcn, summary.c_jac].map(|worst| (worst + FOCUS).min(self.threshold))
    }

    /// Takes the costs of changed elements.
    fn survey(&mut self, elements: &[ElementId], x: &[DVec3]) {
        let closing = &self.surveys[self.surveys.len() - 1];
        let (own, level) = (elements.par_iter().copied(), self.threshold);
        for (&e, cost) in elements.iter().zip(confirmed_costs(self.problem, closing, level, own, x)) {
            self.costs[e.index()] = cost;
        }
    }

    /// Keeps the state if it is the best.
    fn keep_best(&mut self) {
        let summary = Summary::of(&self.costs);
        if summary.beats(self.best.summary) {
            self.best = Best::is_now(summary);
        }
    }

    /// Gives a denser survey to elements on which their own is blind.
    fn densify(&mut self, active: &[ElementId], x: &[DVec3]) {
        let densest = (self.surveys.len() - 1) as u8;
        for own in 0..densest {
            let low = |e: usize| self.density[e] == own && self.costs[e].c_jac < self.threshold;
            let seen = |e: &ElementId| low(e.index());
            let elements: Vec<ElementId> = active.iter().copied().filter(seen).collect();
            let sights = self.problem.costs(&self.surveys[usize::from(own)], x, elements.par_iter().copied());
            for (&e, sight) in elements.iter().zip(&sights) {
                if sight.c_jac - self.costs[e.index()].c_jac > BLIND {
                    self.density[e.index()] = own + 1;
                }
            }
        }
    }

    /// Descends on a patch.
    fn descend(&mut self, patch: &Patch, progress: Progress, x: &mut [DVec3]) {
        let stage = self.pace.stage;
        let alpha = self.settings.alpha.unwrap_or_else(|| quality::alpha(self.problem.order));
        let delta = |cost: f64| REGULARISATION * (LOW - cost).max(0.0);
        let lowest = patch.elements.iter().map(|e| stage.cost(&self.costs[e.index()])).fold(1.0, f64::min);
        let around = delta(lowest).min(AROUND);
        let (shape, jacobian) = if stage == Stage::Shape { (1.0, 0.0) } else { (alpha, 1.0 - alpha) };
        let weights = Weights { shape, jacobian, density: Density { emphasis: EMPHASIS, delta: 0.0 } };
        let deltas = patch.elements.iter().map(|&e| delta(stage.cost(&self.costs[e.index()])).max(around)).collect();
        let cuts = patch.elements.iter().map(|&e| self.costs[e.index()].cut).collect();
        let kernels = patch.runs.iter().map(|run| self.surveys[usize::from(run.density)].of(run.cell)).collect();
        let anchored = |i: usize| {
            patch.movable[i]
                .then(|| self.constraint.anchor(patch.nodes[i]))
                .flatten()
                .map(|a| (i, a.loosened(self.looseness)))
        };
        let anchors = (0..patch.nodes.len()).filter_map(anchored).collect();
        let objective = Objective { patch, kernels, cuts, deltas, weights, anchors };
        let progress = self.progress_on(patch, progress);
        let left = self.pace.round.min(self.pace.left(self.settings.max_sweeps));
        let first = self.sweeps;
        let (watch, stopped) = (&mut *self.watch, &mut self.stopped);
        let mut local: Vec<DVec3> = patch.nodes.iter().map(|n| x[n.index()]).collect();
        let tell = |sweep| {
            *stopped = !watch.progress(Progress { sweep: first + sweep, ..progress });
            !*stopped
        };
        self.sweeps += match self.settings.engine {
            Engine::QuasiNewton => descend(&objective, self.constraint, &mut local, left, GAIN, tell),
            Engine::Gradient => climb(&objective, self.constraint, &mut local, left, self.threshold, tell),
        };
        for (node, place) in patch.nodes.iter().zip(local) {
            x[node.index()] = place;
        }
    }

    /// What is told of the whole mesh between two rounds.
    fn progress(&self) -> Progress {
        let stage = self.pace.stage;
        let summary = Summary::of(&self.costs);
        Progress {
            stage: if stage == Stage::Shape { 1 } else { 2 },
            sweep: self.sweeps,
            max_sweeps: self.sweeps.saturating_add(self.pace.left(self.settings.max_sweeps)),
            active_nodes: 0,
            worst: self.lowest(),
            costs: [summary.c_wcn, summary.c_jac],
            at: DVec3::ZERO,
            inverted: self.costs.iter().filter(|c| stage.cost(c) <= 0.0).count(),
        }
    }

    /// The same, of a patch.
    fn progress_on(&self, patch: &Patch, whole: Progress) -> Progress {
        let cost = |e: ElementId| self.pace.stage.cost(&self.costs[e.index()]);
        let worst = |&a: &ElementId, &b: &ElementId| cost(a).total_cmp(&cost(b));
        let element = patch.elements.iter().copied().min_by(worst).unwrap_or_default();
        let nodes = self.problem.nodes(element);
        let middle: DVec3 = nodes.iter().map(|n| self.problem.straight[n.index()]).sum();
        let active_nodes = patch.movable.iter().filter(|&&m| m).count();
        Progress { active_nodes, worst: cost(element), at: middle / nodes.len() as f64, ..whole }
    }
}
