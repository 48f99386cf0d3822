//! Bernstein polynomials of every cell, indexed like the cell's lattice.
//!
//! A point of a cell is given by its *reference coordinates*: the unit cell's own for all cells but the pyramid, for
//! which they run over the cube `(a, b, c)` with `x = a(1-c), y = b(1-c), z = c`. There the pyramid's basis
//! `B^p_m(s) B^m_i(a) B^m_j(b)`, `s = 1-c`, spans the rational pyramid space, and the derivatives returned by
//! [`gradients`] are polynomials, finite at the apex too (`docs/theory.md`, section 7).

use super::{Cell, Order, lattice};

/// Values of all Bernstein polynomials of a cell at a point in reference coordinates, in lattice order.
#[must_use]
pub fn values(cell: Cell, order: Order, at: [f64; 3]) -> Vec<f64> {
    terms(cell, order, at).into_iter().map(|t| t.value).collect()
}

/// Derivatives of all Bernstein polynomials by the coordinates of the unit cell, at a point in reference
/// coordinates.
#[must_use]
pub fn gradients(cell: Cell, order: Order, at: [f64; 3]) -> Vec<[f64; 3]> {
    terms(cell, order, at).into_iter().map(|t| t.gradient).collect()
}

/// Chart coordinates of a point of the unit cell; the pyramid's apex goes to `(0, 0, 1)`.
#[must_use]
pub fn chart(cell: Cell, [x, y, z]: [f64; 3]) -> [f64; 3] {
    match cell {
        Cell::Pyramid if z < 1.0 => [x / (1.0 - z), y / (1.0 - z), z],
        _ => [x, y, z],
    }
}

struct Term {
    value: f64,
    gradient: [f64; 3],
}

fn terms(cell: Cell, order: Order, at: [f64; 3]) -> Vec<Term> {
    let p = order.get();
    lattice(cell, order).iter().map(|&node| term(cell, p, node.map(usize::from), at)).collect()
}

fn term(cell: Cell, p: usize, [i, j, k]: [usize; 3], at: [f64; 3]) -> Term {
    match cell {
        Cell::Point => Term { value: 1.0, gradient: [0.0; 3] },
        Cell::Line | Cell::Triangle | Cell::Tet => simplex(p, &[i, j, k][..cell.dimension()], at),
        Cell::Quad => product(&[(p, i, at[0]), (p, j, at[1])]),
        Cell::Hex => product(&[(p, i, at[0]), (p, j, at[1]), (p, k, at[2])]),
        Cell::Prism => {
            let base = simplex(p, &[i, j], at);
            let (rise, slope) = (bernstein(p, k, at[2]), derivative(p, k, at[2]));
            let [gx, gy, _] = base.gradient;
            Term { value: base.value * rise, gradient: [gx * rise, gy * rise, base.value * slope] }
        }
        Cell::Pyramid => pyramid(p, [i, j, k], at),
    }
}

/// `p! / (i! j! k! l!) x^i y^j z^k (1-x-y-z)^l`, for as many axes as `index` has.
fn simplex(p: usize, index: &[usize], at: [f64; 3]) -> Term {
    let rest = p - index.iter().sum::<usize>();
    let last = 1.0 - at[..index.len()].iter().sum::<f64>();
    let scale = factorial(p) / (factorial(rest) * index.iter().map(|&i| factorial(i)).product::<f64>());
    let powers: f64 = index.iter().zip(at).map(|(&i, x)| power(x, i)).product();
    let mut gradient = [0.0; 3];
    for axis in 0..index.len() {
        let others: f64 = (0..index.len()).filter(|&a| a != axis).map(|a| power(at[a], index[a])).product();
        let own = power_slope(at[axis], index[axis]) * others;
        gradient[axis] = scale * (own * power(last, rest) - powers * power_slope(last, rest));
    }
    Term { value: scale * powers * power(last, rest), gradient }
}

/// Product of one-dimensional Bernstein polynomials `(degree, index, coordinate)`.
fn product(axes: &[(usize, usize, f64)]) -> Term {
    let value = axes.iter().map(|&(p, i, x)| bernstein(p, i, x)).product();
    let mut gradient = [0.0; 3];
    for (axis, slope) in gradient.iter_mut().enumerate().take(axes.len()) {
        *slope = axes
            .iter()
            .enumerate()
            .map(|(a, &(p, i, x))| if a == axis { derivative(p, i, x) } else { bernstein(p, i, x) })
            .product();
    }
    Term { value, gradient }
}

