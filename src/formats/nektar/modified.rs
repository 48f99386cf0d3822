//! What Nektar++ makes of an element of which it is given the edges, or the faces.
//!
//! Its geometry is a sum of the functions of its "modified" basis (Karniadakis and Sherwin, Spectral/hp Element Methods for CFD, section
//! 3.2): functions of corners, edges, faces and the inside. What a file does not give has the coefficient zero. In cells whose space of
//! polynomials is that of this program, all but the pyramid beyond P2, the nodes inside then follow from those of the boundary.

use crate::element::{Cell, Order, Tables, basis, interior_start, lattice};

/// Weights of an element's boundary nodes at each of its inner nodes: row-major, `[inner][boundary]`, both in internal order.
pub(super) fn interior(cell: Cell, order: Order) -> &'static [f64] {
    static TABLES: Tables<Vec<f64>> = Tables::new();
    TABLES.get(cell, order, || {
        let boundary = interior_start(cell, order);
        let nodes = lattice(cell, order);
        let at = |node: &[u8; 3]| functions(cell, order.get(), node.map(|x| f64::from(x) / order.get() as f64));
        let on: Vec<f64> = nodes[..boundary].iter().flat_map(at).collect();
        let inverse = basis::inverse(on);
        let row = |values: Vec<f64>| {
            let inverse = &inverse;
            let weight =
                move |n: usize| values.iter().enumerate().map(|(m, v)| v * inverse[m * boundary + n]).sum::<f64>();
            (0..boundary).map(weight).collect::<Vec<f64>>()
        };
        nodes[boundary..].iter().map(at).flat_map(row).collect()
    })
}

/// The functions of corners, edges and faces at a point of the unit cell.
fn functions(cell: Cell, p: usize, [x, y, z]: [f64; 3]) -> Vec<f64> {
    match cell {
        Cell::Triangle => {
            let (on, _) = triangle(p, x, y);
            on
        }
        Cell::Quad => square(p, x, y).0,
        Cell::Tet => tet(p, [x, y, z]),
        Cell::Prism => {
            // Nektar++ collapses the corner that lies along the first axis here.
            let (on, inside) = triangle(p, y, x);
            let line = line(p, z);
            let all = on.iter().flat_map(|f| line.iter().map(move |g| f * g));
            all.chain(inside.iter().flat_map(|f| line[..2].iter().map(move |g| f * g))).collect()
        }
        Cell::Hex => {
            let (on, inside) = square(p, x, y);
            let line = line(p, z);
            let all = on.iter().flat_map(|f| line.iter().map(move |g| f * g));
            all.chain(inside.iter().flat_map(|f| line[..2].iter().map(move |g| f * g))).collect()
        }
        Cell::Point | Cell::Line | Cell::Pyramid => Vec::new(),
    }
}

/// Jacobi's polynomial of a degree at a point of [-1, 1].
fn jacobi(degree: usize, alpha: f64, beta: f64, z: f64) -> f64 {
    let (mut before, mut own) = (0.0, 1.0);
    for n in 0..degree {
        let k = n as f64;
        let next = if n == 0 {
            0.5 * (alpha - beta + (alpha + beta + 2.0) * z)
        } else {
            let s = 2.0 * k + alpha + beta;
            let a = 2.0 * (k + 1.0) * (k + alpha + beta + 1.0) * s;
            let b = (s + 1.0) * (s * (s + 2.0) * z + alpha * alpha - beta * beta);
            let c = 2.0 * (k + alpha) * (k + beta) * (s + 2.0);
            (b * own - c * before) / a
        };
        (before, own) = (own, next);
    }
    own
}

/// The function of an edge, of degree `m`, at a point of the unit interval.
fn bubble(m: usize, t: f64) -> f64 {
    t * (1.0 - t) * jacobi(m - 2, 1.0, 1.0, 2.0 * t - 1.0)
}

/// The functions of a line: its ends, its inside.
fn line(p: usize, t: f64) -> Vec<f64> {
    [1.0 - t, t].into_iter().chain((2..=p).map(|m| bubble(m, t))).collect()
}

/// The functions of a square, on its rim and inside.
fn square(p: usize, x: f64, y: f64) -> (Vec<f64>, Vec<f64>) {
    let (a, b) = (line(p, x), line(p, y));
    let (mut on, mut inside) = (Vec::new(), Vec::new());
    for (m, f) in a.iter().enumerate() {
        for (n, g) in b.iter().enumerate() {
            if m < 2 || n < 2 { &mut on } else { &mut inside }.push(f * g);
        }
    }
    (on, inside)
}

