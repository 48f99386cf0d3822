//! The Lagrange basis on a cell's lattice, as a change of basis from Bernstein polynomials.

use super::{Cell, Order, Tables, bernstein, lattice};

/// Bernstein coefficients of the Lagrange functions: row-major, `[bernstein][node]`, both in lattice order.
///
/// The control net of an element is this matrix times its nodes.
#[must_use]
pub fn to_bernstein(cell: Cell, order: Order) -> &'static [f64] {
    static TABLES: Tables<Vec<f64>> = Tables::new();
    TABLES.get(cell, order, || {
        let p = order.get() as f64;
        let rows: Vec<f64> = lattice(cell, order)
            .iter()
            .flat_map(|node| {
                let unit = node.map(|x| f64::from(x) / p);
                bernstein::values(cell, order, bernstein::chart(cell, unit))
            })
            .collect();
        inverse(rows)
    })
}

/// Values of the Lagrange functions at a point in reference coordinates, in node order.
#[must_use]
pub fn values(cell: Cell, order: Order, at: [f64; 3]) -> Vec<f64> {
    let net = to_bernstein(cell, order);
    let b = bernstein::values(cell, order, at);
    let n = b.len();
    (0..n).map(|node| (0..n).map(|a| b[a] * net[a * n + node]).sum()).collect()
}

/// Values of the Lagrange functions of `order` at the nodes of the lattice of another order: `[node of lattice_order][function]`.
#[must_use]
pub fn at_lattice(cell: Cell, order: Order, lattice_order: Order) -> Vec<Vec<f64>> {
    let unit = |node: &[u8; 3]| node.map(|x| f64::from(x) / lattice_order.get() as f64);
    let nodes = lattice(cell, lattice_order).iter();
    nodes.map(|node| values(cell, order, bernstein::chart(cell, unit(node)))).collect()
}

/// The values at the nodes of the lattice, of the function that has given values at other points: row-major, `[node][point]`.
///
/// The points, in coordinates of the unit cell, must determine a function of the element's space.
#[must_use]
pub fn from_points(cell: Cell, order: Order, points: &[[f64; 3]]) -> Vec<f64> {
    inverse(points.iter().flat_map(|&at| values(cell, order, bernstein::chart(cell, at))).collect())
}

/// Derivatives of the Lagrange functions by the coordinates of the unit cell, at a point in reference coordinates.
#[must_use]
pub fn gradients(cell: Cell, order: Order, at: [f64; 3]) -> Vec<[f64; 3]> {
    let net = to_bernstein(cell, order);
    let slopes = bernstein::gradients(cell, order, at);
    let n = slopes.len();
    (0..n).map(|node| std::array::from_fn(|axis| (0..n).map(|a| slopes[a][axis] * net[a * n + node]).sum())).collect()
}

/// The inverse of a square row-major matrix, by Gauss-Jordan elimination with row pivots.
pub(crate) fn inverse(mut m: Vec<f64>) -> Vec<f64> {
    let n = m.len().isqrt();
    let mut inv = vec![0.0; n * n];
    for i in 0..n {
        inv[i * n + i] = 1.0;
    }
    for column in 0..n {
        let pivot = (column..n).max_by(|&a, &b| m[a * n + column].abs().total_cmp(&m[b * n + column].abs()));
        let pivot = pivot.unwrap_or(column);
        for x in 0..n {
            m.swap(column * n + x, pivot * n + x);
            inv.swap(column * n + x, pivot * n + x);
        }
        let scale = 1.0 / m[column * n + column];
        for x in 0..n {
            m[column * n + x] *= scale;
            inv[column * n + x] *= scale;
        }
        for row in (0..n).filter(|&row| row != column) {
            let factor = m[row * n + column];
            if factor != 0.0 {
                for x in 0..n {
                    m[row * n + x] -= factor * m[column * n + x];
                    inv[row * n + x] -= factor * inv[column * n + x];
                }
            }
        }
    }
    inv
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_function_is_one_at_its_node_and_zero_at_the_others() {
        for cell in Cell::ALL {
            for order in Order::all() {
                for (node, at) in lattice(cell, order).iter().enumerate() {
                    let unit = at.map(|x| f64::from(x) / order.get() as f64);
                    let values = values(cell, order, bernstein::chart(cell, unit));
                    for (other, value) in values.into_iter().enumerate() {
                        let expected = if other == node { 1.0 } else { 0.0 };
                        assert!((value - expected).abs() < 1e-11, "{cell} {order}: {value} at node {node}");
                    }
                }
            }
        }
    }

    #[test]
    fn gradients_reproduce_the_identity_map() {
        for cell in Cell::ALL {
            for order in Order::all() {
                let slopes = gradients(cell, order, [0.2, 0.3, 0.1]);
                for axis in 0..cell.dimension() {
                    for by in 0..cell.dimension() {
                        let sum: f64 = lattice(cell, order)
                            .iter()
                            .zip(&slopes)
                            .map(|(at, s)| f64::from(at[axis]) / order.get() as f64 * s[by])
                            .sum();
                        let expected = if axis == by { 1.0 } else { 0.0 };
                        assert!((sum - expected).abs() < 1e-11, "{cell} {order}: d{axis}/d{by} = {sum}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_trace_on_a_face_is_the_basis_of_the_face() {
        for cell in Cell::VOLUME {
            for order in Order::all() {
                for face in cell.faces() {
                    let own = values(face.cell, order, [0.23, 0.41, 0.0]);
                    let nodes = super::super::face_lattice(cell, face, order);
                    let corner = |q: usize| cell.corners()[usize::from(face.corners[q])].map(f64::from);
                    let (o, i, j) = (corner(0), corner(1), corner(face.corners.len() - 1));
                    let at = std::array::from_fn(|x| o[x] + 0.23 * (i[x] - o[x]) + 0.41 * (j[x] - o[x]));
                    let all = values(cell, order, bernstein::chart(cell, at));
                    for (slot, node) in lattice(cell, order).iter().enumerate() {
                        let expected = nodes.iter().position(|n| n == node).map_or(0.0, |q| own[q]);
                        assert!((all[slot] - expected).abs() < 1e-11, "{cell} {order} {:?}", face.corners);
                    }
                }
            }
        }
    }
}
