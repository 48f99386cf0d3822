//! Blends of the two components, equations (2) and (8).

use crate::element::Order;

/// The default weight of shape in equation (2): `(p - 1) / p`.
#[must_use]
pub fn alpha(order: Order) -> f64 {
    (order.get() as f64 - 1.0) / order.get() as f64
}

/// Equation (2): `C = alpha C_WCN + (1 - alpha) C_JAC`.
#[must_use]
pub fn blend(alpha: f64, c_wcn: f64, c_jac: f64) -> f64 {
    alpha * c_wcn + (1.0 - alpha) * c_jac
}

/// Equation (8), the cost of a node from the worst and the mean cost around it: `C = beta C_w + (1 - beta) C_avg`,
/// `beta = 1 - C_w`.
///
/// For `C_w <= 0` the cost is `C_w` itself: as printed, the equation there rewards making the other cells worse
/// (`docs/theory.md`, section 1).
#[must_use]
pub fn nodal(worst: f64, mean: f64) -> f64 {
    if worst <= 0.0 {
        return worst;
    }
    let beta = 1.0 - worst;
    beta * worst + (1.0 - beta) * mean
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_rules_where_it_is_inverted() {
        assert_eq!(nodal(-10.0, 0.9), -10.0);
        assert_eq!(nodal(0.0, 0.9), 0.0);
        assert_eq!(nodal(1.0, 1.0), 1.0);
        assert!((nodal(0.5, 0.9) - 0.7).abs() < 1e-15);
    }

    #[test]
    fn alpha_is_the_papers() {
        assert_eq!(Order::all().map(alpha).collect::<Vec<_>>(), [0.0, 0.5, 2.0 / 3.0, 0.75]);
        assert_eq!(blend(0.75, 0.8, 0.4), 0.75 * 0.8 + 0.25 * 0.4);
    }
}
