//! Which patches there are: every kind of cells on every shape of wall at every order in every band of sagittas, once.

use std::fmt;

use crate::common::random::Random;

/// Cells of a patch, from the wall up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Tets,
    Prisms,
    Hexes,
    /// Layers of hexes, then pyramids and tets.
    Pyramids,
    /// Layers of prisms, then tets.
    Hybrid,
}

impl Kind {
    pub const ALL: [Kind; 5] = [Kind::Tets, Kind::Prisms, Kind::Hexes, Kind::Pyramids, Kind::Hybrid];

    /// Whether the wall is made of quadrilaterals.
    pub fn has_quads(self) -> bool {
        matches!(self, Kind::Hexes | Kind::Pyramids)
    }
}

/// Shape of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    Bump,
    Dent,
    Ridge,
    /// Two faces that meet in an edge of the CAD, convex or concave.
    Crease,
}

impl Shape {
    pub const ALL: [Shape; 4] = [Shape::Bump, Shape::Dent, Shape::Ridge, Shape::Crease];
}

/// Polynomial orders.
pub const ORDERS: [usize; 3] = [2, 3, 4];

/// Parts of the range of sagittas that are equal in the logarithm: bounds in wall spacings are 1, 5.6, 32, 178, 1000.
pub const BANDS: usize = 4;
/// Largest sagitta, in wall spacings.
const MOST_SPACINGS: f64 = 1000.0;
/// Largest sagitta, in edge lengths: 1000 wall spacings at an aspect ratio of 1e4.
const MOST_BENT: f64 = 0.1;
/// Aspect ratios: edge length over wall spacing.
pub const ASPECT_RATIOS: [f64; 2] = [10.0, 1e4];

/// One patch.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub kind: Kind,
    pub shape: Shape,
    pub order: usize,
    pub band: usize,
    /// What everything else follows from.
    pub seed: u64,
}

impl Case {
    /// All patches of a seed.
    pub fn all(seed: u64) -> Vec<Case> {
        let mut random = Random(seed);
        let mut all = Vec::new();
        for kind in Kind::ALL {
            for shape in Shape::ALL {
                for order in ORDERS {
                    all.extend((0..BANDS).map(|band| Case { kind, shape, order, band, seed: random.bits() }));
                }
            }
        }
        all
    }

    /// Bounds of the sagitta, in wall spacings.
    pub fn sagittas(&self) -> [f64; 2] {
        [self.band, self.band + 1].map(|b| MOST_SPACINGS.powf(b as f64 / BANDS as f64))
    }

    /// Draws a sagitta in wall spacings, and an aspect ratio at which the facets can have it; low ones more often, so that
    /// every decade occurs.
    pub fn proportions(&self, random: &mut Random) -> (f64, f64) {
        let [from, to] = self.sagittas();
        // off the bounds by more than the accuracy with which the wall is bent
        let sagitta = random.decade(1.005 * from, 0.995 * to);
        let [least, most] = [ASPECT_RATIOS[0].max(sagitta / MOST_BENT), ASPECT_RATIOS[1]];
        (sagitta, least * (most / least).powf(random.between(0.0, 1.0).powi(2)))
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Case { kind, shape, order, band, seed } = self;
        write!(f, "{kind:<8?} {shape:<6?} P{order} band {band} seed {seed:>20}")
    }
}
