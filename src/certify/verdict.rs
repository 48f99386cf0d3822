//! What the certificate says of an element.

/// Whether the Jacobian determinant is positive on the whole closed cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// Proven positive everywhere.
    Valid,
    /// Proven not positive at a point.
    Invalid {
        /// The point, in reference coordinates (`element::bernstein`).
        at: [f64; 3],
        /// The determinant there is at most this.
        value: f64,
    },
    /// Neither could be proven; counts as failure.
    Undecided,
}

impl Verdict {
    /// Whether this is [`Verdict::Valid`].
    #[must_use]
    pub fn is_valid(self) -> bool {
        self == Verdict::Valid
    }
}

/// Proven bounds of a minimum over an element: it lies in `[lower, upper]`, and `upper` is attained at `at` (to
/// rounding, which `upper` includes).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// No value is smaller.
    pub lower: f64,
    /// Some value is at most this.
    pub upper: f64,
    /// Where, in reference coordinates.
    pub at: [f64; 3],
}

impl Bounds {
    /// Bounds that say nothing.
    pub const UNKNOWN: Bounds = Bounds { lower: f64::NEG_INFINITY, upper: f64::INFINITY, at: [0.0; 3] };
}

/// The findings on one element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// Validity.
    pub verdict: Verdict,
    /// The minimum of `J / J_c`: the largest `t` for which `J - t J_c >= 0` everywhere. [`Bounds::UNKNOWN`] where `J_c`
    /// is not positive.
    pub relative: Bounds,
    /// The scaled Jacobian: smallest over largest determinant of the element.
    pub scaled: Bounds,
    /// How many pieces the element was cut into.
    pub pieces: usize,
    /// How the finding came about.
    pub method: Method,
}

/// How much work a finding took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Its points are those of the linear element, to rounding: the linear element was certified.
    Straight,
    /// In `f64`.
    Simple,
    /// In pairs of `f64`.
    Double,
}
