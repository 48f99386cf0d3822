//! One element: from coordinates to findings.

use glam::DVec3;

use super::form::Form;
use super::pieces::{Accuracy, Reference};
use super::product::{Product, Workspace};
use super::real::{Double, Real, UNIT};
use super::search::{Goal, Outcome, Search, Task};
use super::verdict::{Bounds, Finding, Method, Verdict};
use super::{Settings, straight};
use crate::element::{Cell, Order};

/// An element to be judged.
#[derive(Clone, Copy, Debug)]
pub struct Shape<'a> {
    /// Its cell: a volume, or a face of a plane mesh.
    pub cell: Cell,
    /// Its order.
    pub order: Order,
    /// Its nodes in internal order.
    pub points: &'a [DVec3],
    /// The corners of the linear element that `J_c` is taken from; its own straight corners where there is none.
    pub corners: Option<&'a [DVec3]>,
    /// The unit vectors that stand on a face or line and complete its Jacobian matrix: a face's `J` is `(x_u x x_v) . m`, a line's
    /// `x_u . (a x b)`. Volumes have none.
    pub upright: &'a [DVec3],
}

impl Shape<'_> {
    /// Loads coordinates of the element, shifted and scaled, and after them the vectors that stand on it.
    fn load<T: Real>(&self, into: &mut Vec<[T; 3]>, points: &[DVec3], frame: Frame) {
        load(into, points, frame.scale);
        into.extend(self.last_nodes());
    }

    /// The vectors that stand on it, which follow its nodes as they are.
    fn last_nodes<T: Real>(&self) -> impl Iterator<Item = [T; 3]> + '_ {
        self.upright.iter().map(|vector| vector.to_array().map(T::of))
    }
}

/// Judges elements one after another, in memory that it keeps.
#[derive(Clone, Debug, Default)]
pub struct Judge {
    simple: Workspace<f64>,
    double: Workspace<Double>,
    linear: Vec<f64>,
    pub(super) root: Vec<f64>,
    pub(super) search: Search,
}

/// A power of two that brings an element to size 1, and its largest components then, the normal's included.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) scale: f64,
    largest: [f64; 3],
}

/// Why a search stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stop {
    /// The bounds are as near as was wanted.
    Closed,
    /// Rounding.
    Stalled,
    /// A point with `J <= 0`, or too many pieces.
    Other,
}

impl Stop {
    fn of(outcome: &Outcome) -> Stop {
        match (outcome.closed && outcome.verdict != Verdict::Undecided, outcome.stalled) {
            (true, _) => Stop::Closed,
            (false, true) => Stop::Stalled,
            (false, false) => Stop::Other,
        }
    }
}

impl Judge {
    /// Judges an element. An element with coordinates that are not finite is undecided.
    pub fn examine(&mut self, shape: &Shape, settings: &Settings) -> Finding {
        let Some(frame) = frame(shape) else { return undecided() };
        if let Some(finding) = self.straight(shape, frame, settings) {
            return finding;
        }
        let (finding, stop) = self.curved::<f64>(shape, frame, settings);
        if stop != Stop::Stalled {
            return finding;
        }
        self.curved::<Double>(shape, frame, settings).0
    }

    /// The finding on an element that is straight to rounding, from its linear element.
    fn straight(&mut self, shape: &Shape, frame: Frame, settings: &Settings) -> Option<Finding> {
        load(&mut self.simple.nodes, shape.points, frame.scale);
        let off = straight::distance(shape.cell, shape.order, &self.simple.nodes, frame.largest)?;
        self.simple.nodes.truncate(shape.cell.corner_count());
        self.simple.nodes.extend(shape.last_nodes());
        let product = Product::of(shape.cell, Order::LINEAR);
        let columns = product.coefficients(&mut self.simple, &mut self.root);
        let largest = absolute(&self.root);
        // The order's own constants are larger than those of the linear product that is evaluated.
        let growth = &Product::of(shape.cell, shape.order).growth;
        let error = growth.bound::<f64>(frame.largest, columns, largest, off);
        let own = Accuracy { error, largest: largest + error };
        let form = Form::of(shape.cell, Order::LINEAR);
        let (finding, stop) = self.search::<f64>(shape, frame, form, own, settings);
        let proven = finding.verdict.is_valid() && stop == Stop::Closed;
        proven.then_some(Finding { method: Method::Straight, ..finding })
    }

