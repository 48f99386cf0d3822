//! How far rounding can have moved the computed Bernstein coefficients: a proven bound, the same scheme for all cells.
//! Every constant is derived in `docs/theory.md`, section 9.
//!
//! Write `gamma_n = n r / (1 - n r)` for `n` operations of relative error `r` (`Real::ROUNDOFF`), `|.|` and `<=` by
//! components, `perm` for the permanent of three columns.
//!
//! 1. Nodes are shifted by the first corner, `y = fl(x - x_0)`, with relative error `<= u` (none in pairs of `f64`),
//!    and scaled by a power of two, exactly.
//! 2. A scaled column coefficient is `sum M y` with integer `M` (exact in `f64`) of at most `N` terms: `N` products and
//!    sums and the shift give `|err| <= (gamma_N + u) sum |M| |y|`. Unscaled: `eps = (gamma_N + u) R max |y|`, where `R`
//!    is the largest `sum |M| / weight` of a row.
//! 3. A coefficient of the determinant is a mean, with positive weights that sum to 1, of determinants of unscaled
//!    column coefficients (`docs/theory.md`, section 7). With `a_k` the largest components of column `k`, computed,
//!    - wrong columns move it by at most `perm(a + eps) - perm(a)`, summed here as
//!      `perm(eps_1, a_2 + eps_2, a_3 + eps_3) + perm(a_1, eps_2, a_3 + eps_3) + perm(a_1, a_2, eps_3)`;
//!    - its own evaluation moves it by at most `gamma_K perm(a + eps)`: cross product (1 product, 1 difference, one sum a
//!      pair), dot product (1 product, 2 sums, one sum a pair), division and rounding to `f64`, 4 more than
//!      the pairs; `K = pairs_cross + pairs_dot + 7`. In pairs of `f64` the last two cost `3 u |coefficient|` more.
//!
//! The bounds are sums of positive terms, evaluated in `f64` and enlarged by 1 % for their own rounding; [`UNDERFLOW`]
//! covers products that are too small for a normal `f64`.

use super::real::{Real, UNIT};
use crate::element::Order;

/// More than all underflows in one coefficient can add up to, the coordinates being scaled to size 1: fewer than `1e8`
/// products, each off by at most `2^-1074`, times factors below `1e23`; ten times that in pairs of `f64`.
const UNDERFLOW: f64 = 1e-290;

/// Covers the rounding of a sum of positive terms.
const ENLARGED: f64 = 1.01;

/// Constants of the bound for one cell and order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    /// By column: terms in the longest row, and `R`.
    columns: [(usize, f64); 3],
    /// `K`.
    operations: usize,
}

// The constants below and in form.rs, judge.rs and straight.rs were derived for these orders: integers exact in `f64`, products and
// sums of so many terms, coefficients numbered by `u16`. For a higher one go through section 9 of docs/theory.md first.
const _: () = assert!(Order::MAX.get() <= 4, "the rounding bound is derived for orders up to 4");

impl Growth {
    pub(super) fn new(columns: [(usize, f64); 3], cross: usize, dot: usize) -> Growth {
        Growth { columns, operations: cross + dot + 7 }
    }

    /// Bound of the error of every coefficient, from the largest components of the nodes and of the columns, the
    /// largest coefficient, and a distance by which each node may be off (0 for nodes as they stand).
    pub(super) fn bound<T: Real>(
        &self,
        nodes: [f64; 3],
        columns: [[f64; 3]; 3],
        coefficient: f64,
        off: [f64; 3],
    ) -> f64 {
        if (0..3).any(|axis| nodes[axis] == 0.0 && off[axis] == 0.0) {
            return 0.0; // all nodes in one coordinate plane: every product has an exact zero
        }
        let eps: [[f64; 3]; 3] = std::array::from_fn(|k| {
            let (terms, sum) = self.columns[k];
            let relative = gamma(terms, T::ROUNDOFF) + T::SHIFT_ROUNDOFF;
            std::array::from_fn(|axis| ENLARGED * sum * (relative * nodes[axis] + off[axis]))
        });
        let a = columns;
        let moved: [[f64; 3]; 3] = std::array::from_fn(|k| std::array::from_fn(|axis| a[k][axis] + eps[k][axis]));
        let columns_off =
            permanent(eps[0], moved[1], moved[2]) + permanent(a[0], eps[1], moved[2]) + permanent(a[0], a[1], eps[2]);
        let evaluation = gamma(self.operations, T::ROUNDOFF) * permanent(moved[0], moved[1], moved[2]);
        ENLARGED * (columns_off + evaluation + 3.0 * UNIT * coefficient) + UNDERFLOW
    }
}

/// `n r / (1 - n r)`.
fn gamma(n: usize, roundoff: f64) -> f64 {
    let x = n as f64 * roundoff;
    x / (1.0 - x)
}

/// `sum |x_i| |y_j| |z_k|` over the permutations.
fn permanent(x: [f64; 3], y: [f64; 3], z: [f64; 3]) -> f64 {
    x[0] * (y[1] * z[2] + y[2] * z[1]) + x[1] * (y[2] * z[0] + y[0] * z[2]) + x[2] * (y[0] * z[1] + y[1] * z[0])
}
