//! Best-first subdivision: proves or refutes positivity, and closes in on the minimum of `J / J_c`.
//!
//! The piece with the lowest bound is halved next, along the direction that lifts its bound most. Its lowest coefficient
//! bounds `J` from below by the convex hull property; the coefficients at its corners are attained values.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::form::Form;
use super::pieces::{Accuracy, Range, Reference, Store, corner_values, halve, halve_corners, quotient_above, range};
use super::{Settings, Verdict};

/// One element's nets, and what is known of their accuracy.
#[derive(Clone, Copy, Debug)]
pub(super) struct Task<'a> {
    pub(super) form: &'a Form,
    /// What `J` is compared with.
    pub(super) reference: Reference,
    /// Of `J`, and of `J_c`.
    pub(super) accuracy: [Accuracy; 2],
    /// What is asked.
    pub(super) goal: Goal,
}

/// What a search is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// A verdict, and then the minimum of `J / J_c` to the wanted gap; ends at the first point with `J <= 0`.
    Verdict,
    /// The minimum alone, whatever its sign.
    Minimum,
}

/// What a search found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    pub(super) verdict: Verdict,
    /// Lower bound of `J / J_c`.
    pub(super) lower: f64,
    /// An attained `J / J_c`, and where.
    pub(super) upper: (f64, [f64; 3]),
    /// Bounds of `J` over all pieces.
    pub(super) determinant: [f64; 2],
    /// Attained: a value that the minimum of `J` does not exceed, with its place, and one that the maximum reaches.
    pub(super) attained: [(f64, [f64; 3]); 2],
    /// Number of pieces.
    pub(super) pieces: usize,
    /// Whether the wanted gap was reached.
    pub(super) closed: bool,
    /// Whether rounding stopped the search.
    pub(super) stalled: bool,
}

/// Memory of the search, kept from element to element.
#[derive(Clone, Debug, Default)]
pub(super) struct Search {
    store: Store,
    open: BinaryHeap<Piece>,
    piece: Vec<f64>,
    halves: [Vec<f64>; 2],
    best: [Vec<f64>; 2],
}

/// A piece that may still have to be halved.
#[derive(Clone, Copy, Debug)]
struct Piece {
    range: Range,
    slot: usize,
    halvings: usize,
    /// Order of creation, to break ties.
    serial: usize,
}

impl Ord for Piece {
    fn cmp(&self, other: &Piece) -> Ordering {
        // A heap pops its greatest: the lowest bound, then the oldest.
        other.range.lower.total_cmp(&self.range.lower).then(other.serial.cmp(&self.serial))
    }
}

