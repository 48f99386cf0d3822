//! Airfoils from coordinate files: Selig's and Lednicer's order, either direction, sharp or blunt, and their curves as STEP.

use std::path::Path;

use glam::DVec2;
use opencascade_sys as sys;
use thiserror::Error;

/// Fewest points of an airfoil.
const FEWEST: usize = 7;
/// Points nearer to each other than this fraction of the airfoil's size are one.
const SAME: f64 = 1e-7;
/// Trailing edges farther open than this fraction of the size are no trailing edges.
const OPEN: f64 = 0.3;
/// Coordinates beyond this are counts of points, as Lednicer's files have in their first line.
const COUNT: f64 = 1.5;

/// The points of an airfoil: from the trailing edge over the upper side to the nose and back below, counterclockwise. Where the trailing edge is
/// sharp its point stands first and last.
#[derive(Clone, Debug, PartialEq)]
pub struct Airfoil {
    points: Vec<DVec2>,
    nose: usize,
}

/// Why coordinates are no airfoil, or were not written.
#[derive(Debug, Error)]
pub enum AirfoilError {
    /// Not enough points.
    #[error("has {found} points that differ; an airfoil has {FEWEST} at least, two numbers a line")]
    Few {
        /// How many there are.
        found: usize,
    },
    /// Its ends are apart.
    #[error(
        "the first and the last point are {gap:.3} apart, {share:.0} % of the airfoil's size: no trailing edge is so thick; give the points in order round"
    )]
    Open {
        /// Their distance.
        gap: f64,
        /// In percent of the size.
        share: f64,
    },
    /// OCCT made no curves, or wrote no file.
    #[error("no STEP file of its curves: {0}")]
    Curves(String),
}

impl Airfoil {
    /// Reads coordinates: two numbers a line, separated by blanks, tabs, commas or semicolons; other lines are passed over.
    ///
    /// # Errors
    /// [`AirfoilError::Few`], [`AirfoilError::Open`].
    pub fn from_text(text: &str) -> Result<Airfoil, AirfoilError> {
        let mut rows: Vec<DVec2> = text.lines().filter_map(row).collect();
        if let Some(&first) = rows.first().filter(|first| first.min_element() > COUNT) {
            let whole = (first - first.round()).abs().max_element() < 1e-9;
            let rest = &rows[1..];
            if whole && (first.element_sum() - rest.len() as f64).abs() <= 1.0 {
                let (upper, lower) = rest.split_at((first.x as usize).min(rest.len()));
                rows = upper.iter().rev().chain(lower).copied().collect();
            } else if rest.iter().all(|row| row.abs().max_element() < COUNT) {
                rows.remove(0);
            }
        }
        Airfoil::through(&rows)
    }

    fn through(rows: &[DVec2]) -> Result<Airfoil, AirfoilError> {
        let low = rows.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = rows.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let size = (high - low).max_element();
        let mut points: Vec<DVec2> = Vec::new();
        for &row in rows {
            if points.last().is_none_or(|last| last.distance(row) > SAME * size) {
                points.push(row);
            }
        }
        if points.len() < FEWEST {
            return Err(AirfoilError::Few { found: points.len() });
        }
        let ends = |points: &[DVec2]| (points[0], points[points.len() - 1]);
        let gap = |points: &[DVec2]| ends(points).0.distance(ends(points).1);
        // A loop that begins elsewhere is turned to begin at its trailing edge, the point farthest downstream.
        if gap(&points) <= SAME * size {
            points.pop();
            let first = (0..points.len()).max_by(|&a, &b| points[a].x.total_cmp(&points[b].x)).unwrap_or(0);
            points.rotate_left(first);
            points.push(points[0]);
        }
        let gap = gap(&points);
        if gap > OPEN * size {
            return Err(AirfoilError::Open { gap, share: 100.0 * gap / size });
        }
        let twice_area: f64 = points.windows(2).map(|pair| pair[0].perp_dot(pair[1])).sum::<f64>();
        if twice_area + ends(&points).1.perp_dot(ends(&points).0) < 0.0 {
            points.reverse();
        }
        let tail = 0.5 * (ends(&points).0 + ends(&points).1);
        let inner = 1..points.len() - 1;
        let far = |&a: &usize, &b: &usize| points[a].distance(tail).total_cmp(&points[b].distance(tail));
        let nose = inner.max_by(far).unwrap_or(1);
        Ok(Airfoil { points, nose })
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[DVec2] {
        &self.points
    }

    /// Whether the trailing edge is sharp.
    #[must_use]
    pub fn is_sharp(&self) -> bool {
        self.points.first() == self.points.last()
    }

    /// Writes the C2 spline through the points as STEP, in mm: its upper and its lower side, which meet at the nose, and the base of a blunt
    /// trailing edge; curves without a face.
    ///
    /// # Errors
    /// [`AirfoilError::Curves`].
    pub fn write_step(&self, path: &Path) -> Result<(), AirfoilError> {
        let coordinates: Vec<f64> = self.points.iter().flat_map(|point| point.to_array()).collect();
        let written = sys::write_airfoil(&path.to_string_lossy(), &coordinates, self.nose);
        written.map_err(|error| AirfoilError::Curves(error.what().to_owned()))
    }
}

/// The two numbers of a line.
fn row(line: &str) -> Option<DVec2> {
    let separated = line.split(|c: char| c.is_whitespace() || ",;()".contains(c)).filter(|word| !word.is_empty());
    let words: Vec<&str> = separated.collect();
    let (x, y) = match words[..] {
        [x, y] | [x, y, _] => (x.parse().ok()?, y.parse().ok()?),
        _ => return None,
    };
    Some(DVec2::new(x, y)).filter(|row| row.is_finite())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Upper side from the trailing edge to the nose, and the lower one back.
    const SELIG: &str = "THICK 1\n1.0 0.0\n0.7 0.08\n0.3 0.1\n0.0 0.0\n0.3 -0.06\n0.7 -0.05\n1.0 0.0\n";

    #[test]
    fn every_way_to_write_it_is_the_same_airfoil() {
        let expected = Airfoil::from_text(SELIG).unwrap();
        assert!(expected.is_sharp() && expected.points()[expected.nose] == DVec2::ZERO);
        let rows: Vec<&str> = SELIG.lines().skip(1).collect();
        let joined = |rows: &[&str]| rows.join("\n");
        let reversed: Vec<&str> = rows.iter().rev().copied().collect();
        let doubled: Vec<&str> = rows.iter().flat_map(|row| [*row, *row]).collect();
        let elsewhere: Vec<&str> = rows[2..].iter().chain(&rows[1..3]).copied().collect();
        let upper: Vec<&str> = rows[..4].iter().rev().copied().collect();
        let lednicer = format!("NAME\n 4. 4.\n\n{}\n\n{}\n", joined(&upper), joined(&rows[3..]));
        let commas = joined(&rows).replace(' ', ",\t");
        for text in [joined(&reversed), joined(&doubled), joined(&elsewhere), lednicer, commas] {
            assert_eq!(Airfoil::from_text(&text).unwrap(), expected, "{text}");
        }
    }

    #[test]
    fn what_is_no_airfoil_is_told() {
        assert!(matches!(Airfoil::from_text("NACA\n1 0\n0 0\n"), Err(AirfoilError::Few { found: 2 })));
        let half = "1 0\n.8 .1\n.6 .12\n.4 .12\n.2 .1\n.1 .06\n0 0\n";
        assert!(matches!(Airfoil::from_text(half), Err(AirfoilError::Open { .. })));
    }
}
