//! Measures of the elements in figures: percentiles and histograms by kind of cell, and the elements to look at first.

use schemars::JsonSchema;
use serde::Serialize;

use super::finite;
use crate::element::Cell;
use crate::mesh::{Elements, Mesh};
use crate::scene::Measures;

/// Elements listed as lowest.
const LISTED: usize = 50;

/// Bars of a histogram.
const BARS: usize = 40;

/// Percentages of elements for which the value is given that they do not exceed.
const PERCENTS: [f64; 9] = [0.0, 0.1, 1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 100.0];

/// One measure of the elements of one kind.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct MeasureReport {
    /// `J/J_c` and `scaled Jacobian` (proven lower bounds of every element, those of the scaled Jacobian less sharp than the certificate's),
    /// `C_WCN`, `C_JAC` (a survey).
    pub measure: &'static str,
    /// `tet`, `pyramid`, `prism` or `hex`; in the plane `triangle` or `quad`.
    pub cell: &'static str,
    /// Elements with a value.
    pub count: usize,
    /// Elements without one, as nothing is proven of them.
    pub unknown: usize,
    /// Mean value; nothing where there is none.
    pub mean: Option<f64>,
    /// Values that so many percent of the elements do not exceed; 0 is the smallest, 100 the largest value.
    pub percentiles: Vec<Percentile>,
    /// How the values are spread.
    pub histogram: Histogram,
}

/// The value that a part of the elements do not exceed.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
#[allow(missing_docs)] // the names say it
pub struct Percentile {
    pub percent: f64,
    pub value: f64,
}

/// Counts of values in bars of even width.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Histogram {
    /// Lower end of the first bar.
    pub from: f64,
    /// Upper end of the last bar.
    pub to: f64,
    /// Elements in each bar; those at an inner end are in the upper bar, those beyond the ends in the first and last.
    pub counts: Vec<usize>,
}

/// An element with all its measures.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct LowElement {
    /// Its number in the file.
    pub element: u64,
    /// Its kind.
    pub cell: &'static str,
    /// Proven lower bound of its J / J_c.
    pub j_over_jc: Option<f64>,
    /// Proven lower bound of its scaled Jacobian.
    pub scaled_jacobian: Option<f64>,
    /// Its worst `C_WCN`.
    pub c_wcn: Option<f64>,
    /// Its worst `C_JAC`.
    pub c_jac: Option<f64>,
    /// Its middle: the mean of its corners.
    pub position: [f64; 3],
}

/// Every measure of every kind of cell that there is.
pub(super) fn spread(mesh: &Mesh, measures: &Measures) -> Vec<MeasureReport> {
    let cells = mesh.cells();
    let kinds: Vec<Cell> = mesh.counts().into_keys().filter(|cell| cell.dimension() == mesh.dimension()).collect();
    let of = |cell: Cell| measures.named().map(|(measure, values)| of_kind(&cells, cell, measure, values));
    kinds.into_iter().flat_map(of).collect()
}

fn of_kind(cells: &Elements, cell: Cell, measure: &'static str, values: &[f64]) -> MeasureReport {
    let own = cells.iter().zip(values).filter(|(own, _)| own.cell == cell);
    let all: Vec<f64> = own.map(|(_, &value)| value).collect();
    let mut known: Vec<f64> = all.iter().copied().filter(|value| value.is_finite()).collect();
    known.sort_unstable_by(f64::total_cmp);
    let at = |percent: f64| {
        let rank = (percent / 100.0 * known.len() as f64).ceil() as usize;
        known.get(rank.saturating_sub(1)).map(|&value| Percentile { percent, value })
    };
    MeasureReport {
        measure,
        cell: cell.name(),
        count: known.len(),
        unknown: all.len() - known.len(),
        mean: (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64),
        percentiles: PERCENTS.iter().filter_map(|&percent| at(percent)).collect(),
        histogram: Histogram::of(&known),
    }
}

impl Histogram {
    /// Of rising values: from the least, or the last full tenth below it, to 1.
    fn of(known: &[f64]) -> Histogram {
        let least = known.first().copied().unwrap_or(0.0);
        let from = ((least * 10.0).floor() / 10.0).clamp(-1.0, 0.9);
        let mut counts = vec![0; BARS];
        for &value in known {
            let bar = (value - from) / (1.0 - from) * BARS as f64;
            counts[(bar.max(0.0) as usize).min(BARS - 1)] += 1;
        }
        Histogram { from, to: 1.0, counts }
    }
}

/// The elements with the smallest J / J_c, worst first; where that is the same the smaller `C_WCN` decides.
pub(super) fn lowest(mesh: &Mesh, measures: &Measures) -> Vec<LowElement> {
    let cells = mesh.cells();
    let value = |values: &[f64], place: usize| values.get(place).copied().and_then(finite);
    let low = |place: usize| {
        let own = cells.get(cells.id(place));
        let corners = own.corners();
        LowElement {
            element: own.tag,
            cell: own.cell.name(),
            j_over_jc: value(&measures.j_over_jc, place),
            scaled_jacobian: value(&measures.scaled_jacobian, place),
            c_wcn: value(&measures.c_wcn, place),
            c_jac: value(&measures.c_jac, place),
            position: (mesh.points_of(corners).sum::<glam::DVec3>() / corners.len() as f64).to_array(),
        }
    };
    measures.worst(LISTED).into_iter().map(low).collect()
}
