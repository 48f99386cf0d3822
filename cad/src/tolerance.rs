//! Every tolerance of the crate, by name. Lengths are given as fractions of the model's diagonal unless said otherwise.

/// Two feet whose distances differ by less are a tie: an interior foot beats one on an edge, then the smaller entity wins. Fraction of the diagonal.
pub const TIE: f64 = 1e-12;

/// Largest tangential residual `|(S − x)·t|`, `t` a unit tangent, of a foot that counts as orthogonal. Fraction of the
/// diagonal plus of the foot's distance.
pub const ORTHOGONAL: f64 = 1e-10;

/// A leaf smaller than this is not cut further: all its points are the same point. Fraction of the diagonal.
pub const POINT: f64 = 1e-10;

/// Coordinates as large as this are infinite: OCCT's own bound is `2e100`, and squares must not overflow. In the unit of the file.
pub const INFINITE: f64 = 1e100;

/// Newton's last relative step (fraction of the leaf's parameter range).
pub const NEWTON_STEP: f64 = 1e-14;

/// Newton steps for one leaf; certified leaves take 3 to 6.
pub const NEWTON_LIMIT: usize = 40;

/// How far, in sizes of the leaf, polishing may leave it.
pub const LEAF_MARGIN: f64 = 1e-5;

/// Newton steps on OCCT's own surface after the search.
pub const POLISH_LIMIT: usize = 4;

/// Residual, as for [`ORTHOGONAL`], below which polishing has nothing to gain.
pub const POLISHED: f64 = 1e-13;

/// Cuts of leaves that one query may spend to prove its answer; beyond it the foot is reported as not proven.
pub const CUT_BUDGET: usize = 400;

/// Turn of the tangent plane over a leaf, in radians, to which leaves are cut when a model is built.
pub const LEAF_TURN: f64 = 0.35;

/// Levels of cutting when a model is built.
pub const LEAF_DEPTH: u32 = 8;

/// Levels of cutting of leaves that a trim crosses, when a model is built.
pub const TRIM_DEPTH: u32 = 4;

/// Two open edges closer than this (or the tolerances of the file) are one. Fraction of the diagonal.
pub const SEWING: f64 = 1e-7;

/// An edge shorter than this, or a face whose box is, is called tiny. Fraction of the diagonal.
pub const TINY: f64 = 1e-6;

/// A pcurve that lies farther from its edge than this many tolerances of the edge is called inconsistent.
pub const TRIM_GAP: f64 = 2.0;

/// ... and one that is farther off than this is called so whatever its tolerance: OCCT widens tolerances until they fit. Fraction of the
/// diagonal.
pub const LOOSE: f64 = 1e-3;

/// Sampled derivative bounds of a leaf are widened by this factor.
pub const BOUND_SAFETY: f64 = 1.5;

/// A trimming curve that enters a leaf by less than this fraction of the leaf's size only touches it.
pub const TOUCH: f64 = 1e-9;

/// Control points no farther than this from one plane, or line, are those of a plane, or line. Fraction of their extent.
pub const FLAT: f64 = 1e-9;

/// A surface that turns by more along a line inside its face has a crease there. Radians; surfaces that are meant to be smooth turn by less
/// than a hundredth.
pub const CREASE: f64 = 0.02;

/// How far beside a line its two sides are looked at. Fraction of the range of parameters to the next line.
pub const CREASE_INSET: f64 = 1e-6;
