//! Hints: what a query remembers of its search, so that the next one nearby need not search again.
//!
//! The foot `f` of `x` is nearer than a point `p` to every query point on its side of the plane midway between them, and that plane is
//! `(|x − p|² − |x − f|²) / 2|f − p|` away from `x`. Of each part of the group that did not win, the search knows a floor of `|x − p|`, and
//! its box tells how large `|f − p|` can be. So a hint knows how far the query point may move before the part matters: its leeway. The parts
//! with little leeway are kept one by one, the rest under one number. A query with a hint visits the leaf of the hint and the parts whose
//! leeway is spent; where that of the rest is spent, it searches anew. So it does where its leaf has nothing as near as `f` any more: at a rim,
//! `f` may be inside the trim by rounding and what Newton's method finds next outside, and the edge lies beside its trim by up to its tolerance.
//!
//! Near the surface (0.5 % of the diagonal) a moved query takes half the time of one without a hint. Far away (10 %, moved by 2 % of the
//! distance) it takes four fifths: of 20 000 queries around a NACA wing one in four lies so near the middle between parts that it
//! searches anew (by the floors' distances alone it was seven in ten; with twelve rivals it is one in seven, and no faster), and most of the time goes to
//! the few per cent near a centre of curvature, where leaves must be cut with a hint as without.

use crate::boxes::{Aabb, Branch};
use glam::{DVec3, Vec3};

/// Parts whose leeway is kept one by one.
const RIVALS: usize = 6;

/// Parts that one search keeps apart; those beyond are thrown together.
const FLOORS: usize = 24;

/// See [`enough`].
const ENOUGH_OF_DISTANCE: f64 = 0.1;
const ENOUGH_OF_SIZE: f64 = 0.25;

/// The number of no group.
const NOWHERE: u32 = u32::MAX;

/// Relative rounding of squared distances, and of leeways when they are kept.
const ROUNDING: f64 = 1e-12;
const KEPT: f64 = 1.0 - 1e-6;

/// What a query leaves for the next one nearby; see [`Group::closest`](crate::Group::closest). Empty at first.
#[derive(Clone, Copy, Debug)]
pub struct Hint {
    /// Number of the group; hints from other groups are as good as none.
    pub(crate) group: u32,
    /// Leaf of the group's tree.
    pub(crate) leaf: u32,
    /// The query point.
    pub(crate) x: DVec3,
    /// Parameters in the leaf.
    pub(crate) start: [f64; 2],
    /// How the parameters follow a small move of the query point: their gradients; zero where not known.
    pub(crate) response: [Vec3; 2],
    pub(crate) leeways: Leeways,
}

impl Default for Hint {
    fn default() -> Self {
        let nothing = [Vec3::ZERO; 2];
        Self { group: NOWHERE, leaf: 0, x: DVec3::NAN, start: [f64::NAN; 2], response: nothing, leeways: Leeways::NONE }
    }
}

impl Hint {
    /// Where Newton's method leads from the old foot for a new query point, at no evaluation.
    pub(crate) fn follow(&self, x: DVec3) -> [f64; 2] {
        let by = x - self.x;
        [0, 1].map(|i| self.start[i] + self.response[i].as_dvec3().dot(by))
    }

    /// How far `x` is from the query point, rounded up.
    pub(crate) fn moved(&self, x: DVec3) -> f64 {
        self.x.distance(x) * (1.0 + ROUNDING)
    }
}

/// A part of the group, and how far the query point may move before a point of it can be the closest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rival {
    pub(crate) branch: Branch,
    pub(crate) leeway: f32,
}

/// The leeways of all parts of the group but the leaf of the foot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leeways {
    rivals: [Rival; RIVALS],
    count: u32,
    /// Of all that is not among the rivals.
    pub(crate) rest: f64,
}

impl Leeways {
    /// Nothing but the leaf of the foot.
    pub(crate) const FREE: Self =
        Self { rivals: [Rival { branch: Branch::ROOT, leeway: 0.0 }; RIVALS], count: 0, rest: f64::INFINITY };
    /// No query nearby can go without a search.
    pub(crate) const NONE: Self = Self { rest: 0.0, ..Self::FREE };

    pub(crate) fn rivals(&self) -> &[Rival] {
        &self.rivals[..self.count as usize]
    }

    pub(crate) fn push(&mut self, branch: Branch, leeway: f64) {
        let mut rival = Rival { branch, leeway: (leeway.max(0.0) * KEPT) as f32 };
        if (self.count as usize) < RIVALS {
            self.rivals[self.count as usize] = rival;
            self.count += 1;
            return;
        }
        for kept in self.rivals.iter_mut().filter(|kept| kept.branch != branch) {
            if rival.leeway < kept.leeway {
                std::mem::swap(kept, &mut rival);
            }
        }
        self.rest = self.rest.min(f64::from(rival.leeway));
    }
}

/// Squared distances that parts of the group do not fall short of.
pub(crate) struct Floors {
    at: [(Branch, f64); FLOORS],
    count: usize,
    /// Of all that found no room, or are beyond `afar`.
    rest: f64,
    afar: f64,
}

impl Floors {
    pub(crate) fn new() -> Self {
        Self { at: [(Branch::ROOT, f64::INFINITY); FLOORS], count: 0, rest: f64::INFINITY, afar: f64::INFINITY }
    }

    /// The closest point is at most `distance` away; leaves are about `size` large.
    pub(crate) fn closest_within(&mut self, distance: f64, size: f64) {
        self.afar = (distance + 2.0 * enough(distance, size)).powi(2);
    }

    #[inline]
    pub(crate) fn push(&mut self, branch: Branch, floor: f64) {
        if floor > self.afar {
            self.rest = self.rest.min(floor);
        } else if let Some(last) = self.at[..self.count].last_mut().filter(|last| last.0 == branch) {
            // parts of one leaf come one after the other
            last.1 = last.1.min(floor.max(0.0));
        } else if self.count < FLOORS {
            self.at[self.count] = (branch, floor.max(0.0)); // a NaN is 0
            self.count += 1;
        } else {
            self.rest = self.rest.min(floor.max(0.0));
        }
    }

    /// The leeways, seen from the foot at `point`, `distance` away from the query point, for all but its own `leaf`; added to those `carried` over
    /// from an earlier search. Leaves are about `size` large.
    pub(crate) fn leeways(
        &self,
        mut carried: Leeways,
        leaf: usize,
        (point, distance): (DVec3, f64),
        size: f64,
        bounds: impl Fn(Branch) -> Aabb,
    ) -> Leeways {
        let grown = distance * distance * (1.0 + ROUNDING);
        let enough = enough(distance, size);
        for &(branch, floor) in &self.at[..self.count] {
            if branch == Branch::leaf(leaf) {
                continue;
            }
            let leeway = (floor - grown) / (2.0 * bounds(branch).farthest(point));
            if leeway < enough {
                carried.push(branch, leeway);
            } else {
                carried.rest = carried.rest.min(leeway);
            }
        }
        // farther out the plane is at least half the excess of distance away
        carried.rest = carried.rest.min(0.5 * (self.rest.sqrt() - grown.sqrt()));
        carried
    }
}

/// A leeway that is enough: what has more is not kept one by one. For a foot at `distance` on leaves about `size` large.
fn enough(distance: f64, size: f64) -> f64 {
    ENOUGH_OF_DISTANCE * distance + ENOUGH_OF_SIZE * size
}