    /// The finding in one arithmetic, and why the search stopped.
    fn curved<T: Arithmetic>(&mut self, shape: &Shape, frame: Frame, settings: &Settings) -> (Finding, Stop) {
        let own = self.coefficients::<T>(shape, frame);
        self.search::<T>(shape, frame, Form::of(shape.cell, shape.order), own, settings)
    }

    /// Fills the root with the coefficients of `J`.
    pub(super) fn coefficients<T: Arithmetic>(&mut self, shape: &Shape, frame: Frame) -> Accuracy {
        let product = Product::of(shape.cell, shape.order);
        let form = Form::of(shape.cell, shape.order);
        let (work, root) = T::parts(self);
        shape.load(&mut work.nodes, shape.points, frame);
        let columns = product.coefficients(work, root);
        let largest = absolute(root);
        let error = product.growth.bound::<T>(frame.largest, columns, largest, [0.0; 3]);
        let raised = form.raise.as_ref().map_or(0.0, |raise| mean_error(raise.longest) * largest);
        Accuracy { error: error + raised, largest: largest + error + raised }
    }

    /// Searches the net in `self.root` against the element's reference.
    fn search<T: Arithmetic>(
        &mut self,
        shape: &Shape,
        frame: Frame,
        form: &Form,
        own: Accuracy,
        settings: &Settings,
    ) -> (Finding, Stop) {
        let (reference, accuracy) = self.reference::<T>(shape, frame, form);
        let known = reference.is_some();
        let accuracy = if known { accuracy } else { Accuracy::default() };
        let task = Task {
            form,
            reference: reference.unwrap_or(Reference::Constant(own.largest)),
            accuracy: [own, accuracy],
            goal: Goal::Verdict,
        };
        let outcome = self.search.run(&task, &self.root, settings);
        (finding(&outcome, known, shape.cell, frame, T::METHOD), Stop::of(&outcome))
    }

    /// `J_c`: appended to the root as a net, or a constant; `None` where it is not positive at a corner.
    fn reference<T: Arithmetic>(&mut self, shape: &Shape, frame: Frame, form: &Form) -> (Option<Reference>, Accuracy) {
        let product = Product::of(shape.cell, Order::LINEAR);
        let count = shape.cell.corner_count();
        let corners = &shape.corners.unwrap_or(shape.points)[..count];
        let mut linear = std::mem::take(&mut self.linear);
        let (work, _) = T::parts(self);
        shape.load(&mut work.nodes, corners, frame);
        let nodes = largest(&work.nodes);
        let columns = product.coefficients(work, &mut linear);
        let size = absolute(&linear);
        let error = product.growth.bound::<T>(nodes, columns, size, [0.0; 3]);
        let net = linear.len() > 1;
        let raised = if net { form.raised_error() * size } else { 0.0 };
        let accuracy = Accuracy { error: error + raised, largest: size + error + raised };
        let ends = &Form::of(shape.cell, Order::LINEAR).ends;
        let finite = corners.iter().all(|x| x.is_finite()) && nodes.iter().all(|&x| x < LARGEST_REFERENCE);
        let positive = finite && ends.iter().all(|&(n, _)| linear[usize::from(n)] > accuracy.error);
        if positive && net {
            form.from_linear.apply(&linear, &mut self.root);
        }
        let constant = linear.first().copied().unwrap_or(f64::NAN);
        self.linear = linear;
        let reference = if net { Reference::Net } else { Reference::Constant(constant) };
        (positive.then_some(reference), accuracy)
    }
}

impl Form {
    /// Relative error of raising a linear element's net to this form's.
    fn raised_error(&self) -> f64 {
        mean_error(self.from_linear.longest) + self.raise.as_ref().map_or(0.0, |raise| mean_error(raise.longest))
    }
}

/// Relative error of a mean of `n` terms, whose weights are products of up to six quotients of integers.
fn mean_error(n: usize) -> f64 {
    1.01 * (n + 16) as f64 * UNIT
}

/// A linear element that is so many times larger than the curved one is no reference, and its products may overflow.
const LARGEST_REFERENCE: f64 = 1e30;