impl PartialOrd for Piece {
    fn partial_cmp(&self, other: &Piece) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Piece {
    fn eq(&self, other: &Piece) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Piece {}

/// Bounds gathered so far.
#[derive(Clone, Copy, Debug)]
struct Gathered {
    /// Of the pieces that are done with.
    done: Range,
    /// Smallest attained quotient.
    quotient: (f64, [f64; 3]),
    /// Attained determinants, as in [`Outcome::attained`].
    attained: [(f64, [f64; 3]); 2],
    /// Open pieces whose determinant is not proven positive.
    doubtful: usize,
    pieces: usize,
    stalled: bool,
}

impl Search {
    /// Runs a task on the net of the root: `J`'s product net, then `J_c`'s where the reference is one.
    pub(super) fn run(&mut self, task: &Task, root: &[f64], settings: &Settings) -> Outcome {
        let form = task.form;
        let mut gathered = Gathered::start();
        for &(n, at) in &form.ends {
            let n = usize::from(n);
            gathered.attain(task, at, root[n], root.get(form.product + n).copied(), 0);
        }
        let whole = range(root, form.product, task.reference, [0, 1].map(|k| task.accuracy[k].error));
        if gathered.refuted(task) || gathered.done_with(task, &whole, settings) {
            gathered.done = whole;
            gathered.doubtful = usize::from(whole.determinant[0] <= 0.0);
            return self.outcome(task, &gathered, settings);
        }
        self.begin(task, root, &mut gathered);
        while !gathered.refuted(task) && gathered.pieces < settings.pieces {
            let Some(piece) = self.open.pop() else { break };
            if gathered.done_with(task, &piece.range, settings) {
                self.open.push(piece); // the lowest is good enough, so all are
                break;
            }
            if self.as_good_as_it_gets(task, &piece) {
                self.open.push(piece);
                gathered.stalled = true;
                break;
            }
            self.split(task, piece, &mut gathered, settings);
        }
        self.outcome(task, &gathered, settings)
    }

    /// Raises the root to the net that is halved, and opens it.
    fn begin(&mut self, task: &Task, root: &[f64], gathered: &mut Gathered) {
        let form = task.form;
        self.piece.clear();
        match &form.raise {
            None => self.piece.extend_from_slice(root),
            Some(raise) => root.chunks_exact(form.product).for_each(|net| raise.apply(net, &mut self.piece)),
        }
        let mut corners = [[0.0; 3]; 8];
        for (corner, &(_, at)) in corners.iter_mut().zip(&form.ends) {
            *corner = at;
        }
        self.open.clear();
        self.store.clear(self.piece.len());
        for buffer in self.halves.iter_mut().chain(&mut self.best) {
            buffer.clear();
            buffer.resize(self.piece.len(), 0.0);
        }
        let range = range(&self.piece, form.size, task.reference, task.errors(0));
        gathered.doubtful += usize::from(range.determinant[0] <= 0.0);
        let slot = self.store.put(&self.piece, corners);
        self.open.push(Piece { range, slot, halvings: 0, serial: 0 });
    }

    /// Whether rounding leaves a piece's bound nearly as good as halving could make it: errors cost it twice as much as
    /// the distance of its net from the values at its corners.
    fn as_good_as_it_gets(&self, task: &Task, piece: &Piece) -> bool {
        let form = task.form;
        let (net, corners) = self.store.get(piece.slot);
        let exact = range(net, form.size, task.reference, [0.0; 2]).lower;
        let attained = corner_values(form, net, corners).map(|(_, j, c)| j / task.reference.at(c));
        let attained = attained.fold(f64::INFINITY, f64::min);
        exact > f64::NEG_INFINITY && attained - exact <= 0.5 * (exact - piece.range.lower)
    }

    /// Halves a piece.
    fn split(&mut self, task: &Task, piece: Piece, gathered: &mut Gathered, settings: &Settings) {
        let form = task.form;
        let halvings = piece.halvings + 1;
        let errors = task.errors(halvings);
        let corners = self.store.take(piece.slot, &mut self.piece);
        let (direction, ranges) = self.best_direction(task, piece, errors, gathered.quotient.0);
        gathered.doubtful -= usize::from(piece.range.determinant[0] <= 0.0);
        gathered.pieces += 1;
        for (half, corners) in halve_corners(&corners, &form.directions[direction]).into_iter().enumerate() {
            for (at, j, c) in corner_values(form, &self.best[half], &corners) {
                gathered.attain(task, at, j, c, halvings);
            }
            if gathered.done_with(task, &ranges[half], settings) {
                gathered.done = gathered.done.and(&ranges[half]);
            } else {
                gathered.doubtful += usize::from(ranges[half].determinant[0] <= 0.0);
                let slot = self.store.put(&self.best[half], corners);
                let serial = 2 * gathered.pieces + half;
                self.open.push(Piece { range: ranges[half], slot, halvings, serial });
            }
        }
    }

    /// The direction whose worse half has the best bound; both halves are left in `self.best`.
    ///
    /// Where none lifts the bound noticeably, directions take turns, so that every one is halved in the end.
    fn best_direction(&mut self, task: &Task, piece: Piece, errors: [f64; 2], upper: f64) -> (usize, [Range; 2]) {
        let form = task.form;
        let worse = |ranges: &[Range; 2]| ranges[0].lower.min(ranges[1].lower);
        let mut chosen: Option<(usize, [Range; 2])> = None;
        for direction in 0..form.directions.len() {
            let ranges = self.try_direction(task, direction, errors);
            if chosen.as_ref().is_none_or(|(_, best)| worse(&ranges) > worse(best)) {
                chosen = Some((direction, ranges));
                std::mem::swap(&mut self.best, &mut self.halves);
            }
        }
        let enough = piece.range.lower + 1e-3 * (upper - piece.range.lower);
        match chosen {
            Some(chosen) if worse(&chosen.1) > enough => chosen,
            _ => {
                let direction = piece.halvings % form.directions.len();
                let ranges = self.try_direction(task, direction, errors);
                std::mem::swap(&mut self.best, &mut self.halves);
                (direction, ranges)
            }
        }
    }

    /// Halves `self.piece` into `self.halves`.
    fn try_direction(&mut self, task: &Task, direction: usize, errors: [f64; 2]) -> [Range; 2] {
        let form = task.form;
        let [left, right] = &mut self.halves;
        halve(&self.piece, form.size, &form.directions[direction], left, right);
        [range(left, form.size, task.reference, errors), range(right, form.size, task.reference, errors)]
    }

    fn outcome(&mut self, task: &Task, gathered: &Gathered, settings: &Settings) -> Outcome {
        let all = self.open.drain().fold(gathered.done, |all, piece| all.and(&piece.range));
        let [lowest, _] = gathered.attained;
        let verdict = match () {
            () if gathered.refuted(task) => Verdict::Invalid { at: lowest.1, value: lowest.0 },
            () if gathered.doubtful == 0 && all.determinant[0] > 0.0 => Verdict::Valid,
            () => Verdict::Undecided,
        };
        Outcome {
            verdict,
            lower: all.lower,
            upper: gathered.quotient,
            determinant: all.determinant,
            attained: gathered.attained,
            pieces: gathered.pieces,
            closed: gathered.close(all.lower, settings),
            stalled: gathered.stalled,
        }
    }
}

impl Task<'_> {
    fn errors(&self, halvings: usize) -> [f64; 2] {
        self.accuracy.map(|accuracy| accuracy.after(halvings, self.form.degree))
    }
}

impl Range {
    fn and(&self, other: &Range) -> Range {
        let ([a, b], [c, d]) = (self.determinant, other.determinant);
        Range { lower: self.lower.min(other.lower), determinant: [a.min(c), b.max(d)] }
    }
}

impl Gathered {
    fn start() -> Gathered {
        let nothing = Range { lower: f64::INFINITY, determinant: [f64::INFINITY, f64::NEG_INFINITY] };
        Gathered {
            done: nothing,
            quotient: (f64::INFINITY, [0.0; 3]),
            attained: [(f64::INFINITY, [0.0; 3]), (f64::NEG_INFINITY, [0.0; 3])],
            doubtful: 0,
            pieces: 1,
            stalled: false,
        }
    }

