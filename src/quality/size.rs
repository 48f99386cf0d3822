//! Element size and validity: the normalised Jacobian, equations (6) and (7).

use glam::{DMat3, DVec3};

use crate::element::Samples;

/// `det(dx/dxi)` at every sample point, equation (7); padding left out.
pub fn jacobians<'a>(samples: &'a Samples, points: &'a [DVec3]) -> impl Iterator<Item = f64> + 'a {
    (0..samples.count()).map(|s| {
        let mut columns = [DVec3::ZERO; 3];
        for (node, &x) in points.iter().enumerate() {
            let slopes = samples.gradient(node);
            for (axis, column) in columns.iter_mut().enumerate() {
                *column += x * slopes[axis][s];
            }
        }
        DMat3::from_cols(columns[0], columns[1], columns[2]).determinant()
    })
}

/// Smallest `C_JAC = min(1, J_p / J_c)` of an element, equation (6).
///
/// `curved` and `linear` are tables of the same points for the element's order and for order 1; `corners` are the
/// unperturbed corners.
#[must_use]
pub fn element_c_jac(curved: &Samples, points: &[DVec3], linear: &Samples, corners: &[DVec3]) -> f64 {
    jacobians(curved, points).zip(jacobians(linear, corners)).map(|(jp, jc)| (jp / jc).min(1.0)).fold(1.0, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::element::{Cell, Order, lattice};

    #[test]
    fn stretching_an_element_scales_its_jacobian() {
        for cell in Cell::VOLUME {
            for order in Order::all() {
                let stretch = DVec3::new(1.0, 0.5, 1.2);
                let unit = |n: &[u8; 3], p: usize| DVec3::from(n.map(|x| f64::from(x) / p as f64));
                let points: Vec<DVec3> = lattice(cell, order).iter().map(|n| unit(n, order.get()) * stretch).collect();
                let corners: Vec<DVec3> = lattice(cell, Order::LINEAR).iter().map(|n| unit(n, 1)).collect();
                let (curved, linear) = (Samples::survey(cell, order, 5), Samples::survey(cell, Order::LINEAR, 5));
                let cost = element_c_jac(&curved, &points, &linear, &corners);
                assert!((cost - 0.6).abs() < 1e-11, "{cell} {order}: {cost}");
            }
        }
    }
}
