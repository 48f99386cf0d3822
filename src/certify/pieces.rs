//! Pieces of a subdivided cell: storage, halving, and the bounds that their nets give.

use super::form::{Bundle, Direction, Form, LANES};
use super::real::UNIT;
use crate::element::Order;

/// Longest line of any net, of degree `3 p - 1`: along each axis the three derivatives have degrees `p`, `p` and `p - 1` at most.
/// A longer one would be cut, and nothing proven of what is cut off; a test goes through all forms.
pub(super) const LINE: usize = 3 * Order::MAX.get();

/// What `J` is compared with.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reference {
    /// A constant: `J_c` of a tet, or 1 where only `J` matters.
    Constant(f64),
    /// Each piece's second net holds `J_c`.
    Net,
}

impl Reference {
    /// The value to compare with, given the second net's.
    pub(super) fn at(self, c: Option<f64>) -> f64 {
        match self {
            Reference::Constant(c) => c,
            Reference::Net => c.unwrap_or(f64::NAN),
        }
    }
}

/// How far stored coefficients may be off, and how large they can be.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Accuracy {
    /// Error of a coefficient of the root.
    pub(super) error: f64,
    /// Largest coefficient of the root, error included; every coefficient of a piece is a mean of them.
    pub(super) largest: f64,
}

impl Accuracy {
    /// The error after as many halvings: each level of de Casteljau's scheme rounds once (halving is exact), so a
    /// halving adds at most `degree u` of the largest coefficient; 1 % covers second-order terms.
    pub(super) fn after(self, halvings: usize, degree: usize) -> f64 {
        self.error + 1.01 * (halvings * degree) as f64 * UNIT * self.largest
    }
}

/// What a net says of its piece. Errors are included: `lower` bounds are below, attained values above the truth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    /// Lower bound of `J / J_c`.
    pub(super) lower: f64,
    /// Bounds of `J`.
    pub(super) determinant: [f64; 2],
}

/// Bounds of one piece from its net (the second half of `net` is `J_c`'s where the reference is one).
pub(super) fn range(net: &[f64], size: usize, reference: Reference, errors: [f64; 2]) -> Range {
    let [error, reference_error] = errors;
    let (j, c) = net.split_at(size);
    let [low, high] = extremes(j);
    let lower = match reference {
        Reference::Constant(c) => quotient_below(low - error, c, reference_error),
        Reference::Net => {
            let [least, _] = extremes(c);
            if least > reference_error {
                // Where a numerator is negative, only such ones can give the minimum.
                let signed = if low >= error { reference_error } else { -reference_error };
                let quotients = j.iter().zip(c).map(|(&j, &c)| (j - error) / (c + signed));
                let lowest = quotients.fold(f64::INFINITY, |l, q| if q < l { q } else { l });
                lowest - 4.0 * UNIT * lowest.abs()
            } else {
                f64::NEG_INFINITY
            }
        }
    };
    Range { lower, determinant: [low - error, high + error] }
}

/// Smallest and largest of finite numbers.
fn extremes(values: &[f64]) -> [f64; 2] {
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    let chunks = values.chunks_exact(4);
    let rest = chunks.remainder();
    let least = |a: f64, b: f64| if b < a { b } else { a };
    let most = |a: f64, b: f64| if b > a { b } else { a };
    for chunk in chunks {
        for lane in 0..4 {
            low[lane] = least(low[lane], chunk[lane]);
            high[lane] = most(high[lane], chunk[lane]);
        }
    }
    let (low, high) = (rest.iter().chain(&low).copied(), rest.iter().chain(&high).copied());
    [low.fold(f64::INFINITY, least), high.fold(f64::NEG_INFINITY, most)]
}

/// At most `j / c'` for every `c'` within `error` of `c > error`.
pub(super) fn quotient_below(j: f64, c: f64, error: f64) -> f64 {
    let quotient = if j >= 0.0 { j / (c + error) } else { j / (c - error) };
    quotient - 4.0 * UNIT * quotient.abs()
}

/// At least `j / c'` for every `c'` within `error` of `c > error`.
pub(super) fn quotient_above(j: f64, c: f64, error: f64) -> f64 {
    -quotient_below(-j, c, error)
}

