//! Element shape: the weighted condition number, equations (3) to (5).

use glam::{DMat3, DVec3};

use crate::element::{Cell, Order, corner_simplices};

/// Which of the ways to cut an element into linear sub-elements is meant: an index into
/// [`crate::element::corner_simplices`].
pub type Cut = u8;

/// Shape cost of one corner, equations (3) and (5), for `T = A W^-1`:
/// `3 / (|T| |T^-1|) = 3 det T / (|T| |adj T|)` where `det T > 0`, else `det T`. In the plane (`flat`) `d = 2` stands in place of 3, and
/// `|adj T| = |T|`.
///
/// Range (-inf, 1]; 1 exactly where `A` is a rotated and scaled `W`. The paper's `J` of the inverted branch is taken
/// relative to the target, so that the value does not depend on the model's unit. Continuous at `det T = 0`.
#[must_use]
pub fn c_wcn(t: DMat3, flat: bool) -> f64 {
    let det = t.determinant();
    if det <= 0.0 {
        return det;
    }
    let Norms { first, second, dimension } = norms(t, cofactor(t), flat);
    let norm = (first * second).sqrt();
    if norm > 0.0 { dimension * det / norm } else { 0.0 }
}

/// What the condition number of a corner is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Norms {
    /// `|T|^2`.
    pub(crate) first: f64,
    /// `|adj T|^2`.
    pub(crate) second: f64,
    /// The condition number of the identity.
    pub(crate) dimension: f64,
}

/// The squared norms of `T` and of its adjugate; in the plane (`flat`) those of its first two columns.
pub(crate) fn norms(t: DMat3, cofactor: DMat3, flat: bool) -> Norms {
    if flat {
        let first = t.x_axis.length_squared() + t.y_axis.length_squared();
        return Norms { first, second: first, dimension: 2.0 };
    }
    Norms { first: squared(t), second: squared(cofactor), dimension: 3.0 }
}

/// [`c_wcn`] and its derivative by `T`; at `det T = 0`, where there are two, that of the inverted branch.
#[must_use]
pub fn c_wcn_slope(t: DMat3, flat: bool) -> (f64, DMat3) {
    let (det, cofactor) = (t.determinant(), cofactor(t));
    let Norms { first, second, dimension } = norms(t, cofactor, flat);
    if det <= 0.0 || first * second == 0.0 {
        return (det.min(0.0), cofactor);
    }
    let cost = dimension * det / (first * second).sqrt();
    // d|T|^2 = 2 T, d|cof T|^2 = 2 (|T|^2 T - T T^T T), d det = cof T.
    let bend = if flat { t * (1.0 / second) } else { (t * first - t * (t.transpose() * t)) * (1.0 / second) };
    (cost, (cofactor * (1.0 / det) - t * (1.0 / first) - bend) * cost)
}

/// Edge vectors of a corner simplex as columns: equation (4)'s matrix. A triangle, in the plane of x and y, has the unit vector along z
/// as its third.
#[must_use]
pub fn corner_frame(simplex: [u8; 4], points: &[DVec3]) -> DMat3 {
    let [o, u, v, w] = simplex.map(|n| points[usize::from(n)]);
    let up = if simplex[0] == simplex[3] { DVec3::Z } else { w - o };
    DMat3::from_cols(u - o, v - o, up)
}

/// `adj(T)` transposed: its columns are the cross products of `T`'s columns.
#[must_use]
pub(crate) fn cofactor(t: DMat3) -> DMat3 {
    let (a, b, c) = (t.x_axis, t.y_axis, t.z_axis);
    DMat3::from_cols(b.cross(c), c.cross(a), a.cross(b))
}

/// Squared Frobenius norm.
#[must_use]
pub(crate) fn squared(t: DMat3) -> f64 {
    t.x_axis.length_squared() + t.y_axis.length_squared() + t.z_axis.length_squared()
}