    /// Takes note of the values at a corner.
    fn attain(&mut self, task: &Task, at: [f64; 3], j: f64, c: Option<f64>, halvings: usize) {
        let [error, reference_error] = task.errors(halvings);
        let c = task.reference.at(c);
        if c > reference_error {
            let quotient = quotient_above(j + error, c, reference_error);
            if quotient < self.quotient.0 {
                self.quotient = (quotient, at);
            }
        }
        if j + error < self.attained[0].0 {
            self.attained[0] = (j + error, at);
        }
        if j - error > self.attained[1].0 {
            self.attained[1] = (j - error, at);
        }
    }

    /// Whether a point with `J <= 0` is known.
    fn refuted(&self, task: &Task) -> bool {
        task.goal == Goal::Verdict && self.attained[0].0 <= 0.0
    }

    /// Whether a lower bound is as near the attained minimum as is wanted.
    fn close(&self, lower: f64, settings: &Settings) -> bool {
        self.quotient.0 - lower <= settings.gap * self.quotient.0.abs().max(1.0)
    }

    /// Whether a piece needs no further halving.
    fn done_with(&self, task: &Task, range: &Range, settings: &Settings) -> bool {
        (range.determinant[0] > 0.0 || task.goal == Goal::Minimum) && self.close(range.lower, settings)
    }
}