/// An arithmetic, and the judge's memory for it.
pub(super) trait Arithmetic: Real {
    const METHOD: Method;
    fn parts(judge: &mut Judge) -> (&mut Workspace<Self>, &mut Vec<f64>);
}

impl Arithmetic for f64 {
    const METHOD: Method = Method::Simple;
    fn parts(judge: &mut Judge) -> (&mut Workspace<f64>, &mut Vec<f64>) {
        (&mut judge.simple, &mut judge.root)
    }
}

impl Arithmetic for Double {
    const METHOD: Method = Method::Double;
    fn parts(judge: &mut Judge) -> (&mut Workspace<Double>, &mut Vec<f64>) {
        (&mut judge.double, &mut judge.root)
    }
}

/// The frame of an element; `None` where it has no size, is not finite, lacks nodes, or is a face or line without the vectors that stand on it.
pub(super) fn frame(shape: &Shape) -> Option<Frame> {
    let points = shape.points;
    let counted = points.len() == shape.cell.node_count(shape.order)
        && shape.corners.is_none_or(|corners| corners.len() >= shape.cell.corner_count())
        && shape.cell.has_jacobian(shape.upright.len());
    let &first = points.first().filter(|_| counted)?;
    let largest = points.iter().fold(DVec3::ZERO, |largest, &x| largest.max((x - first).abs()));
    let finite = points.iter().chain(shape.upright).all(|x| x.is_finite());
    let frame = Frame::of(largest).filter(|_| finite)?;
    let largest = shape.upright.iter().fold(DVec3::from(frame.largest), |largest, vector| largest.max(vector.abs()));
    Some(Frame { largest: largest.to_array(), ..frame })
}

impl Frame {
    /// The frame of a shape with these largest components; `None` where they are nothing, or too much to scale.
    pub(super) fn of(largest: DVec3) -> Option<Frame> {
        let size = largest.max_element();
        // Exponents of the reciprocal stay normal in this range.
        if !(1e-250..1e250).contains(&size) {
            return None;
        }
        let exponent = size.to_bits() >> 52;
        let scale = f64::from_bits((2046 - exponent) << 52);
        Some(Frame { scale, largest: (largest * scale).to_array() })
    }
}

/// Shifts points by the first and scales them.
pub(super) fn load<T: Real>(into: &mut Vec<[T; 3]>, points: &[DVec3], scale: f64) {
    let Some(first) = points.first().map(|x| x.to_array()) else { return };
    let scale = T::of(scale);
    into.clear();
    into.extend(points.iter().map(|x| {
        let x = x.to_array();
        [0, 1, 2].map(|axis| T::difference(x[axis], first[axis]) * scale)
    }));
}

pub(super) fn largest<T: Real>(nodes: &[[T; 3]]) -> [f64; 3] {
    nodes.iter().fold([0.0; 3], |l, x| [0, 1, 2].map(|axis| f64::max(l[axis], x[axis].rounded().abs())))
}

pub(super) fn absolute(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, x| largest.max(x.abs()))
}

fn undecided() -> Finding {
    Finding {
        verdict: Verdict::Undecided,
        relative: Bounds::UNKNOWN,
        scaled: Bounds::UNKNOWN,
        pieces: 0,
        method: Method::Simple,
    }
}

fn finding(outcome: &Outcome, known: bool, cell: Cell, frame: Frame, method: Method) -> Finding {
    let [(least, at), (most, _)] = outcome.attained;
    let [low, high] = outcome.determinant;
    let volume = frame.scale.powi(-(cell.dimension() as i32));
    let verdict = match outcome.verdict {
        Verdict::Invalid { at, value } => Verdict::Invalid { at, value: value * volume },
        other => other,
    };
    let relative = Bounds { lower: outcome.lower, upper: outcome.upper.0, at: outcome.upper.1 };
    let over = |x: f64, small: f64, large: f64| if x >= 0.0 { x / large } else { x / small };
    let down = |x: f64| x - 4.0 * UNIT * x.abs();
    let scaled = if most > 0.0 {
        Bounds { lower: down(over(low, most, high)), upper: -down(-over(least, high, most)), at }
    } else {
        Bounds::UNKNOWN
    };
    Finding {
        verdict,
        relative: if known { relative } else { Bounds::UNKNOWN },
        scaled,
        pieces: outcome.pieces,
        method,
    }
}
