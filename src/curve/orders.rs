//! Curving order by order: P2 first, and each order begins where the one below ended.
//!
//! The polynomial of the order below is the same polynomial in the order above, so what is left of the walls' displacement is what
//! the lower order could not follow: a small part, that [`perturb`] carries into the volume as it carries the whole of it at P2.
//! Sweeps at low order are cheap (a tet of P2 has 10 nodes, one of P4 has 35), and few are left for the high one. Measured on 2
//! cores, min C_WCN / C_JAC and seconds of the whole run:
//!
//! | case | `--direct` | order by order |
//! |---|---|---|
//! | weeble P3 | 0.919 / 0.800, 2.8 | 0.930 / 0.785, 2.5 |
//! | weeble P4 | 0.910 / 0.804, 7.9 | 0.909 / 0.804, 5.6 |
//! | weeble_hybrid P4 | 0.893 / 0.660, 48 | 0.892 / 0.800, 7.0 |
//! | wing_sharp 0.4 P3 | 0.825 / 0.651, 3.0 | 0.859 / 0.722, 2.2 |
//! | wing_sharp 0.4 P4 | 0.771 / 0.539, 8.7 | 0.813 / 0.720, 7.6 |
//! | wing_blunt 0.4 P4 | 0.880 / 0.573, 15.6 | 0.914 / 0.719, 10.1 |
//! | nozzle 0.4 P4 | 0.959 / 0.812, 15.0 | 0.954 / 0.805, 6.1 |
//!
//! An order that comes out inverted goes through the ladder ([`crate::curve::recover`]); the next one begins there if it ends on the CAD, proven,
//! and else at the last order that did. With 30 sweeps an order the torus at scale 0.5 comes out inverted at P3; P4 then ended with 56
//! faces off the CAD when it began at P2, and on it with C_JAC 0.25 when it begins at what the ladder made of P3.
//!
//! The paper's engine begins at the order itself, as the paper has it, and so does `--direct`.

use glam::DVec3;
use rayon::prelude::*;

use crate::associate::{Association, Classification};
use crate::curve::checkpoint::{CheckpointError, Found};
use crate::curve::layers::leave_straight_beyond;
use crate::curve::periodic::PeriodicConstraint;
use crate::curve::perturb::perturb;
use crate::curve::recover::Ladder;
use crate::curve::wall::fit::fit;
use crate::curve::wall::{CadConstraint, Projected, project};
use crate::curve::{Clock, Job, Observer, PipelineError, Step, Told};
use crate::element::{Cell, Order, basis};
use crate::mesh::elevate::{Elevated, elevate};
use crate::mesh::{Boundary, Mesh, NodeId};
use crate::smooth::{Engine, Problem, Progress, Smoothed, Summary, smooth};

/// Weights of nodes that are as good as zero: a node on a face takes nothing from those off it.
const NOTHING: f64 = 1e-13;
/// Elements that are raised at a time: what they take while they wait does not grow with the mesh.
const BATCH: usize = 1 << 12;

/// What smoothing did at an order below the one asked for.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LowerOrder {
    /// The order.
    pub order: Order,
    /// Sweeps over the active nodes.
    pub sweeps: usize,
    /// Whether it was ended before it was done; the orders between are left out then.
    pub stopped: bool,
    /// Smallest costs before the first sweep.
    pub start: Summary,
    /// Smallest costs at the end.
    pub end: Summary,
}

/// The straight mesh at one order, and where its boundary goes.
pub(crate) struct Ready {
    pub(crate) elevated: Elevated,
    pub(crate) periodic: PeriodicConstraint,
    pub(crate) projected: Projected,
    /// What there is to tell of the periodic pairs.
    pub(crate) notes: Vec<String>,
}

/// The mesh at one order, smoothed.
pub(crate) struct Level {
    pub(crate) ready: Ready,
    /// Where smoothing put the nodes.
    pub(crate) places: Vec<DVec3>,
    pub(crate) smoothed: Smoothed,
}

/// What the way up led to.
pub(crate) struct Climb<'a> {
    /// The mesh at the order asked for.
    pub(crate) level: Level,
    /// The mesh to fall back to.
    pub(crate) below: Fall<'a>,
    /// What was done at the orders below.
    pub(crate) lower_orders: Vec<LowerOrder>,
}

/// The curved mesh of a lower order: what it takes to go on from it.
pub(crate) struct Below {
    /// Its order.
    pub(crate) order: Order,
    /// Cell kind and nodes of each block's elements.
    blocks: Vec<(Cell, Vec<NodeId>)>,
    /// What moved each node from its straight place.
    moved: Vec<DVec3>,
}