/// Smallest and mean `C_WCN` of an element's sub-elements, for the cut whose worst sub-element is best.
///
/// `points` are the element's nodes, `targets` the same nodes of the unperturbed mesh; a triangle's or quadrilateral's lie in the plane of x
/// and y.
#[must_use]
pub fn element_c_wcn(cell: Cell, order: Order, points: &[DVec3], targets: &[DVec3]) -> (f64, f64, Cut) {
    let mut best = (f64::NEG_INFINITY, 0.0, 0);
    let flat = cell.is_flat();
    for (cut, simplices) in corner_simplices(cell, order).iter().enumerate() {
        let (mut worst, mut sum) = (f64::INFINITY, 0.0);
        for &simplex in simplices {
            let cost = c_wcn(corner_frame(simplex, points) * corner_frame(simplex, targets).inverse(), flat);
            worst = worst.min(cost);
            sum += cost;
        }
        if worst > best.0 {
            best = (worst, sum / simplices.len() as f64, cut as Cut);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::lattice;
    use proptest::prelude::*;

    fn matrix() -> impl Strategy<Value = DMat3> {
        prop::array::uniform9(-1.0..1.0f64).prop_map(|m| DMat3::from_cols_array(&m) + DMat3::IDENTITY * 0.7)
    }

    proptest! {
        /// The second road: the paper's own form, `3 / (|A W^-1| |W A^-1|)`.
        #[test]
        fn agrees_with_the_form_by_inverses(a in matrix(), w in matrix()) {
            prop_assume!(a.determinant() * w.determinant() > 1e-2 && w.determinant().abs() > 1e-2);
            let by_inverse = 3.0 / (squared(a * w.inverse()) * squared(w * a.inverse())).sqrt();
            prop_assert!((c_wcn(a * w.inverse(), false) - by_inverse).abs() < 1e-9);
        }

        #[test]
        fn slopes_have_their_order(t in matrix(), d in matrix()) {
            let (value, slope) = c_wcn_slope(t, false);
            // Away from the kink at det T = 0, and from costs that turn within a step.
            prop_assume!(t.determinant().abs() > 0.1 && value.abs() > 0.1);
            prop_assert!((value - c_wcn(t, false)).abs() < 1e-12);
            let along: f64 = slope.to_cols_array().iter().zip(d.to_cols_array()).map(|(s, d)| s * d).sum();
            let remainder = |h: f64| (c_wcn(t + d * h, false) - value - h * along).abs();
            prop_assert!(remainder(1e-4) < 0.3 * remainder(2e-4) + 1e-12, "{} {}", remainder(1e-4), remainder(2e-4));
        }

        /// In the plane `C = 2 det T / |T|^2`, by the singular values `2 / (s/t + t/s)`.
        #[test]
        fn is_that_of_the_singular_values_in_the_plane(s in 0.1..2.0f64, t in 0.1..2.0f64, a in 0.0..6.0f64, b in 0.0..6.0f64, d in matrix()) {
            let stretch = DMat3::from_diagonal(DVec3::new(s, t, 1.0));
            let matrix = DMat3::from_rotation_z(a) * stretch * DMat3::from_rotation_z(b);
            let (value, slope) = c_wcn_slope(matrix, true);
            prop_assert!((value - 2.0 / (s / t + t / s)).abs() < 1e-12 && value == c_wcn(matrix, true));
            let d = DMat3::from_cols(d.x_axis.with_z(0.0), d.y_axis.with_z(0.0), DVec3::ZERO);
            let along: f64 = slope.to_cols_array().iter().zip(d.to_cols_array()).map(|(s, d)| s * d).sum();
            let remainder = |h: f64| (c_wcn(matrix + d * h, true) - value - h * along).abs();
            prop_assert!(remainder(1e-4) < 0.3 * remainder(2e-4) + 1e-12, "{} {}", remainder(1e-4), remainder(2e-4));
        }

        #[test]
        fn does_not_see_rotation_or_scale(w in matrix(), angle in 0.0..6.0f64, scale in 0.1..10.0f64) {
            prop_assume!(w.determinant().abs() > 1e-2);
            let turned = DMat3::from_rotation_y(angle) * w * scale;
            prop_assert!((c_wcn(turned * w.inverse(), false) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn an_unperturbed_element_costs_one() {
        for cell in Cell::CURVABLE {
            for order in Order::all() {
                let points: Vec<DVec3> = lattice(cell, order).iter().map(|n| DVec3::from(n.map(f64::from))).collect();
                let (worst, mean, _) = element_c_wcn(cell, order, &points, &points);
                assert!((worst - 1.0).abs() < 1e-12 && (mean - 1.0).abs() < 1e-12, "{cell} {order}");
            }
        }
    }

    #[test]
    fn an_inverted_corner_costs_its_relative_volume() {
        let mirrored = DMat3::from_diagonal(DVec3::new(2.0, 1.0, -1.0));
        assert_eq!(c_wcn(mirrored, false), -2.0);
        assert_eq!(c_wcn(DMat3::ZERO, false), 0.0);
    }
}
