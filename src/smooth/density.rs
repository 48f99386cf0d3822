//! What one sample of an element contributes to the objective, with first and second derivatives.
//!
//! Along one node every quantity of a sample is simple (`docs/theory.md`, section 3): moving it by `d` changes
//! `T = A W^-1` to `T + d g^T`, so that `|T|^2` and `|adj T|^2` are quadratic in `d` and `det T` is affine. A node's
//! gradient and exact 3x3 Hessian therefore cost little more than the value. In the plane (`flat`) `|adj T| = |T|`, and `T` is the unit
//! matrix along z.
//!
//! Shape: `t = 1/C_WCN^2 - 1`; Jacobian: `t = (1/r - 1)^2`, `r = min(1, J/J_c)`. Either enters as `t + w t^2`: the
//! emphasis `w` makes the worst samples count (measured on the weeble: min C_WCN / C_JAC 0.84 / 0.70 at `w = 0`,
//! 0.93 / 0.76 at `w = 100`). While elements are inverted the determinant is regularised,
//! `chi(l) = (l + sqrt(l^2 + 4 delta^2)) / 2`, scaled to `chi(1) = 1`, which keeps the objective finite and pulls towards
//! validity.

use glam::{DMat3, DVec3};

use crate::quality::{Norms, cofactor, norms, squared};

/// How samples are weighed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Density {
    /// `w`: how much the worst samples count.
    pub(super) emphasis: f64,
    /// `delta`: regularisation of determinants relative to their targets; 0 makes inversion infinitely costly.
    pub(super) delta: f64,
}

/// A function of one variable and its first two derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) slope: f64,
    pub(super) curvature: f64,
}

/// A shape sample's value and what its nodes' derivatives are made of; `FLAT` in the plane.
///
/// `FLAT` is known when this is compiled: with a branch in [`ShapeSample::hessian`] rustc 1.95 at `-O3` gives the block's yz entry a wrong
/// value wherever it inlines all of it (see `make same-bits`).
pub(super) struct ShapeSample<const FLAT: bool> {
    pub(super) value: f64,
    /// Derivative of the value by `T`.
    pub(super) stress: DMat3,
    t: DMat3,
    cofactor: DMat3,
    norms: [f64; 2],
    chi: Jet,
    ratio: f64,
    emphasis: Jet,
}

impl Density {
    /// `chi(l)`; minus infinity's neighbour zero where `delta` is zero and `l <= 0`.
    fn chi(&self, l: f64) -> Jet {
        if self.delta == 0.0 {
            return Jet { value: l.max(0.0), slope: 1.0, curvature: 0.0 };
        }
        let root = (l * l + 4.0 * self.delta * self.delta).sqrt();
        // For l << 0 the sum cancels; its conjugate does not.
        let value = if l >= 0.0 { 0.5 * (l + root) } else { 2.0 * self.delta * self.delta / (root - l) };
        let one = 2.0 / (1.0 + (1.0 + 4.0 * self.delta * self.delta).sqrt());
        let curvature = 2.0 * self.delta * self.delta / (root * root * root);
        Jet { value: one * value, slope: one * value / root, curvature: one * curvature }
    }

    /// `t + w t^2`; below zero, where regularisation can take it, `t` alone.
    fn emphasised(&self, t: f64) -> Jet {
        let w = if t > 0.0 { self.emphasis } else { 0.0 };
        Jet { value: t + w * t * t, slope: 1.0 + 2.0 * w * t, curvature: 2.0 * w }
    }

    /// The Jacobian term of a sample with `l = J / J_c`.
    pub(super) fn jacobian(&self, l: f64) -> Jet {
        let chi = self.chi(l);
        if chi.value >= 1.0 {
            return Jet::default();
        }
        if chi.value <= 0.0 {
            return Jet { value: f64::INFINITY, slope: 0.0, curvature: 0.0 };
        }
        let inverse = 1.0 / chi.value;
        let gap = inverse - 1.0;
        let (first, second) = (-inverse * inverse, 2.0 * inverse * inverse * inverse);
        let t = Jet { value: gap * gap, slope: 2.0 * gap * first, curvature: 2.0 * (first * first + gap * second) };
        let outer = self.emphasised(t.value);
        let in_chi = outer.of(t);
        in_chi.of(chi)
    }