impl From<Level> for Below {
    fn from(level: Level) -> Below {
        let Level { ready: Ready { elevated: Elevated { mesh, .. }, .. }, mut places, .. } = level;
        places.par_iter_mut().zip(&mesh.points).for_each(|(place, straight)| *place -= *straight);
        let blocks = mesh.blocks.into_iter().map(|block| (block.cell, block.nodes)).collect();
        Below { order: mesh.order, blocks, moved: places }
    }
}

/// The mesh at the highest order below that is valid on the CAD.
pub(crate) enum Fall<'a> {
    /// As it came out.
    Known(Option<Below>),
    /// Not made again by a run that went on from a checkpoint: the way to it.
    Skipped(Box<Ascent<'a>>),
}

impl Fall<'_> {
    /// That mesh; where it was skipped, it is made now, unless `watch` ends that.
    pub(crate) fn below(&mut self, watch: &mut dyn FnMut(Progress) -> bool) -> Option<&Below> {
        if let Fall::Skipped(ascent) = self {
            let order = ascent.job.order;
            *self = Fall::Known(ascent.remade(order, &mut Silent(watch)).ok().flatten());
        }
        match self {
            Fall::Known(below) => below.as_ref(),
            Fall::Skipped(_) => None,
        }
    }
}

/// Tells only of sweeps: the steps of an order that is made a second time are not told again.
struct Silent<'w>(&'w mut dyn FnMut(Progress) -> bool);

impl Observer for Silent<'_> {
    fn step(&mut self, _: Step) {}

    fn progress(&mut self, progress: &Progress) -> bool {
        (self.0)(*progress)
    }
}

/// The way up to the order asked for.
pub(crate) struct Ascent<'a> {
    job: &'a Job,
    linear: Mesh,
    boundary: &'a Boundary,
    association: &'a Association,
    /// The checkpoint to go on from, until its order is reached.
    found: Option<Found>,
}

