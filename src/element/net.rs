//! Bernstein nets of any degree on a cell: their indices, multinomial weights, corners, and products.
//!
//! A polynomial's coefficients times their multinomial weights, its *scaled* net, multiply by plain convolution: the
//! scaled net of a product is the sum over pairs of indices that add up, and degrees add up as well
//! (`docs/theory.md`, section 7). Indices are those of the cell's lattice.

use super::bernstein::binomial;
use super::{Cell, Order};

/// A space of polynomials of a cell's reference coordinates, in Bernstein form.
///
/// Degrees by axis: simplices have one degree on all axes, prisms one on the first two. A pyramid's net is *layered*:
/// with `s = 1 - c` its polynomials are `sum_m B^n_m(s) q_m(a, b)`, `q_m` of degrees `m + degree[0]` in `a` and
/// `m + degree[1]` in `b`, `n = degree[2]`; index `(i, j, k)` belongs to layer `m = n - k`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Net {
    /// The cell; a pyramid in tensor form is a hex.
    pub cell: Cell,
    /// Degree by axis.
    pub degree: [usize; 3],
}

impl Net {
    /// The control net of an element's coordinates.
    #[must_use]
    pub fn control(cell: Cell, order: Order) -> Net {
        let p = order.get();
        let degree = match cell {
            Cell::Pyramid => [0, 0, p],
            Cell::Line => [p, 0, 0],
            Cell::Triangle | Cell::Quad => [p, p, 0],
            _ => [p; 3],
        };
        Net { cell, degree }
    }

    /// The net of the derivative of a control net by one axis of the unit cell (pyramid: of the columns that
    /// [`super::derivative`] explains). Beyond the cell's dimension they are constants.
    #[must_use]
    pub fn derivative(self, axis: usize) -> Net {
        let [p, .., top] = self.degree;
        let degree = match self.cell {
            Cell::Tet => [p - 1; 3],
            Cell::Line | Cell::Triangle | Cell::Quad if axis >= self.cell.dimension() => [0; 3],
            Cell::Triangle => [p - 1, p - 1, 0],
            Cell::Prism if axis < 2 => [p - 1, p - 1, top],
            Cell::Prism => [p, p, top - 1],
            Cell::Pyramid => [usize::from(axis != 0), usize::from(axis != 1), top - 1],
            _ => std::array::from_fn(|a| self.degree[a] - usize::from(a == axis)),
        };
        Net { cell: self.cell, degree }
    }

    /// The net that holds the determinant of the Jacobian matrix: the product of the three derivatives.
    #[must_use]
    pub fn jacobian(cell: Cell, order: Order) -> Net {
        let control = Net::control(cell, order);
        control.derivative(0).times(control.derivative(1)).times(control.derivative(2))
    }

    /// The net of products with another net on the same cell.
    #[must_use]
    pub fn times(self, other: Net) -> Net {
        Net { cell: self.cell, degree: std::array::from_fn(|a| self.degree[a] + other.degree[a]) }
    }

    /// The net whose product with `lower` is this one: the constant 1 in it raises the degree of `lower`.
    #[must_use]
    pub fn over(self, lower: Net) -> Net {
        Net { cell: self.cell, degree: std::array::from_fn(|a| self.degree[a] - lower.degree[a]) }
    }

    /// Whether the net has a coefficient at an index.
    #[must_use]
    pub fn holds(self, [i, j, k]: [usize; 3]) -> bool {
        let [p, q, n] = self.degree;
        match self.cell {
            Cell::Tet => i + j + k <= p,
            Cell::Triangle | Cell::Prism => i + j <= p && k <= n,
            Cell::Pyramid => k <= n && i <= n - k + p && j <= n - k + q,
            _ => i <= p && j <= q && k <= n,
        }
    }

    /// All indices, first axis fastest.
    #[must_use]
    pub fn indices(self) -> Vec<[usize; 3]> {
        let [i, j, k] = match self.cell {
            Cell::Pyramid => [self.degree[0] + self.degree[2], self.degree[1] + self.degree[2], self.degree[2]],
            _ => self.degree,
        };
        let all = (0..=k).flat_map(|k| (0..=j).flat_map(move |j| (0..=i).map(move |i| [i, j, k])));
        all.filter(|&at| self.holds(at)).collect()
    }