/// A fraction of what the last axis leaves; where it leaves nothing any will do.
fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// The functions of one more axis, of degree `q`, above a function of degree `m`: they fall with `(1 - t)^m` towards the collapsed corner.
fn above(m: usize, q: usize, t: f64) -> f64 {
    let fall = (1.0 - t).powi(m as i32);
    if q == 0 { fall } else { fall * t * jacobi(q - 1, 2.0 * m as f64 - 1.0, 1.0, 2.0 * t - 1.0) }
}

/// The functions of a triangle that is collapsed at (0, 1), on its rim and inside.
fn triangle(p: usize, x: f64, y: f64) -> (Vec<f64>, Vec<f64>) {
    let s = share(x, 1.0 - y);
    let mut on = vec![(1.0 - s) * (1.0 - y), s * (1.0 - y), y];
    let mut inside = Vec::new();
    for m in 2..=p {
        on.extend([bubble(m, s) * above(m, 0, y), s * bubble(m, y), (1.0 - s) * bubble(m, y)]);
        inside.extend((1..=p - m).map(|q| bubble(m, s) * above(m, q, y)));
    }
    (on, inside)
}

/// The functions of a tet's corners, edges and faces.
fn tet(p: usize, [x, y, z]: [f64; 3]) -> Vec<f64> {
    let (s, t) = (share(x, 1.0 - y - z), share(y, 1.0 - z));
    let mut on = vec![(1.0 - s) * (1.0 - t) * (1.0 - z), s * (1.0 - t) * (1.0 - z), t * (1.0 - z), z];
    for m in 2..=p {
        on.push(bubble(m, s) * above(m, 0, t) * above(m, 0, z));
        on.extend([s, 1.0 - s].map(|side| side * bubble(m, t) * above(m, 0, z)));
        on.extend([(1.0 - s) * (1.0 - t), s * (1.0 - t), t].map(|corner| corner * bubble(m, z)));
        for q in 1..=p - m {
            on.push(bubble(m, s) * above(m, q, t) * above(m + q, 0, z));
            on.push(bubble(m, s) * above(m, 0, t) * above(m, q, z));
            on.extend([s, 1.0 - s].map(|side| side * bubble(m, t) * above(m, q, z)));
        }
    }
    on
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function that the boundary's functions make up is continued as itself; linear ones are such.
    #[test]
    fn linear_functions_are_continued_as_themselves() {
        for cell in [Cell::Triangle, Cell::Quad, Cell::Tet, Cell::Prism, Cell::Hex] {
            for order in Order::all() {
                let boundary = interior_start(cell, order);
                let nodes = lattice(cell, order);
                let value = |at: &[u8; 3]| 1.0 + 2.0 * f64::from(at[0]) - 3.0 * f64::from(at[1]) + f64::from(at[2]);
                let rows = interior(cell, order).chunks_exact(boundary);
                assert_eq!(rows.len(), nodes.len() - boundary, "{cell} {order}");
                for (row, at) in rows.zip(&nodes[boundary..]) {
                    let made: f64 = row.iter().zip(nodes).map(|(w, at)| w * value(at)).sum();
                    assert!((made - value(at)).abs() < 1e-11, "{cell} {order}: {made} for {}", value(at));
                }
            }
        }
    }

    /// In a hex that is the blend of its faces (Gordon and Hall), which has a formula of its own.
    #[test]
    fn a_hex_is_the_blend_of_its_faces() {
        let order = Order::MAX;
        let p = order.get();
        let value = |[x, y, z]: [f64; 3]| (3.0 * x + y * y).sin() + (2.0 * z * x).cos() + x * y * z * z;
        let nodes = lattice(Cell::Hex, order);
        let unit = |at: &[u8; 3]| at.map(|i| f64::from(i) / p as f64);
        let boundary = interior_start(Cell::Hex, order);
        // All ways to put some axes at their ends, with the sign of inclusion and exclusion.
        let blended = |at: [f64; 3]| -> f64 {
            let mut sum = 0.0;
            for some in 1..8usize {
                let axes: Vec<usize> = (0..3).filter(|axis| some >> axis & 1 == 1).collect();
                let sign = if axes.len() % 2 == 1 { 1.0 } else { -1.0 };
                for ends in 0..1usize << axes.len() {
                    let (mut moved, mut weight) = (at, sign);
                    for (n, &axis) in axes.iter().enumerate() {
                        let end = (ends >> n & 1) as f64;
                        moved[axis] = end;
                        weight *= if end == 1.0 { at[axis] } else { 1.0 - at[axis] };
                    }
                    sum += weight * value(moved);
                }
            }
            sum
        };
        for (row, at) in interior(Cell::Hex, order).chunks_exact(boundary).zip(&nodes[boundary..]) {
            let made: f64 = row.iter().zip(nodes).map(|(w, at)| w * value(unit(at))).sum();
            assert!((made - blended(unit(at))).abs() < 1e-11, "{at:?}");
        }
    }
}
