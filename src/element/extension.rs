//! From the rim of a triangle or quadrilateral into its inside: the smoothest polynomial with the given rim.

use super::bernstein::binomial;
use super::{Cell, Order, Tables, interior_count, interior_start, lattice};

/// Weights of a face's rim nodes (corners and edges) at each of its inner nodes: row-major, `[inner][rim]`.
///
/// The inner values make the polynomial of order p that has the given rim and the smallest coefficients of degree p
/// (the sum of squares of the p-th differences on the lattice), so that data of low degree are extended exactly and
/// no ripple of the lattice's own wave length comes in. A quadrilateral takes the Coons patch of its rim.
#[must_use]
pub fn interior_extension(cell: Cell, order: Order) -> &'static [f64] {
    static TABLES: Tables<Vec<f64>> = Tables::new();
    TABLES.get(cell, order, || match cell {
        Cell::Triangle => triangle(order),
        Cell::Quad => coons(order),
        _ => Vec::new(),
    })
}

/// Weight of the (p-1)-th differences where the p-th ones alone leave the inner values open.
const LOWER: f64 = 1e-5;

/// Minimises `|D_p f|^2`, `D_p` all p-th differences `Delta_x^a Delta_y^b`, `a + b = p`, by the inner values. From P4 on
/// that leaves the cubic bubble open: the (p-1)-th differences then decide.
fn triangle(order: Order) -> Vec<f64> {
    let p = order.get();
    let (rim, inner) = (interior_start(Cell::Triangle, order), interior_count(Cell::Triangle, order));
    let mut rows = differences(order, p, 1.0);
    if p > 3 {
        rows.extend(differences(order, p - 1, LOWER));
    }
    let product = |m: usize, n: usize| rows.iter().map(|row| row[m] * row[n]).sum::<f64>();
    let normal: Vec<Vec<f64>> =
        (rim..rim + inner).map(|m| (rim..rim + inner).map(|n| product(m, n)).collect()).collect();
    let sides: Vec<Vec<f64>> = (rim..rim + inner).map(|m| (0..rim).map(|n| -product(m, n)).collect()).collect();
    solved(normal, sides).concat()
}

/// All differences of degree `q` on the triangle's lattice, one row of node weights each, times `sqrt(weight)`.
fn differences(order: Order, q: usize, weight: f64) -> Vec<Vec<f64>> {
    let (p, nodes) = (order.get(), lattice(Cell::Triangle, order));
    let sign = |n: usize| if n.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut rows = Vec::new();
    for a in 0..=q {
        let b = q - a;
        for (oi, oj) in (0..=p - q).flat_map(|oi| (0..=p - q - oi).map(move |oj| (oi, oj))) {
            let entry = |node: &[u8; 3]| {
                let [i, j] = [usize::from(node[0]).wrapping_sub(oi), usize::from(node[1]).wrapping_sub(oj)];
                let inside = i <= a && j <= b;
                if inside { weight.sqrt() * sign(q - i - j) * binomial(a, i) * binomial(b, j) } else { 0.0 }
            };
            rows.push(nodes.iter().map(entry).collect());
        }
    }
    rows
}

/// `(1-y) bottom + y top + (1-x) left + x right` less the bilinear patch of the corners.
fn coons(order: Order) -> Vec<f64> {
    let (p, nodes) = (order.get(), lattice(Cell::Quad, order));
    let rim = interior_start(Cell::Quad, order);
    let mut rows = Vec::new();
    for &[i, j, _] in &nodes[rim..] {
        let (x, y) = (f64::from(i) / p as f64, f64::from(j) / p as f64);
        for &[m, n, _] in &nodes[..rim] {
            let end = |at: u8, t: f64| match usize::from(at) {
                0 => 1.0 - t,
                k if k == p => t,
                _ => 0.0,
            };
            let along = if m == i { end(n, y) } else { 0.0 } + if n == j { end(m, x) } else { 0.0 };
            rows.push(along - end(m, x) * end(n, y));
        }
    }
    rows
}

/// Solves a small symmetric positive definite system for several right sides at once.
fn solved(mut matrix: Vec<Vec<f64>>, mut sides: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = matrix.len();
    for pivot in 0..n {
        for row in (0..n).filter(|&row| row != pivot) {
            let factor = matrix[row][pivot] / matrix[pivot][pivot];
            for column in 0..n {
                let entry = matrix[pivot][column];
                matrix[row][column] -= factor * entry;
            }
            for column in 0..sides[row].len() {
                let entry = sides[pivot][column];
                sides[row][column] -= factor * entry;
            }
        }
    }
    for (row, side) in sides.iter_mut().enumerate() {
        side.iter_mut().for_each(|x| *x /= matrix[row][row]);
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_polynomials_are_extended_exactly() {
        for cell in [Cell::Triangle, Cell::Quad] {
            for order in Order::all().skip(1) {
                let p = order.get();
                let (nodes, rim) = (lattice(cell, order), interior_start(cell, order));
                let degree = if cell == Cell::Quad { 1 } else { (p - 1).min(2) } as i32;
                let f = |n: &[u8; 3]| {
                    let [x, y] = [f64::from(n[0]) / p as f64, f64::from(n[1]) / p as f64];
                    2.0 * x.powi(degree) - 3.0 * y.powi(degree) + x - 0.5 + if p > 2 { x * y } else { 0.0 }
                };
                let weights = interior_extension(cell, order);
                for (inner, row) in nodes[rim..].iter().zip(weights.chunks_exact(rim)) {
                    let value: f64 = nodes[..rim].iter().zip(row).map(|(n, w)| f(n) * w).sum();
                    assert!((value - f(inner)).abs() < 1e-7, "{cell} {order}: {value} for {}", f(inner));
                }
            }
        }
    }

    #[test]
    fn weights_sum_to_one() {
        for cell in [Cell::Triangle, Cell::Quad] {
            for order in Order::all() {
                for row in interior_extension(cell, order).chunks_exact(interior_start(cell, order)) {
                    assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-7, "{cell} {order}");
                }
            }
        }
    }
}