impl<'a> Ascent<'a> {
    /// Reads the head of the checkpoint, where the job goes on from one.
    pub(crate) fn new(
        job: &'a Job,
        linear: Mesh,
        boundary: &'a Boundary,
        association: &'a Association,
    ) -> Result<Ascent<'a>, CheckpointError> {
        let found = job.resume.as_deref().map(Found::open).transpose()?;
        Ok(Ascent { job, linear, boundary, association, found })
    }

    /// Goes up to the order asked for.
    pub(crate) fn climb(mut self, clock: &mut Clock) -> Result<Climb<'a>, PipelineError> {
        let (below, lower_orders) = self.lower(self.job.order, clock)?;
        let ready = self.ready(self.job.order, clock)?;
        let skipped = self.found.is_some() && below.is_none();
        if !skipped {
            self.linear = Mesh::default(); // it was needed for the last time
        }
        let mut level = self.level(ready, below.as_ref(), clock)?;
        level.smoothed.stopped |= lower_orders.iter().any(|lower| lower.stopped);
        let below = if skipped { Fall::Skipped(Box::new(self)) } else { Fall::Known(below) };
        Ok(Climb { level, below, lower_orders })
    }

    /// Goes through the orders below `end`; those that were done when the checkpoint was kept are left out.
    fn lower(&mut self, end: Order, clock: &mut Clock) -> Result<(Option<Below>, Vec<LowerOrder>), PipelineError> {
        let mut below: Option<Below> = None;
        let mut skipped = false;
        let mut lower_orders = Vec::new();
        let direct = self.job.direct || self.job.smoothing.engine == Engine::Gradient;
        let between = |order: &Order| *order > Order::LINEAR && *order < end && !direct;
        for order in Order::all().filter(between).collect::<Vec<_>>() {
            let ready = self.ready(order, clock)?;
            if self.found.as_ref().is_some_and(|found| found.nodes() > ready.elevated.mesh.points.len()) {
                skipped = true;
                continue;
            }
            let mut level = self.level(ready, below.as_ref(), clock)?;
            let mut valid = level.smoothed.end.inverted == 0;
            if !valid && !level.smoothed.stopped {
                if std::mem::take(&mut skipped) {
                    below = self.remade(order, &mut Silent(&mut |progress| clock.observer.progress(&progress)))?;
                }
                let mut fall = Fall::Known(below.take());
                valid = self.mend(&mut level, &mut fall, clock);
                if let Fall::Known(back) = fall {
                    below = back;
                }
            }
            let Smoothed { sweeps, stopped, start, end, .. } = level.smoothed;
            lower_orders.push(LowerOrder { order, sweeps, stopped, start, end });
            if valid {
                below = Some(level.into());
            }
            if stopped {
                break;
            }
        }
        Ok((below, lower_orders))
    }

    /// The highest order below `end` at which no element is inverted, made once more; `None` also where `silent` ends that.
    fn remade(&mut self, end: Order, silent: &mut Silent) -> Result<Option<Below>, PipelineError> {
        let (below, lower_orders) = self.lower(end, &mut Clock::new(silent))?;
        Ok(below.filter(|_| lower_orders.iter().all(|lower| !lower.stopped)))
    }

    /// Takes a level that is inverted through the ladder; whether it came out on the CAD, and proven.
    fn mend(&self, level: &mut Level, below: &mut Fall, clock: &mut Clock) -> bool {
        let (places, ready) = (std::mem::take(&mut level.places), &mut level.ready);
        let ladder = Ladder::new(self.job, self.boundary, self.association, ready, below);
        let climbed = ladder.climb(places, &mut level.smoothed, |progress| clock.observer.progress(&progress));
        level.places = std::mem::replace(&mut ready.elevated.mesh.points, climbed.straight);
        climbed.proof.holds() && climbed.given_up.is_empty()
    }

    /// Elevates and projects.
    fn ready(&self, order: Order, clock: &mut Clock) -> Result<Ready, PipelineError> {
        let job = self.job;
        clock.observer.order(order);
        clock.step(Step::Elevate);
        let too_many = |cause| PipelineError::TooMany { mesh: job.mesh.clone(), cause };
        let mut elevated = elevate(&self.linear, order).map_err(too_many)?;
        let (periodic, notes) = PeriodicConstraint::new(&mut elevated, self.boundary, job.freeze_linear);

        clock.step(Step::Project);
        let mut projected = project(&elevated, self.boundary, self.association, job.freeze_linear);
        periodic.carry(&elevated.mesh.points, &mut projected.displacement);
        fit(&elevated, self.boundary, self.association, &periodic, &mut projected);
        if let Some(layers) = job.curve_layers {
            leave_straight_beyond(layers, &elevated, self.boundary, self.association, &periodic, &mut projected);
        }
        Ok(Ready { elevated, periodic, projected, notes })
    }

    /// Carries the volume along and smooths, or goes on from the checkpoint.
    fn level(&mut self, ready: Ready, below: Option<&Below>, clock: &mut Clock) -> Result<Level, PipelineError> {
        let straight = &ready.elevated.mesh.points;
        let (mesh, job) = (&ready.elevated.mesh, self.job);
        let work = || job.work(mesh.element_count(3), straight, &ready.projected.displacement);
        let (problem, work) = rayon::join(|| Problem::new(mesh, straight), work);
        let resumed = self.found.take().map(|found| found.read(&work)).transpose()?;
        clock.step(Step::Perturb);
        let mut places = if resumed.is_some() { straight.clone() } else { self.start(&ready, below) };
        clock.step(Step::Smooth);
        let constraint = CadConstraint::new(
            self.association,
            straight,
            &ready.projected,
            &ready.periodic,
            ready.elevated.linear_nodes,
            self.job.freeze_walls,
            self.job.freeze_linear,
        );
        let mut told = Told { observer: clock.observer, work };
        let smoothed = smooth(&problem, &constraint, &self.job.smoothing, &mut places, resumed, &mut told);
        drop(problem);
        Ok(Level { ready, places, smoothed })
    }

    /// Where the nodes are before the first sweep.
    fn start(&self, ready: &Ready, below: Option<&Below>) -> Vec<DVec3> {
        let Ready { elevated, periodic, projected, .. } = ready;
        let carried = |projected: &Projected| perturb(elevated, self.boundary, self.association, projected, periodic);
        let Some(below) = below else {
            let mut places = carried(projected);
            periodic.apply(&mut places);
            return places;
        };
        let raised = below.raised(&elevated.mesh);
        let mut rest = projected.clone();
        rest.displacement.par_iter_mut().zip(&raised).enumerate().for_each(|(n, (displacement, raised))| {
            let in_plane = self.association.plane_of(projected.classification(n)).is_some();
            *displacement = if in_plane { DVec3::ZERO } else { *displacement - *raised };
        });
        let mut places = carried(&rest);
        places.par_iter_mut().zip(&raised).enumerate().for_each(|(n, (place, raised))| {
            let classification = projected.classification(n);
            let held = self.job.freeze_linear && n < elevated.linear_nodes;
            let plane = self.association.plane_of(classification).filter(|_| !held);
            *place = match (classification, plane) {
                (Classification::Free, _) => *place + *raised,
                (_, Some(plane)) => plane.closest(*place + *raised),
                (_, None) => elevated.mesh.points[n] + projected.displacement[n],
            };
        });
        periodic.apply(&mut places);
        places
    }
}