/// Halves all lines of a net of `size` coefficients along a direction: de Casteljau's scheme at one half.
///
/// Sums are not halved as they arise but when they are stored, which is exact.
pub(super) fn halve(net: &[f64], size: usize, direction: &Direction, left: &mut [f64], right: &mut [f64]) {
    let halves = left.chunks_exact_mut(size).zip(right.chunks_exact_mut(size));
    for (from, (left, right)) in net.chunks_exact(size).zip(halves) {
        for bundle in &direction.bundles {
            halve_bundle(from, bundle, left, right);
        }
    }
}

fn halve_bundle(from: &[f64], bundle: &Bundle, left: &mut [f64], right: &mut [f64]) {
    let mut sums = [[0.0; LANES]; LINE];
    debug_assert!(bundle.len() <= LINE, "a line of {} coefficients is cut", bundle.len());
    let n = bundle.len().min(LINE);
    for (sum, at) in sums.iter_mut().zip(bundle) {
        *sum = at.map(|at| from[usize::from(at)]);
    }
    let mut scale = 1.0;
    for level in 0..n {
        let (first, last) = (bundle[level], bundle[n - 1 - level]);
        for lane in 0..LANES {
            left[usize::from(first[lane])] = scale * sums[0][lane];
            right[usize::from(last[lane])] = scale * sums[n - 1 - level][lane];
        }
        for i in 0..n - 1 - level {
            let next = sums[i + 1];
            for (sum, next) in sums[i].iter_mut().zip(next) {
                *sum += next;
            }
        }
        scale *= 0.5;
    }
}

/// The two halves of a piece's corners.
pub(super) fn halve_corners(corners: &[[f64; 3]; 8], direction: &Direction) -> [[[f64; 3]; 8]; 2] {
    let (mut left, mut right) = (*corners, *corners);
    for &[from, to] in &direction.edges {
        let (from, to) = (usize::from(from), usize::from(to));
        let middle = std::array::from_fn(|x| 0.5 * (corners[from][x] + corners[to][x]));
        left[to] = middle;
        right[from] = middle;
    }
    [left, right]
}

/// Nets of the open pieces, in slots that are used again.
#[derive(Clone, Debug, Default)]
pub(super) struct Store {
    nets: Vec<f64>,
    corners: Vec<[[f64; 3]; 8]>,
    free: Vec<usize>,
    stride: usize,
}

impl Store {
    /// Empties the store, for nets of `stride` numbers.
    pub(super) fn clear(&mut self, stride: usize) {
        self.nets.clear();
        self.corners.clear();
        self.free.clear();
        self.stride = stride;
    }

    /// Stores a piece.
    pub(super) fn put(&mut self, net: &[f64], corners: [[f64; 3]; 8]) -> usize {
        if let Some(slot) = self.free.pop() {
            self.nets[slot * self.stride..][..self.stride].copy_from_slice(net);
            self.corners[slot] = corners;
            return slot;
        }
        self.nets.extend_from_slice(net);
        self.corners.push(corners);
        self.corners.len() - 1
    }

    /// A piece's net and corners.
    pub(super) fn get(&self, slot: usize) -> (&[f64], &[[f64; 3]; 8]) {
        (&self.nets[slot * self.stride..][..self.stride], &self.corners[slot])
    }

    /// Takes a piece out: its net replaces the contents of `into`.
    pub(super) fn take(&mut self, slot: usize, into: &mut Vec<f64>) -> [[f64; 3]; 8] {
        into.clear();
        into.extend_from_slice(&self.nets[slot * self.stride..][..self.stride]);
        self.free.push(slot);
        self.corners[slot]
    }
}

/// The coefficients of a form's corners.
pub(super) fn corner_values<'a>(
    form: &'a Form,
    net: &'a [f64],
    corners: &'a [[f64; 3]; 8],
) -> impl Iterator<Item = ([f64; 3], f64, Option<f64>)> + 'a {
    form.corners.iter().zip(corners).map(|(&n, &at)| {
        let n = usize::from(n);
        (at, net[n], net.get(form.size + n).copied())
    })
}
