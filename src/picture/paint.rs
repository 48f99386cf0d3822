//! What colours say: which measure, over which range, with its legend.

use super::colour::{Colour, INK, NONE, WRONG, of_patch, viridis};
use super::lettering::Paper;

/// What colours say.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Paint {
    /// A measure that is at most 1; 0 or less stands out.
    Measure {
        /// Its name.
        name: &'static str,
        /// The least value that is told apart.
        low: f64,
    },
    /// A length, by its logarithm.
    Length {
        /// Its name.
        name: &'static str,
        /// The least length that is told apart, and the largest.
        range: [f64; 2],
    },
    /// Patches, by place.
    Patches(Vec<(usize, String)>),
}

/// Lengths are told apart down to this part of the largest.
const DEPTH: f64 = 1e-3;

/// Patches that a legend lists.
const LISTED: usize = 24;

impl Paint {
    /// A measure over a range of values.
    pub(super) fn measure(name: &'static str, values: impl Iterator<Item = f64>) -> Paint {
        let low = values.filter(|x| *x > 0.0).fold(1.0, f64::min);
        Paint::Measure { name, low: if low < 0.999 { low } else { 0.0 } }
    }

    /// A length over a range of values.
    pub(super) fn length(name: &'static str, values: impl Iterator<Item = f64>) -> Paint {
        let high = values.filter(|x| x.is_finite()).fold(0.0, f64::max);
        Paint::Length { name, range: [DEPTH * high, high] }
    }

    /// The colour of a value.
    pub(super) fn of(&self, value: f64) -> Colour {
        match self {
            Paint::Measure { .. } if value.is_finite() && value <= 0.0 || value == f64::NEG_INFINITY => WRONG,
            _ if !value.is_finite() => NONE,
            Paint::Measure { low, .. } => viridis((value - low) / (1.0 - low)),
            Paint::Length { range: [_, high], .. } if *high <= 0.0 => viridis(0.0),
            Paint::Length { range: [low, high], .. } => viridis((value / low).max(1.0).ln() / (high / low).ln()),
            Paint::Patches(_) => of_patch(value as usize),
        }
    }

    /// Draws the legend in a column of pixels.
    pub(super) fn explain(&self, paper: &mut Paper, left: i64, top: i64, height: i64) {
        match self {
            Paint::Measure { name, low } => {
                let at = |t: f64| low + t * (1.0 - low);
                self.bar(paper, name, [left, top, height], at);
                paper.fill([left, top + height + 8, 18, 12], WRONG);
                paper.label("0 or less", [(left + 26) as f32, (top + height + 19) as f32]);
            }
            Paint::Length { name, range: [low, high] } => {
                self.bar(
                    paper,
                    name,
                    [left, top, height],
                    |t| if *low > 0.0 { low * (high / low).powf(t) } else { 0.0 },
                );
            }
            Paint::Patches(patches) => {
                let room = (paper.width as i64 - left - 24).max(0) as usize / 8; // letters
                for ((place, name), row) in patches.iter().take(LISTED).zip(0..) {
                    let y = top + 20 * row;
                    paper.fill([left, y, 14, 14], of_patch(*place));
                    let short: String = name.chars().take(room).collect();
                    paper.label(&short, [(left + 20) as f32, (y + 12) as f32]);
                }
                if patches.len() > LISTED {
                    let text = format!("and {} more", patches.len() - LISTED);
                    paper.label(&text, [left as f32, (top + 20 * LISTED as i64 + 12) as f32]);
                }
            }
        }
    }

    /// A bar from the largest value down, with figures beside it.
    fn bar(&self, paper: &mut Paper, name: &str, [left, top, height]: [i64; 3], at: impl Fn(f64) -> f64) {
        const WIDTH: i64 = 18;
        const FIGURES: i64 = 6;
        paper.label(name, [left as f32, (top - 14) as f32]);
        for row in 0..height {
            let t = 1.0 - row as f64 / (height - 1).max(1) as f64;
            paper.fill([left, top + row, WIDTH, 1], self.of(at(t)));
        }
        for tick in 0..=FIGURES {
            let t = tick as f64 / FIGURES as f64;
            let y = top + ((1.0 - t) * (height - 1) as f64).round() as i64;
            paper.fill([left + WIDTH, y, 5, 1], INK);
            paper.label(&Paper::figure(at(t)), [(left + WIDTH + 9) as f32, (y + 5) as f32]);
        }
    }
}