impl Below {
    /// What moved each node of the straight mesh `above`, of a higher order and with the same elements.
    pub(crate) fn raised(&self, above: &Mesh) -> Vec<DVec3> {
        let mut raised = vec![DVec3::ZERO; above.points.len()];
        let mut own = Vec::new();
        for (high, (cell, low)) in above.blocks.iter().zip(&self.blocks) {
            let mut weights = basis::at_lattice(*cell, self.order, above.order);
            weights.iter_mut().flatten().filter(|w| w.abs() < NOTHING).for_each(|w| *w = 0.0);
            let strides = [high.stride(above.order), cell.node_count(self.order)];
            let of_element = |(own, low): (&mut [DVec3], &[NodeId])| {
                let still = low.iter().all(|n| self.moved[n.index()] == DVec3::ZERO);
                for (own, weights) in own.iter_mut().zip(&weights).filter(|_| !still) {
                    *own = low.iter().zip(weights).map(|(n, &w)| self.moved[n.index()] * w).sum();
                }
                !still
            };
            for (high, low) in high.nodes.chunks(BATCH * strides[0]).zip(low.chunks(BATCH * strides[1])) {
                own.resize(high.len(), DVec3::ZERO);
                let elements = own.par_chunks_exact_mut(strides[0]).zip(low.par_chunks_exact(strides[1]));
                let moved: Vec<bool> = elements.with_min_len(64).map(of_element).collect();
                let elements = high.chunks_exact(strides[0]).zip(own.chunks_exact(strides[0]));
                for ((nodes, own), _) in elements.zip(moved).filter(|(_, moved)| *moved) {
                    nodes.iter().zip(own).for_each(|(node, own)| raised[node.index()] = *own);
                }
            }
        }
        raised
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::bernstein;
    use crate::mesh::{Block, EntityKey};

    /// One element of a kind, at its unit corners.
    fn alone(cell: Cell) -> Mesh {
        let points: Vec<DVec3> = cell.corners().iter().map(|c| DVec3::from(c.map(f64::from))).collect();
        let nodes = (0..points.len()).map(|n| NodeId::new(n).unwrap()).collect();
        let entity = EntityKey::new(cell.dimension() as u8, 1);
        let block = Block { cell, entity, physical_tags: vec![], tags: vec![1], nodes };
        let (node_tags, node_entities) = ((1..=points.len() as u64).collect(), vec![None; points.len()]);
        Mesh { points, node_tags, node_entities, blocks: vec![block], ..Mesh::default() }
    }

    /// A curved mesh from its straight one.
    fn lower(straight: &Mesh, places: &[DVec3]) -> Below {
        let blocks = straight.blocks.iter().map(|block| (block.cell, block.nodes.clone())).collect();
        let moved = places.iter().zip(&straight.points).map(|(place, straight)| *place - *straight).collect();
        Below { order: straight.order, blocks, moved }
    }

    #[test]
    fn a_raised_element_is_the_same_polynomial() {
        for cell in Cell::VOLUME {
            for high in Order::all().filter(|o| o.get() > 2) {
                for low in Order::all().filter(|o| o.get() > 1 && *o < high) {
                    let [below, above] = [low, high].map(|order| elevate(&alone(cell), order).unwrap().mesh);
                    // Bent at every node, differently.
                    let bend = |(n, x): (usize, &DVec3)| *x + DVec3::new(0.1, -0.07, 0.05) * (1.0 + n as f64).sin();
                    let places: Vec<DVec3> = below.points.iter().enumerate().map(bend).collect();
                    let moved = lower(&below, &places).raised(&above);
                    let raised: Vec<DVec3> = above.points.iter().zip(&moved).map(|(x, d)| *x + *d).collect();
                    let place = |mesh: &Mesh, places: &[DVec3], at: [f64; 3]| -> DVec3 {
                        let values = basis::values(cell, mesh.order, at);
                        mesh.blocks[0].nodes.iter().zip(values).map(|(n, v)| places[n.index()] * v).sum()
                    };
                    for unit in [[0.2, 0.3, 0.1], [0.31, 0.05, 0.4], [0.05, 0.62, 0.17]] {
                        let at = bernstein::chart(cell, unit);
                        let gap = place(&below, &places, at).distance(place(&above, &raised, at));
                        assert!(gap < 1e-12, "{cell} {low} to {high} at {unit:?}: {gap:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn what_does_not_move_stays_to_the_bit() {
        let order = |p: usize| Order::new(p).unwrap();
        let [below, above] = [2, 3].map(|p| elevate(&alone(Cell::Tet), order(p)).unwrap().mesh);
        let mut places = below.points.clone();
        places[9] += DVec3::splat(0.1); // the middle of the edge 2-3
        let moved = lower(&below, &places).raised(&above);
        let on_face = |x: &DVec3| x.y == 0.0 || x.z == 0.0; // faces without that edge
        let still = above.points.iter().zip(&moved).filter(|(x, _)| on_face(x));
        assert!(still.clone().count() > 10);
        assert!(still.clone().all(|(_, d)| *d == DVec3::ZERO));
        assert!(moved.iter().any(|d| *d != DVec3::ZERO));
    }
}
