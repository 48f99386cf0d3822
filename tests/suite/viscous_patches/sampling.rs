//! The Jacobian at many points of every element, by code that shares nothing with the program's but the order of nodes.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};
use sagitta::element::{Cell, Order, lattice};
use sagitta::mesh::Mesh;

/// Points along an edge, less one.
const DENSITY: usize = 12;

/// Cells with a point at which the Jacobian is not positive.
pub fn inverted(mesh: &Mesh) -> Vec<(Cell, u64)> {
    let mut tables = BTreeMap::new();
    let mut found = Vec::new();
    for block in mesh.cell_blocks() {
        let table = tables.entry(block.cell).or_insert_with(|| table(block.cell, mesh.order()));
        for (nodes, &tag) in block.elements(mesh.order()).zip(&block.tags) {
            let points: Vec<DVec3> = mesh.points_of(nodes).collect();
            let determinant = |gradients: &Vec<DVec3>| {
                let columns = |axis: usize| points.iter().zip(gradients).map(|(&x, g)| (x - points[0]) * g[axis]).sum();
                DMat3::from_cols(columns(0), columns(1), columns(2)).determinant()
            };
            if table.iter().any(|gradients| determinant(gradients) <= 0.0) {
                found.push((block.cell, tag));
            }
        }
    }
    found
}

/// For each sample point the gradients of the Lagrange functions of all nodes.
fn table(cell: Cell, order: Order) -> Vec<Vec<DVec3>> {
    let p = order.get();
    let nodes: Vec<DVec3> =
        lattice(cell, order).iter().map(|at| DVec3::from(at.map(|x| f64::from(x) / p as f64))).collect();
    let modes = modes(cell, p);
    let vandermonde: Vec<Vec<f64>> =
        nodes.iter().map(|&x| modes.iter().map(|&mode| value(mode, chart(cell, x))).collect()).collect();
    let inverse = inverse(vandermonde);
    let gradients = |at: DVec3| -> Vec<DVec3> {
        let slopes: Vec<DVec3> = modes.iter().map(|&mode| slope(cell, mode, at)).collect();
        (0..nodes.len()).map(|n| slopes.iter().zip(&inverse).map(|(&s, row)| s * row[n]).sum()).collect()
    };
    samples(cell).into_iter().map(gradients).collect()
}

/// Exponents of the monomials that span the cell's polynomials in its chart.
fn modes(cell: Cell, p: usize) -> Vec<[usize; 3]> {
    let exponents = (0..=p).flat_map(|k| (0..=p).flat_map(move |j| (0..=p).map(move |i| [i, j, k])));
    exponents
        .filter(|&at| cell.holds(p, at))
        .map(|[i, j, k]| if cell == Cell::Pyramid { [i, j, p - k] } else { [i, j, k] })
        .collect()
}

/// The unit cell's own coordinates; `(x/s, y/s, s)` with `s = 1 - z` in a pyramid.
fn chart(cell: Cell, x: DVec3) -> DVec3 {
    let s = 1.0 - x.z;
    match cell {
        Cell::Pyramid if s > 0.0 => DVec3::new(x.x / s, x.y / s, s),
        Cell::Pyramid => DVec3::ZERO,
        _ => x,
    }
}

fn value(mode: [usize; 3], at: DVec3) -> f64 {
    (0..3).map(|axis| at[axis].powi(mode[axis] as i32)).product()
}

/// The gradient of a monomial in its chart; in a pyramid by `(s a, s b, -s)`, which leaves the Jacobian as it is.
fn slope(cell: Cell, mode: [usize; 3], at: DVec3) -> DVec3 {
    let by = |axis: usize| match mode[axis] {
        0 => 0.0,
        n => {
            let mut lower = mode;
            lower[axis] -= 1;
            n as f64 * value(lower, at)
        }
    };
    let slope = DVec3::new(by(0), by(1), by(2));
    if cell == Cell::Pyramid { DVec3::new(slope.x / at.z, slope.y / at.z, -slope.z) } else { slope }
}

/// Points of the chart; none at a pyramid's apex.
fn samples(cell: Cell) -> Vec<DVec3> {
    let n = DENSITY;
    let grid = (0..=n).flat_map(|k| (0..=n).flat_map(move |j| (0..=n).map(move |i| [i, j, k])));
    let inside = |at: &[usize; 3]| if cell == Cell::Pyramid { at[2] > 0 } else { cell.holds(n, *at) };
    grid.filter(inside).map(|at| DVec3::from(at.map(|x| x as f64 / n as f64))).collect()
}

/// The inverse of a square matrix, by Gauss-Jordan elimination with row pivots.
fn inverse(mut rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = rows.len();
    for (i, row) in rows.iter_mut().enumerate() {
        row.extend((0..n).map(|j| if i == j { 1.0 } else { 0.0 }));
    }
    for column in 0..n {
        let pivot = (column..n).max_by(|&a, &b| rows[a][column].abs().total_cmp(&rows[b][column].abs())).unwrap();
        rows.swap(column, pivot);
        let scale = rows[column][column].recip();
        rows[column].iter_mut().for_each(|x| *x *= scale);
        let own = rows[column].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|&(r, _)| r != column) {
            let factor = row[column];
            row.iter_mut().zip(&own).for_each(|(x, y)| *x -= factor * y);
        }
    }
    rows.into_iter().map(|row| row[n..].to_vec()).collect()
}
