//! The columns of an element's Jacobian matrix as Bernstein nets, by exact integer combinations of its nodes.
//!
//! Columns by the axes of the unit cell: `p (c_(b + e) - c_b)` for a control net `c`. For the pyramid, in its reference
//! coordinates with `s = 1 - c` and layers `x_m` (`docs/theory.md`, section 7): `X_a / s = p sum B^(p-1)_m(s) [Delta_a x_(m+1)]`,
//! `X_b / s` likewise, `X_c = p sum B^(p-1)_m(s) [E x_m - x_(m+1)]` with the degree elevation `E`; their determinant is
//! that of the Jacobian matrix, a polynomial up to and including the apex.
//!
//! Triangles and quadrilaterals have two columns; the third is a constant vector, given as one more node after their own,
//! so that the determinant is `(x_u x x_v) . m`. A line has one, and two constant vectors.

use super::bernstein::binomial;
use super::{Cell, Net, Order, basis, lattice};

/// One column of the Jacobian matrix: scaled coefficients as integer combinations of nodes.
#[derive(Clone, Debug)]
pub struct Derivative {
    /// Where the coefficients stand.
    pub net: Net,
    /// For each index of `net.indices()`, nodes and integer factors.
    pub rows: Vec<Vec<(usize, f64)>>,
    /// What the combinations are to be divided by, beside the net's weights.
    pub denominator: f64,
}

/// The columns of the Jacobian matrix of an element with three dimensions, of a face with its vector `m`, or of a line with its two.
#[must_use]
pub fn derivatives(cell: Cell, order: Order) -> [Derivative; 3] {
    let (matrix, denominator) = integer_to_bernstein(cell, order);
    let nodes = lattice(cell, order);
    std::array::from_fn(|axis| {
        let net = Net::control(cell, order).derivative(axis);
        if axis >= cell.dimension() {
            let vector = nodes.len() + axis - cell.dimension();
            return Derivative { net, rows: vec![vec![(vector, 1.0)]], denominator: 1.0 };
        }
        let rows = net.indices().into_iter().map(|index| {
            let mut row = vec![0.0; nodes.len()];
            for (at, factor) in difference(cell, order, axis, net, index) {
                let control = nodes.iter().position(|n| n.map(usize::from) == at);
                let entries = control.map_or(&[][..], |c| &matrix[c * nodes.len()..][..nodes.len()]);
                row.iter_mut().zip(entries).for_each(|(sum, entry)| *sum += factor * entry);
            }
            row.into_iter().enumerate().filter(|&(_, factor)| factor != 0.0).collect()
        });
        Derivative { net, rows: rows.collect(), denominator }
    })
}

/// A scaled coefficient of a column as an integer combination of control points.
fn difference(cell: Cell, order: Order, axis: usize, net: Net, index: [usize; 3]) -> Vec<([usize; 3], f64)> {
    let [i, j, k] = index;
    let scale = order.get() as f64 * net.weight(index);
    if cell != Cell::Pyramid || axis < 2 {
        let next = std::array::from_fn(|a| index[a] + usize::from(a == axis));
        return vec![(next, scale), (index, -scale)];
    }
    // The weight of `index` holds C(m+1, i) C(m+1, j); with E's factors, i / (m+1) and 1 - i / (m+1), that becomes
    // C(m, i-1) and C(m, i): integers again.
    let m = net.degree[2] - k;
    let layer = order.get() as f64 * binomial(net.degree[2], k);
    let mut terms = vec![(index, -scale)];
    for (x, y) in [(i, j), (i.wrapping_sub(1), j), (i, j.wrapping_sub(1)), (i.wrapping_sub(1), j.wrapping_sub(1))] {
        if x <= m && y <= m {
            terms.push(([x, y, k + 1], layer * binomial(m, x) * binomial(m, y)));
        }
    }
    terms
}

/// [`basis::to_bernstein`] times the least common denominator of its entries: exact integers, and the denominator.
fn integer_to_bernstein(cell: Cell, order: Order) -> (Vec<f64>, f64) {
    let matrix = basis::to_bernstein(cell, order);
    let whole = |d: f64| matrix.iter().all(|x| (x * d - (x * d).round()).abs() < 1e-10 * d);
    let denominator = (1..=LARGEST_DENOMINATOR).map(f64::from).find(|&d| whole(d)).unwrap_or(f64::NAN);
    (matrix.iter().map(|x| (x * denominator).round()).collect(), denominator)
}

/// No cell and order needs a larger common denominator (tested).
const LARGEST_DENOMINATOR: u32 = 50_000;

#[cfg(test)]
mod tests {
    use super::*;

    /// The value of a Bernstein polynomial at a lattice node, times a denominator that depends on the node only.
    fn numerator(cell: Cell, p: i128, at: [i128; 3], index: [i128; 3]) -> i128 {
        let pow = |x: i128, n: i128| x.pow(n as u32);
        let choose = |n: i128, i: i128| binomial(n as usize, i as usize) as i128;
        let line = |n: i128, i: i128, x: i128, w: i128| choose(n, i) * pow(x, i) * pow(w - x, n - i) * pow(w, p - n);
        let [i, j, k] = index;
        let [x, y, z] = at;
        match cell {
            Cell::Hex => line(p, i, x, p) * line(p, j, y, p) * line(p, k, z, p),
            Cell::Prism => {
                let base = choose(p, i) * choose(p - i, j) * pow(x, i) * pow(y, j) * pow(p - x - y, p - i - j);
                base * line(p, k, z, p)
            }
            Cell::Pyramid => {
                let (m, w) = (p - k, if z == p { 1 } else { p - z });
                line(p, k, z, p) * line(m, i, x, w) * line(m, j, y, w)
            }
            _ => {
                let count = choose(p, i) * choose(p - i, j) * choose(p - i - j, k);
                count * pow(x, i) * pow(y, j) * pow(z, k) * pow(p - x - y - z, p - i - j - k)
            }
        }
    }

    #[test]
    fn integer_matrices_are_exact_inverses() {
        for cell in Cell::VOLUME {
            for order in Order::all() {
                let (matrix, denominator) = integer_to_bernstein(cell, order);
                let (p, n) = (order.get() as i128, cell.node_count(order));
                let nodes: Vec<[i128; 3]> = lattice(cell, order).iter().map(|at| at.map(i128::from)).collect();
                for row in 0..n {
                    let values: Vec<i128> = nodes.iter().map(|&b| numerator(cell, p, nodes[row], b)).collect();
                    let whole: i128 = values.iter().sum();
                    for column in 0..n {
                        let sum: i128 = (0..n).map(|b| values[b] * matrix[b * n + column] as i128).sum();
                        let expected = if row == column { whole * denominator as i128 } else { 0 };
                        assert_eq!(sum, expected, "{cell} {order}, {row} {column}");
                    }
                }
            }
        }
    }
}
