//! The measures of every element of a mesh.

use std::cmp::Ordering;

use glam::DVec3;

use crate::certify::{self, Measured};
use crate::element::{Order, basis};
use crate::mesh::Mesh;
use crate::smooth::{ElementCost, Problem};

/// Divisions of an edge at which costs are surveyed, in multiples of the order: as `sagitta curve` does.
const SURVEY_FACTOR: usize = 4;

/// The measures of every element, in the order of the mesh's cells; the larger the better, all but `J / J_c` at most 1.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measures {
    /// Proven lower bound of the minimum of `J / J_c`; minus infinity where `J_c` is not positive.
    pub j_over_jc: Vec<f64>,
    /// Proven lower bound of the scaled Jacobian, smallest over largest determinant.
    pub scaled_jacobian: Vec<f64>,
    /// Worst `C_WCN` of the sub-elements, equations (3) to (5).
    pub c_wcn: Vec<f64>,
    /// Worst `C_JAC` of the survey, equation (6).
    pub c_jac: Vec<f64>,
}

impl Measures {
    /// The measures of a mesh against the linear one with its corners at `linear_corners` (by nodes), or each element's own corners.
    #[must_use]
    pub fn of(mesh: &Mesh, linear_corners: Option<&[DVec3]>) -> Measures {
        let straight = straight(mesh, linear_corners.unwrap_or(mesh.points()));
        let costs = Problem::new(mesh, &straight).survey(mesh.points(), SURVEY_FACTOR);
        let proven = certify::measured(mesh, mesh.points(), linear_corners, &certify::Settings::default());
        Measures::new(proven, &costs)
    }

    /// Those of them that are proven; the costs are left empty.
    #[must_use]
    pub fn proven(mesh: &Mesh, linear_corners: Option<&[DVec3]>) -> Measures {
        Measures::new(certify::measured(mesh, mesh.points(), linear_corners, &certify::Settings::default()), &[])
    }

    /// The measures that are proven, and the costs of a survey.
    #[must_use]
    pub fn new(proven: Measured, costs: &[ElementCost]) -> Measures {
        Measures {
            j_over_jc: proven.relative,
            scaled_jacobian: proven.scaled,
            c_wcn: costs.iter().map(|cost| cost.c_wcn).collect(),
            c_jac: costs.iter().map(|cost| cost.c_jac).collect(),
        }
    }

    /// All of them with their names in figures and fields.
    #[must_use]
    pub fn named(&self) -> [(&'static str, &[f64]); 4] {
        [
            ("J/J_c", &self.j_over_jc),
            ("scaled Jacobian", &self.scaled_jacobian),
            ("C_WCN", &self.c_wcn),
            ("C_JAC", &self.c_jac),
        ]
    }

    /// The elements with the smallest `J / J_c`, worst first, at most so many; where it is the same the smaller `C_WCN` decides.
    #[must_use]
    pub fn worst(&self, count: usize) -> Vec<usize> {
        let order = |&a: &usize, &b: &usize| {
            let by = |values: &[f64]| values.get(a).zip(values.get(b)).map_or(Ordering::Equal, |(a, b)| a.total_cmp(b));
            by(&self.j_over_jc).then(by(&self.c_wcn)).then(a.cmp(&b))
        };
        let mut all: Vec<usize> = (0..self.j_over_jc.len()).collect();
        if count < all.len() {
            all.select_nth_unstable_by(count, order);
            all.truncate(count);
        }
        all.sort_unstable_by(order);
        all
    }
}

/// Where the nodes of all elements would be if those were straight.
fn straight(mesh: &Mesh, corners: &[DVec3]) -> Vec<DVec3> {
    let mut straight = mesh.points().to_vec();
    for block in mesh.cell_blocks() {
        let weights = basis::at_lattice(block.cell, Order::LINEAR, mesh.order());
        for nodes in block.elements(mesh.order()) {
            for (node, weights) in nodes.iter().zip(&weights) {
                let own = nodes.iter().zip(weights).map(|(corner, &weight)| corners[corner.index()] * weight);
                straight[node.index()] = own.sum();
            }
        }
    }
    straight
}
