//! What the certificate says of elements that are worked on: the smoother calls none valid that is not proven valid.
//!
//! A survey looks at points; between them a determinant can be negative. So an element below the threshold whose survey is positive is
//! judged by its Bernstein coefficients as well, and takes the cost of an inverted one unless they prove it valid. It is then given a
//! denser survey, and no state with it can be the best one while there is a state with fewer such elements.

use glam::DVec3;
use rayon::prelude::*;

use super::problem::Kernels;
use super::{ElementCost, Problem};
use crate::certify::{self, Judge, Shape, Verdict};
use crate::mesh::ElementId;

/// Costs of the given elements by a survey, confirmed where `C_JAC` is below `level`.
pub(super) fn confirmed_costs(
    problem: &Problem,
    survey: &Kernels,
    level: f64,
    elements: impl IndexedParallelIterator<Item = ElementId> + Clone,
    x: &[DVec3],
) -> Vec<ElementCost> {
    let mut costs = problem.costs(survey, x, elements.clone());
    let doubtful = costs.par_iter_mut().zip(elements).filter(|(cost, _)| cost.c_jac > 0.0 && cost.c_jac < level);
    doubtful.for_each_init(Bench::default, |bench, (cost, element)| {
        cost.c_jac = cost.c_jac.min(bench.bound(problem, element, x));
    });
    costs
}

/// A judge with its buffers.
#[derive(Default)]
struct Bench {
    judge: Judge,
    points: Vec<DVec3>,
    corners: Vec<DVec3>,
}

impl Bench {
    /// What `C_JAC` cannot exceed: 0 at most where the element is not proven valid.
    fn bound(&mut self, problem: &Problem, element: ElementId, x: &[DVec3]) -> f64 {
        let (cell, nodes) = (problem.cell(element), problem.nodes(element));
        self.points.clear();
        self.points.extend(nodes.iter().map(|n| x[n.index()]));
        self.corners.clear();
        self.corners.extend(nodes[..cell.corner_count()].iter().map(|n| problem.straight[n.index()]));
        let (points, corners) = (&self.points[..], Some(&self.corners[..]));
        let view = problem.view.of_element(&self.corners);
        let shape = Shape { cell, order: problem.order, points, corners, upright: view.normal.as_slice() };
        // Only the sign matters: any bound is near enough.
        let settings = certify::Settings { gap: f64::INFINITY, ..certify::Settings::default() };
        let finding = self.judge.examine(&shape, &settings);
        if finding.verdict == Verdict::Valid { f64::INFINITY } else { finding.relative.upper.min(0.0) }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::element::{Cell, Order};
    use crate::mesh::elevate::elevate;
    use crate::mesh::{Block, EntityKey, Mesh, NodeId, Parts};

    /// A P4 hex, squeezed along one axis: `dx/du` is a parabola of mean 1 with its minimum `least` at `c`.
    fn squeezed(c: f64, least: f64) -> (Mesh, Vec<DVec3>) {
        let points: Vec<DVec3> = Cell::Hex.corners().iter().map(|c| DVec3::from(c.map(f64::from))).collect();
        let nodes = (0..points.len()).map(|n| NodeId::new(n).unwrap()).collect();
        let entity = EntityKey::new(3, 1);
        let block = Block { tags: vec![1], nodes, ..Block::new(Cell::Hex, entity) };
        let linear = Mesh::new(Parts { points, blocks: vec![block], ..Parts::default() }).unwrap();
        let mesh = elevate(&linear, Order::new(4).unwrap()).unwrap().mesh;
        let cube = |u: f64| (u - c).powi(3) / 3.0;
        let k = (1.0 - least) / (cube(1.0) - cube(0.0));
        let bend = |x: &DVec3| DVec3::new(k * (cube(x.x) - cube(0.0)) + least * x.x, x.y, x.z);
        let places = mesh.points().iter().map(bend).collect();
        (mesh, places)
    }

    #[test]
    fn an_invalid_spot_between_survey_points_is_no_valid_element() {
        const DIVISIONS: usize = 16;
        let between = 6.5 / DIVISIONS as f64;
        for least in [-5e-3, 5e-3] {
            let (mesh, places) = squeezed(between, least);
            let problem = Problem::new(&mesh, mesh.points());
            let survey = Kernels::new(&problem, DIVISIONS);
            let seen = problem.costs(&survey, &places, problem.elements())[0];
            assert!(seen.c_jac > 2e-3, "the survey must be blind to it: {seen:?}");
            let confirmed = |level| confirmed_costs(&problem, &survey, level, problem.elements(), &places)[0];
            if least > 0.0 {
                assert_eq!(confirmed(0.8), seen);
            } else {
                assert!(confirmed(0.8).c_jac < 0.0, "{:?}", confirmed(0.8));
                assert_eq!(confirmed(1e-3), seen, "above the level it is not judged");
            }
        }
    }
}