/// `B^p_m(s) B^m_i(a) B^m_j(b)`, `m = p - k`; with `d/dx = (1/s) d/da` and `d/dz = d/dc + (a/s) d/da + (b/s) d/db`.
fn pyramid(p: usize, [i, j, k]: [usize; 3], [a, b, c]: [f64; 3]) -> Term {
    let (m, s) = (p - k, 1.0 - c);
    let layer = bernstein(p, m, s);
    // B^p_m(s) / s; only needed where m > 0, as B^0 has no slope in a or b.
    let over_s = if m == 0 { 0.0 } else { binomial(p, m) * power(s, m - 1) * power(c, p - m) };
    let (ba, bb) = (bernstein(m, i, a), bernstein(m, j, b));
    let dx = over_s * derivative(m, i, a) * bb;
    let dy = over_s * ba * derivative(m, j, b);
    let dz = -derivative(p, m, s) * ba * bb + a * dx + b * dy;
    Term { value: layer * ba * bb, gradient: [dx, dy, dz] }
}

/// `B^n_i(t) = C(n,i) t^i (1-t)^(n-i)`.
fn bernstein(n: usize, i: usize, t: f64) -> f64 {
    binomial(n, i) * power(t, i) * power(1.0 - t, n - i)
}

fn derivative(n: usize, i: usize, t: f64) -> f64 {
    binomial(n, i) * (power_slope(t, i) * power(1.0 - t, n - i) - power(t, i) * power_slope(1.0 - t, n - i))
}

fn power(x: f64, n: usize) -> f64 {
    (0..n).fold(1.0, |y, _| y * x)
}

fn power_slope(x: f64, n: usize) -> f64 {
    if n == 0 { 0.0 } else { n as f64 * power(x, n - 1) }
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|i| i as f64).product()
}

/// `C(n, i)`, exact as far as the orders go.
pub(super) fn binomial(n: usize, i: usize) -> f64 {
    factorial(n) / (factorial(i) * factorial(n - i))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points inside a cell, in reference coordinates, away from symmetry.
    fn inside(cell: Cell) -> Vec<[f64; 3]> {
        let points = [[0.21, 0.13, 0.34], [0.05, 0.62, 0.11], [0.30, 0.27, 0.40]];
        let live = |axis: usize, x: f64| if axis < cell.dimension() { x } else { 0.0 };
        points.iter().map(|at| std::array::from_fn(|axis| live(axis, at[axis]))).collect()
    }

    /// The unit cell's point at reference coordinates.
    fn unit(cell: Cell, [a, b, c]: [f64; 3]) -> [f64; 3] {
        if cell == Cell::Pyramid { [a * (1.0 - c), b * (1.0 - c), c] } else { [a, b, c] }
    }

    #[test]
    fn they_are_positive_and_sum_to_one() {
        for cell in Cell::ALL {
            for order in Order::all() {
                for at in inside(cell) {
                    let values = values(cell, order, at);
                    assert!(values.iter().all(|&v| v > 0.0), "{cell} {order}");
                    assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{cell} {order}");
                }
            }
        }
    }

    #[test]
    fn the_remainder_of_the_gradient_falls_with_the_second_power() {
        for cell in Cell::ALL.into_iter().filter(|c| c.dimension() > 0) {
            for order in Order::all() {
                for at in inside(cell) {
                    let x = unit(cell, at);
                    let step = [0.7, -0.4, 0.5];
                    let slope = gradients(cell, order, at);
                    let remainder = |h: f64| -> f64 {
                        let moved: [f64; 3] =
                            std::array::from_fn(|a| if a < cell.dimension() { x[a] + h * step[a] } else { x[a] });
                        let (v0, v1) = (values(cell, order, at), values(cell, order, chart(cell, moved)));
                        let linear = |n: usize| (0..cell.dimension()).map(|a| slope[n][a] * step[a]).sum::<f64>() * h;
                        (0..v0.len()).map(|n| (v1[n] - v0[n] - linear(n)).abs()).sum()
                    };
                    let (coarse, fine) = (remainder(1e-3), remainder(5e-4));
                    if coarse < 1e-13 {
                        continue; // a linear basis has no remainder
                    }
                    let rate = (coarse / fine).log2();
                    assert!((rate - 2.0).abs() < 0.1, "{cell} {order} at {at:?}: h^{rate:.2}");
                }
            }
        }
    }

    #[test]
    fn the_pyramid_is_finite_at_its_apex() {
        for order in Order::all() {
            let slopes = gradients(Cell::Pyramid, order, [0.3, 0.8, 1.0]);
            assert!(slopes.iter().flatten().all(|s| s.is_finite()));
            let sum: [f64; 3] = std::array::from_fn(|a| slopes.iter().map(|s| s[a]).sum());
            assert!(sum.iter().all(|s| s.abs() < 1e-13), "{order}: {sum:?}");
        }
    }
}
