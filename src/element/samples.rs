//! Tables of Lagrange gradients at the points where a cell's Jacobian is sampled.

use super::cell::lattice_points;
use super::{Cell, Order, basis, bernstein};

/// Lanes that the sample loops are written for: tables are padded to a multiple of it.
pub const LANES: usize = 4;

/// Gradients of the Lagrange functions of one cell at a set of points, laid out for loops over the points.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Chart coordinates of the points; the last ones may stand again as padding.
    points: Vec<[f64; 3]>,
    /// How many points are not padding.
    count: usize,
    /// `[node][axis][point]`.
    gradients: Vec<f64>,
}

impl Samples {
    /// Tables for the given points, in reference coordinates.
    #[must_use]
    pub fn new(cell: Cell, order: Order, mut points: Vec<[f64; 3]>) -> Samples {
        let count = points.len();
        if let Some(&last) = points.last() {
            points.resize(count.next_multiple_of(LANES), last);
        }
        let (nodes, padded) = (cell.node_count(order), points.len());
        let mut gradients = vec![0.0; nodes * 3 * padded];
        for (s, &at) in points.iter().enumerate() {
            for (node, slopes) in basis::gradients(cell, order, at).into_iter().enumerate() {
                for (axis, slope) in slopes.into_iter().enumerate() {
                    gradients[(node * 3 + axis) * padded + s] = slope;
                }
            }
        }
        Samples { points, count, gradients }
    }

    /// The paper's survey: equispaced points, `divisions` an edge (§2.3); a pyramid's apex is left out, as its
    /// Jacobian there depends on the direction.
    #[must_use]
    pub fn survey(cell: Cell, order: Order, divisions: usize) -> Samples {
        Samples::new(cell, order, survey_points(cell, divisions))
    }

    /// Number of points, padding not counted.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Number of points with padding.
    #[must_use]
    pub fn padded(&self) -> usize {
        self.points.len()
    }

    /// Chart coordinates of the points, with padding.
    #[must_use]
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The gradient of a node's function: one slice over the points for each axis.
    #[must_use]
    pub fn gradient(&self, node: usize) -> [&[f64]; 3] {
        let n = self.points.len();
        std::array::from_fn(|axis| &self.gradients[(node * 3 + axis) * n..][..n])
    }
}

/// Chart coordinates of the equispaced points of `divisions` an edge.
fn survey_points(cell: Cell, divisions: usize) -> Vec<[f64; 3]> {
    let n = divisions.max(1);
    lattice_points(cell, n)
        .map(|at| at.map(|x| x as f64 / n as f64))
        .filter(|at| cell != Cell::Pyramid || at[2] < 1.0)
        .map(|at| bernstein::chart(cell, at))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surveys_have_the_points_of_the_lattice() {
        assert_eq!(Samples::survey(Cell::Tet, Order::MAX, 4).count(), 35);
        assert_eq!(Samples::survey(Cell::Hex, Order::MAX, 3).count(), 64);
        assert_eq!(Samples::survey(Cell::Prism, Order::MAX, 2).count(), 18);
        assert_eq!(Samples::survey(Cell::Pyramid, Order::MAX, 2).count(), 13);
        let samples = Samples::survey(Cell::Tet, Order::MAX, 4);
        assert_eq!(samples.padded(), 36);
        assert_eq!(samples.points()[35], samples.points()[34]);
    }

    #[test]
    fn tables_hold_the_basis() {
        let order = Order::MAX;
        let samples = Samples::survey(Cell::Prism, order, 3);
        let expected = basis::gradients(Cell::Prism, order, samples.points()[7]);
        for (node, slopes) in expected.iter().enumerate() {
            for axis in 0..3 {
                assert_eq!(samples.gradient(node)[axis][7], slopes[axis]);
            }
        }
    }
}