    /// The shape term of a corner simplex with `T = A W^-1`: value only.
    pub(super) fn shape_value(&self, t: DMat3, flat: bool) -> f64 {
        let chi = self.chi(t.determinant()).value;
        if chi <= 0.0 {
            return f64::INFINITY;
        }
        let Norms { first, second, dimension } = norms(t, cofactor(t), flat);
        self.emphasised(first * second / (dimension * dimension * chi * chi) - 1.0).value
    }

    /// The shape term of a corner simplex, with derivatives.
    pub(super) fn shape<const FLAT: bool>(&self, t: DMat3) -> ShapeSample<FLAT> {
        let cofactor = cofactor(t);
        let Norms { first, second, dimension } = norms(t, cofactor, FLAT);
        let norms = [first, second];
        let chi = self.chi(t.x_axis.dot(cofactor.x_axis));
        let ratio = norms[0] * norms[1] / (dimension * dimension * chi.value * chi.value);
        let emphasis = self.emphasised(ratio - 1.0);
        // d|T|^2 = 2 T, d|cof T|^2 = 2 (|T|^2 T - T T^T T), d det = cof T.
        let first = t * (2.0 / norms[0]);
        let second = if FLAT { first } else { (t * norms[0] - t * (t.transpose() * t)) * (2.0 / norms[1]) };
        let log = first + second - cofactor * (2.0 * chi.slope / chi.value);
        let value = if chi.value > 0.0 { emphasis.value } else { f64::INFINITY };
        ShapeSample { value, stress: log * (ratio * emphasis.slope), t, cofactor, norms, chi, ratio, emphasis }
    }
}

impl Jet {
    /// The chain rule: `self` is a jet at the inner function's value.
    fn of(self, inner: Jet) -> Jet {
        Jet {
            value: self.value,
            slope: self.slope * inner.slope,
            curvature: self.curvature * inner.slope * inner.slope + self.slope * inner.curvature,
        }
    }
}

impl<const FLAT: bool> ShapeSample<FLAT> {
    /// Hessian by the position of the node whose hat function has the gradient `g` in the target.
    ///
    /// `|adj T|^2` has the Hessian `2 (|H|^2 I - H H^T)`, `H = T [g]x`.
    pub(super) fn hessian(&self, g: DVec3) -> DMat3 {
        let [q1, _] = self.norms;
        let first = DMat3::from_diagonal(DVec3::splat(2.0 * g.length_squared() / q1));
        let u = self.t * g * (2.0 / q1);
        let (second, v) = if FLAT { (first, u) } else { self.of_adjugate(g) };
        let c = self.cofactor * g;
        let w = c * (self.chi.slope / self.chi.value);
        let log = u + v - 2.0 * w;
        let bend = outer(c, c) * (2.0 * self.chi.curvature / self.chi.value);
        let log_hessian = first - outer(u, u) + second - outer(v, v) + outer(w, w) * 2.0 - bend;
        let own = (outer(log, log) + log_hessian) * self.ratio;
        let gradient = log * self.ratio;
        own * self.emphasis.slope + outer(gradient, gradient) * self.emphasis.curvature
    }

