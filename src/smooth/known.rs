//! Costs that are known already: those of elements that stand where they stood when they were surveyed.

use glam::DVec3;
use rayon::prelude::*;

use super::confirm::confirmed_costs;
use super::problem::Kernels;
use super::{ElementCost, Problem, Settings};
use crate::mesh::ElementId;

/// By how much an element must be above the threshold to be taken over from a survey less dense: [`densify`](super::stages) calls a survey
/// blind that misses a tenth of that.
const SURE: f64 = 0.1;

/// Costs of all elements at some positions, by a survey of some density: a recovery smooths the same mesh tens of times and changes little
/// of it each time.
#[derive(Clone, Debug)]
pub struct Known {
    factor: usize,
    /// Costs below were confirmed by the certificate.
    confirmed: f64,
    places: Vec<DVec3>,
    costs: Vec<ElementCost>,
}

impl Known {
    /// What smoothing with these settings came to: the costs with the nodes at `places`.
    #[must_use]
    pub fn of(problem: &Problem, settings: &Settings, places: Vec<DVec3>, costs: Vec<ElementCost>) -> Known {
        Known { factor: settings.survey_factor, confirmed: problem.threshold(settings), places, costs }
    }

    /// Density of the survey, in multiples of the order.
    #[must_use]
    pub fn factor(&self) -> usize {
        self.factor
    }

    /// Costs at the positions `x` by the closing `survey` of settings with `factor`, confirmed below `level`. Those from a survey less dense
    /// are taken over where they are well above.
    pub(super) fn costs(
        &self,
        problem: &Problem,
        (survey, factor): (&Kernels, usize),
        level: f64,
        x: &[DVec3],
    ) -> Vec<ElementCost> {
        let sure = if factor == self.factor { f64::NEG_INFINITY } else { level + SURE };
        let moved: Vec<bool> = self.places.par_iter().zip(x).map(|(place, x)| place != x).collect();
        let stands = |e: ElementId| !problem.nodes(e).iter().any(|n| moved[n.index()]);
        let holds = |e: ElementId| {
            let c_jac = self.costs[e.index()].c_jac;
            c_jac >= sure && (self.confirmed == level || c_jac >= self.confirmed.max(level))
        };
        let changed: Vec<ElementId> = problem.elements().filter(|&e| !(stands(e) && holds(e))).collect();
        let mut costs = self.costs.clone();
        let own = confirmed_costs(problem, survey, level, changed.par_iter().copied(), x);
        changed.iter().zip(own).for_each(|(e, cost)| costs[e.index()] = cost);
        costs
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::{Cell, Order};
    use crate::mesh::elevate::elevate;
    use crate::mesh::{Block, EntityKey, Mesh, NodeId, Parts};

    const FACTOR: usize = 2;

    /// A row of P3 hexes.
    fn row(count: usize) -> Mesh {
        let corner = |i: usize, [_, y, z]: [u8; 3]| DVec3::new(i as f64, f64::from(y), f64::from(z));
        let section: Vec<[u8; 3]> = Cell::Hex.corners().iter().copied().filter(|c| c[0] == 0).collect();
        let at = |i: usize, c: [u8; 3]| section.iter().position(|own| own[1..] == c[1..]).map(|k| 4 * i + k).unwrap();
        let points = (0..=count).flat_map(|i| section.iter().map(move |&c| corner(i, c))).collect();
        let hex = |i: usize| Cell::Hex.corners().iter().map(move |&c| at(i + usize::from(c[0]), c));
        let nodes = (0..count).flat_map(hex).map(|n| NodeId::new(n).unwrap()).collect();
        let tags = (1..=count as u64).collect();
        let block = Block { tags, nodes, ..Block::new(Cell::Hex, EntityKey::new(3, 1)) };
        let linear = Mesh::new(Parts { points, blocks: vec![block], ..Parts::default() }).unwrap();
        elevate(&linear, Order::new(3).unwrap()).unwrap().mesh
    }

    #[test]
    fn what_is_known_and_what_is_surveyed_are_the_costs_of_a_whole_survey() {
        let mesh = row(9);
        let problem = Problem::new(&mesh, mesh.points());
        let survey = Kernels::new(&problem, FACTOR * problem.order.get());
        let bend = |amount: f64, from: f64| -> Vec<DVec3> {
            let bent = |x: &DVec3| *x + DVec3::Y * amount * (x.x - from).max(0.0).powi(2) * (1.0 - 2.0 * x.y);
            mesh.points().iter().map(bent).collect()
        };
        let whole = |level, x: &[DVec3]| confirmed_costs(&problem, &survey, level, problem.elements(), x);
        let (before, after) = (bend(0.01, 0.0), bend(0.02, 6.5));
        for [first, then] in [[0.8, 0.8], [0.8, 0.3], [0.3, 0.8], [0.0, 0.8]] {
            let costs = whole(first, &before);
            let lowest = costs.iter().map(|cost| cost.c_jac).fold(1.0, f64::min);
            assert!(lowest < 0.3, "{lowest}: some are to be near nothing");
            let settings = Settings { threshold: first, survey_factor: FACTOR, ..Settings::default() };
            let known = Known::of(&problem, &settings, before.clone(), costs);
            for x in [&before, &after] {
                assert_eq!(known.costs(&problem, (&survey, FACTOR), then, x), whole(then, x), "{first} {then}");
            }
        }
    }

    #[test]
    fn a_survey_less_dense_is_believed_where_it_is_far_above() {
        let mesh = row(2);
        let problem = Problem::new(&mesh, mesh.points());
        let dense = 2 * FACTOR;
        let survey = Kernels::new(&problem, dense * problem.order.get());
        let settings = Settings { survey_factor: FACTOR, ..Settings::default() };
        let told = [0.85, 0.95].map(|c_jac| ElementCost { c_wcn: 0.9, mean_c_wcn: 0.9, c_jac, cut: 0 });
        let known = Known::of(&problem, &settings, mesh.points().to_vec(), told.to_vec());
        let costs = known.costs(&problem, (&survey, dense), settings.threshold, mesh.points());
        assert!(costs[0].c_jac == 1.0 && costs[1] == told[1], "{costs:?}");
    }

    #[test]
    fn only_what_moved_is_surveyed() {
        let mesh = row(9);
        let problem = Problem::new(&mesh, mesh.points());
        let survey = Kernels::new(&problem, FACTOR * problem.order.get());
        let settings = Settings { survey_factor: FACTOR, ..Settings::default() };
        let wrong = ElementCost { c_wcn: 0.9, mean_c_wcn: 0.9, c_jac: 0.9, cut: 0 };
        let known = Known::of(&problem, &settings, mesh.points().to_vec(), vec![wrong; 9]);
        let mut x = mesh.points().to_vec();
        x[0] += DVec3::Y * 0.1;
        let costs = known.costs(&problem, (&survey, FACTOR), settings.threshold, &x);
        assert!(costs[0] != wrong && costs[1..].iter().all(|cost| *cost == wrong));
    }
}
