//! 3x3 blocks of the Hessian: inverted within the directions in which a node may move.

use glam::{DMat3, DVec3};

use super::Freedom;

/// The inverse of a node's Hessian block with every eigenvalue made positive, on the node's free directions.
///
/// The absolute value of an eigenvalue keeps the step's length where the objective is concave; `floor`, relative to
/// the largest eigenvalue, bounds it where the objective is flat.
pub(super) fn positive_inverse(hessian: DMat3, freedom: Freedom, floor: f64) -> DMat3 {
    match freedom {
        Freedom::Fixed => DMat3::ZERO,
        Freedom::Line(t) => {
            let curvature = (hessian * t).dot(t).abs();
            if curvature > 0.0 { outer(t) * (1.0 / curvature) } else { DMat3::ZERO }
        }
        Freedom::Plane(normal) => {
            let (u, v) = normal.any_orthonormal_pair();
            plane_inverse(hessian, u, v, floor)
        }
        Freedom::Space => spectral_inverse(hessian, floor),
    }
}

/// `sum_i v_i v_i^T / |lambda_i|`, eigenvalues below `floor` times the largest left out where they are rounding.
fn spectral_inverse(symmetric: DMat3, floor: f64) -> DMat3 {
    let (values, vectors) = eigen(symmetric);
    let largest = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut inverse = DMat3::ZERO;
    for (value, vector) in values.into_iter().zip(vectors) {
        if value.abs() > floor * largest {
            inverse += outer(vector) * (1.0 / value.abs());
        }
    }
    inverse
}

/// The same within the plane of two orthonormal vectors.
fn plane_inverse(hessian: DMat3, u: DVec3, v: DVec3, floor: f64) -> DMat3 {
    let (a, b, c) = ((hessian * u).dot(u), (hessian * u).dot(v), (hessian * v).dot(v));
    let turn = 0.5 * (2.0 * b).atan2(a - c);
    let (sin, cos) = turn.sin_cos();
    let axes = [u * cos + v * sin, v * cos - u * sin];
    let values = axes.map(|axis| (hessian * axis).dot(axis).abs());
    let largest = values[0].max(values[1]);
    let keep = axes.into_iter().zip(values).filter(|&(_, value)| value > floor * largest);
    keep.map(|(axis, value)| outer(axis) * (1.0 / value)).sum()
}

/// Eigenvalues and unit eigenvectors of a symmetric matrix, by Jacobi rotations.
fn eigen(symmetric: DMat3) -> ([f64; 3], [DVec3; 3]) {
    let mut a = symmetric.to_cols_array_2d();
    let mut v = DMat3::IDENTITY.to_cols_array_2d(); // v[i] is the i-th vector
    for _ in 0..12 {
        let off = a[0][1].abs() + a[0][2].abs() + a[1][2].abs();
        if off <= f64::EPSILON * 1e-3 * (a[0][0].abs() + a[1][1].abs() + a[2][2].abs()) {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] != 0.0 {
                rotate(&mut a, &mut v, p, q);
            }
        }
    }
    ([a[0][0], a[1][1], a[2][2]], v.map(DVec3::from))
}

/// One Jacobi rotation that makes `a[p][q]` zero.
fn rotate(a: &mut [[f64; 3]; 3], v: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let t = if theta == 0.0 { 1.0 } else { t };
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for k in 0..3 {
        let (x, y) = (a[k][p], a[k][q]);
        (a[k][p], a[k][q]) = (c * x - s * y, s * x + c * y);
    }
    for k in 0..3 {
        let (x, y) = (a[p][k], a[q][k]);
        (a[p][k], a[q][k]) = (c * x - s * y, s * x + c * y);
        let (x, y) = (v[p][k], v[q][k]);
        (v[p][k], v[q][k]) = (c * x - s * y, s * x + c * y);
    }
}

fn outer(a: DVec3) -> DMat3 {
    DMat3::from_cols(a * a.x, a * a.y, a * a.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layered(angle: f64) -> DMat3 {
        let turn = DMat3::from_rotation_x(angle) * DMat3::from_rotation_z(0.3 * angle);
        turn * DMat3::from_diagonal(DVec3::new(1.0, 3.0, 2.5e7)) * turn.transpose()
    }

    #[test]
    fn inverts_a_layers_block() {
        for angle in [0.0, 0.7, 1.9, 2.5] {
            let h = layered(angle);
            let identity = positive_inverse(h, Freedom::Space, 1e-14) * h;
            assert!((identity - DMat3::IDENTITY).to_cols_array().iter().all(|x| x.abs() < 1e-8), "{identity}");
        }
    }

    #[test]
    fn a_concave_direction_keeps_the_length_of_its_step() {
        let h = DMat3::from_diagonal(DVec3::new(-2.0, 4.0, 1.0));
        let step = positive_inverse(h, Freedom::Space, 1e-14) * DVec3::new(2.0, 4.0, 1.0);
        assert!(step.distance(DVec3::ONE) < 1e-14);
    }

    #[test]
    fn steps_stay_in_the_free_directions() {
        let (h, g) = (layered(1.1), DVec3::new(0.3, -0.5, 0.8));
        let normal = DVec3::new(1.0, 2.0, 2.0) / 3.0;
        let tangent = normal.any_orthonormal_vector();
        assert_eq!(positive_inverse(h, Freedom::Fixed, 1e-14) * g, DVec3::ZERO);
        let slide = positive_inverse(h, Freedom::Plane(normal), 1e-14) * g;
        assert!(slide.dot(normal).abs() < 1e-12 * slide.length());
        let along = positive_inverse(h, Freedom::Line(tangent), 1e-14) * g;
        assert!(along.cross(tangent).length() < 1e-12 * along.length().max(1.0));
    }
}