    /// The Hessian of `|adj T|^2` over it, and its gradient over it.
    fn of_adjugate(&self, g: DVec3) -> (DMat3, DVec3) {
        let q2 = self.norms[1];
        let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| self.t * g.cross(axis));
        let h = DMat3::from_cols(columns[0], columns[1], columns[2]);
        let second = (DMat3::from_diagonal(DVec3::splat(squared(h))) - h * h.transpose()) * (2.0 / q2);
        let v = (self.t * self.norms[0] - self.t * (self.t.transpose() * self.t)) * g * (2.0 / q2);
        (second, v)
    }
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DENSITIES: [Density; 3] = [
        Density { emphasis: 0.0, delta: 0.0 },
        Density { emphasis: 20.0, delta: 0.0 },
        Density { emphasis: 3.0, delta: 0.2 },
    ];

    /// `|f(h) - f - h f'| ~ h^2` and `|f(h) - f - h f' - h^2 f''/2| ~ h^3`.
    fn check_rates(f: impl Fn(f64) -> f64, slope: f64, curvature: f64, what: &str) {
        let remainder = |h: f64, with: f64| (f(h) - f(0.0) - h * slope - with * 0.5 * h * h * curvature).abs();
        let rate = |with: f64| (remainder(2e-3, with) / remainder(1e-3, with)).log2();
        assert!((rate(0.0) - 2.0).abs() < 0.1, "{what}: gradient h^{:.2}", rate(0.0));
        assert!((rate(1.0) - 3.0).abs() < 0.15, "{what}: hessian h^{:.2}", rate(1.0));
    }

    #[test]
    fn jacobian_derivatives_have_their_order() {
        for density in DENSITIES {
            for l in [0.3, 0.7, -0.4] {
                if l < 0.0 && density.delta == 0.0 {
                    assert_eq!(density.jacobian(l).value, f64::INFINITY);
                    continue;
                }
                let jet = density.jacobian(l);
                check_rates(
                    |h| density.jacobian(l + h).value,
                    jet.slope,
                    jet.curvature,
                    &format!("{density:?} at {l}"),
                );
            }
        }
    }

    #[test]
    fn shape_derivatives_have_their_order() {
        let upright = DMat3::from_cols_array(&[1.1, 0.2, -0.1, 0.3, 0.8, 0.2, -0.2, 0.1, 0.9]);
        let inverted = DMat3::from_cols_array(&[1.1, 0.2, -0.1, 0.3, 0.8, 0.2, -0.2, 0.1, -0.4]);
        let plane = |m: [f64; 4]| DMat3::from_cols_array(&[m[0], m[1], 0.0, m[2], m[3], 0.0, 0.0, 0.0, 1.0]);
        let matrices = [
            (upright, false),
            (inverted, false),
            (plane([1.1, 0.2, 0.3, 0.8]), true),
            (plane([1.1, 0.2, 0.3, -0.8]), true),
        ];
        for density in DENSITIES {
            for (t, flat) in matrices {
                let in_plane = |v: DVec3| if flat { v.with_z(0.0) } else { v };
                let (g, d) = (in_plane(DVec3::new(0.4, -0.3, 0.8)), in_plane(DVec3::new(-0.5, 0.9, 0.3)));
                if t.determinant() < 0.0 && density.delta == 0.0 {
                    assert_eq!(density.shape_value(t, flat), f64::INFINITY);
                    continue;
                }
                let (value, stress, hessian) = if flat {
                    let sample = density.shape::<true>(t);
                    (sample.value, sample.stress, sample.hessian(g))
                } else {
                    let sample = density.shape::<false>(t);
                    (sample.value, sample.stress, sample.hessian(g))
                };
                assert!((value - density.shape_value(t, flat)).abs() < 1e-9 * value.abs().max(1.0));
                let f = |h: f64| density.shape_value(t + outer(d * h, g), flat);
                check_rates(f, (stress * g).dot(d), (hessian * d).dot(d), &format!("{density:?}"));
            }
        }
    }

    #[test]
    fn the_ideal_costs_nothing() {
        for density in &DENSITIES[..2] {
            assert_eq!(density.jacobian(1.0), Jet::default());
            assert_eq!(density.jacobian(1.7), Jet::default());
            assert!([false, true].iter().all(|&flat| density.shape_value(DMat3::IDENTITY, flat).abs() < 1e-14));
        }
    }
}