    /// The multinomial weight of a coefficient, an integer.
    #[must_use]
    pub fn weight(self, [i, j, k]: [usize; 3]) -> f64 {
        let [p, q, n] = self.degree;
        match self.cell {
            Cell::Tet => binomial(p, i) * binomial(p - i, j) * binomial(p - i - j, k),
            Cell::Triangle | Cell::Prism => binomial(p, i) * binomial(p - i, j) * binomial(n, k),
            Cell::Pyramid => binomial(n, k) * binomial(n - k + p, i) * binomial(n - k + q, j),
            _ => binomial(p, i) * binomial(q, j) * binomial(n, k),
        }
    }

    /// The corners in reference coordinates (a pyramid's are those of the cube), each with the index of the coefficient that is the
    /// polynomial's value there.
    #[must_use]
    pub fn corners(self) -> Vec<([usize; 3], [f64; 3])> {
        let [p, q, n] = self.degree;
        let index = |[x, y, z]: [usize; 3]| match self.cell {
            Cell::Pyramid if z == 0 => [x * (p + n), y * (q + n), 0],
            _ => [x * p, y * q, z * n],
        };
        let corners = self.chart().corners().iter().map(|corner| corner.map(usize::from));
        corners.map(|corner| (index(corner), corner.map(|x| x as f64))).collect()
    }

    /// The cell that the reference coordinates run over: the hex for a pyramid.
    #[must_use]
    pub fn chart(self) -> Cell {
        if self.cell == Cell::Pyramid { Cell::Hex } else { self.cell }
    }

    /// The net in reference coordinates that holds this net's polynomials: a pyramid's layers raised to one degree; others stay.
    #[must_use]
    pub fn on_chart(self) -> Net {
        let [p, q, n] = self.degree;
        let degree = if self.cell == Cell::Pyramid { [p + n, q + n, n] } else { self.degree };
        Net { cell: self.chart(), degree }
    }

    /// The coefficient at `index` of [`Net::on_chart`] as a combination of coefficients of this net; the weights are
    /// positive and sum to one.
    #[must_use]
    pub fn raised(self, index: [usize; 3]) -> Vec<([usize; 3], f64)> {
        if self.cell != Cell::Pyramid {
            return vec![(index, 1.0)];
        }
        let [i, j, k] = index;
        let m = self.degree[2] - k;
        let (a, b) = (
            [m + self.degree[0], self.degree[2] + self.degree[0]],
            [m + self.degree[1], self.degree[2] + self.degree[1]],
        );
        let along = |[low, high]: [usize; 2], to: usize, from: usize| {
            binomial(low, from) * binomial(high - low, to - from) / binomial(high, to)
        };
        let reach = |[low, high]: [usize; 2], to: usize| to.saturating_sub(high - low)..=to.min(low);
        let pairs = reach(b, j).flat_map(|y| reach(a, i).map(move |x| (x, y)));
        pairs.map(|(x, y)| ([x, y, k], along(a, i, x) * along(b, j, y))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jacobians_have_as_many_coefficients_as_the_theory_says() {
        let counts = |cell| Order::all().map(|p| Net::jacobian(cell, p).indices().len()).collect::<Vec<_>>();
        assert_eq!(counts(Cell::Tet), [1, 20, 84, 220]);
        assert_eq!(counts(Cell::Hex), [27, 216, 729, 1728]);
        assert_eq!(counts(Cell::Prism), [9, 90, 324, 792]);
        assert_eq!(counts(Cell::Pyramid), [9, 86, 280, 645]);
        assert_eq!(counts(Cell::Triangle), [1, 6, 15, 28]);
        assert_eq!(counts(Cell::Quad), [4, 16, 36, 64]);
        assert_eq!(counts(Cell::Line), [1, 2, 3, 4]);
    }

    #[test]
    fn corners_belong_to_the_net() {
        for cell in Cell::VOLUME {
            for order in Order::all() {
                let net = Net::jacobian(cell, order);
                assert!(net.corners().iter().all(|&(index, _)| net.holds(index) && net.weight(index) == 1.0));
            }
        }
    }

    #[test]
    fn raising_to_the_chart_is_a_mean() {
        let net = Net::jacobian(Cell::Pyramid, Order::MAX);
        for index in net.on_chart().indices() {
            let terms = net.raised(index);
            assert!(terms.iter().all(|&(from, w)| net.holds(from) && w > 0.0));
            assert!((terms.iter().map(|t| t.1).sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }
}
