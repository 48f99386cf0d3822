//! The scaled Jacobian, smallest over largest determinant, to a wanted gap.

use super::form::Form;
use super::judge::{Arithmetic, Frame, Judge, Shape, frame};
use super::pieces::{Accuracy, Reference};
use super::real::{Double, UNIT};
use super::search::{Goal, Outcome, Task};
use super::{Bounds, Settings};

impl Judge {
    /// Bounds of `min J / max J` that are `settings.gap` apart, by two searches: for the minimum and for the maximum.
    pub fn scaled(&mut self, shape: &Shape, settings: &Settings) -> Bounds {
        let Some(frame) = frame(shape) else { return Bounds::UNKNOWN };
        let simple = self.extremes::<f64>(shape, frame, settings);
        let (bounds, stalled) = simple.unwrap_or((Bounds::UNKNOWN, true));
        if !stalled {
            return bounds;
        }
        self.extremes::<Double>(shape, frame, settings).map_or(bounds, |(bounds, _)| bounds)
    }

    /// The bounds in one arithmetic, and whether rounding kept them apart; `None` where no determinant is positive.
    fn extremes<T: Arithmetic>(&mut self, shape: &Shape, frame: Frame, settings: &Settings) -> Option<(Bounds, bool)> {
        let own = self.coefficients::<T>(shape, frame);
        let form = Form::of(shape.cell, shape.order);
        let highest = form.ends.iter().map(|&(n, _)| self.root[usize::from(n)]).fold(f64::NEG_INFINITY, f64::max);
        if highest <= own.error {
            return None;
        }
        // Each extreme, relative to an attained maximum, to a third of the gap.
        let settings = Settings { gap: settings.gap / 3.0, ..*settings };
        let accuracy = [own, Accuracy::default()];
        let task = Task { form, reference: Reference::Constant(highest), accuracy, goal: Goal::Minimum };
        let least = self.search.run(&task, &self.root, &settings);
        self.root.iter_mut().for_each(|x| *x = -*x);
        let most = self.search.run(&task, &self.root, &settings);
        Some((bounds(&least, &most), least.stalled || most.stalled))
    }
}

/// From a search on `J` and one on `-J`.
fn bounds(least: &Outcome, most: &Outcome) -> Bounds {
    let over = |x: f64, small: f64, large: f64| if x >= 0.0 { x / large } else { x / small };
    let [attained, (maximum_so_far, _)] = least.attained;
    let (high, reached) = (-most.determinant[0], maximum_so_far.max(-most.attained[0].0));
    let lower = over(least.determinant[0], reached, high);
    let upper = over(attained.0, high, reached);
    Bounds { lower: lower - 4.0 * UNIT * lower.abs(), upper: upper + 4.0 * UNIT * upper.abs(), at: attained.1 }
}
