//! Writes B-spline faces as an IGES file (entities 128), so that benchmarks and tests need no stored CAD.
#![allow(dead_code, unreachable_pub)] // each program includes it as a module of its own

use glam::DVec3;
use std::fmt::Write;

/// A cubic B-spline face by its poles, `u` fastest, on uniform clamped knots over 0..=1.
pub struct Patch {
    pub count: [usize; 2],
    pub poles: Vec<DVec3>,
}

impl Patch {
    /// Poles on a grid of `count` of a map from the unit square.
    pub fn sampled(count: [usize; 2], at: impl Fn(f64, f64) -> DVec3) -> Self {
        let fraction = |i: usize, n: usize| i as f64 / (n - 1) as f64;
        let poles = (0..count[1])
            .flat_map(|j| (0..count[0]).map(move |i| (i, j)))
            .map(|(i, j)| at(fraction(i, count[0]), fraction(j, count[1])))
            .collect();
        Self { count, poles }
    }

    /// Poles at the Greville abscissae: an affine map comes out as itself.
    pub fn at_greville(count: [usize; 2], at: impl Fn(f64, f64) -> DVec3) -> Self {
        let abscissae = |n: usize| -> Vec<f64> {
            let knots: Vec<f64> = knots(n).collect();
            (0..n).map(|i| knots[i + 1..i + 4].iter().sum::<f64>() / 3.0).collect()
        };
        let [us, vs] = count.map(abscissae);
        Self { count, poles: vs.iter().flat_map(|&v| us.iter().map(move |&u| (u, v))).map(|(u, v)| at(u, v)).collect() }
    }

    /// The face at parameters of 0..=1.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let ([i, j], [a, b]) =
            ([0, 1].map(|k| span(self.count[k], [u, v][k])), [blend(self.count[0], u), blend(self.count[1], v)]);
        let pole = |k: usize, l: usize| self.poles[(j + l) * self.count[0] + i + k];
        (0..4).flat_map(|l| (0..4).map(move |k| (k, l))).map(|(k, l)| pole(k, l) * (a[k] * b[l])).sum()
    }

    /// The parameter data of entity 128.
    fn record(&self) -> String {
        let [n, m] = self.count;
        let mut text = format!("128,{},{},3,3,0,0,1,0,0", n - 1, m - 1);
        let mut push = |value: f64| {
            let _ = write!(text, ",{value:?}"); // writing to a String cannot fail
        };
        knots(n).chain(knots(m)).for_each(&mut push);
        (0..n * m).for_each(|_| push(1.0));
        self.poles.iter().flat_map(|p| p.to_array()).for_each(&mut push);
        [0.0, 1.0, 0.0, 1.0].into_iter().for_each(&mut push);
        text + ";"
    }
}

fn knots(count: usize) -> impl Iterator<Item = f64> {
    let spans = (count - 3) as f64;
    (0..count + 4).map(move |i| ((i as f64 - 3.0) / spans).clamp(0.0, 1.0))
}

/// The first of the four poles that count at a parameter.
fn span(count: usize, t: f64) -> usize {
    ((t * (count - 3) as f64) as usize).min(count - 4)
}

/// Values there of the four B-splines that are not zero (de Boor).
fn blend(count: usize, t: f64) -> [f64; 4] {
    let knots: Vec<f64> = knots(count).collect();
    let first = span(count, t) + 3;
    let mut values = [1.0, 0.0, 0.0, 0.0];
    for degree in 1..4 {
        let mut rest = 0.0;
        for k in 0..degree {
            let (low, high) = (knots[first + k + 1 - degree], knots[first + k + 1]);
            let share = values[k] / (high - low);
            values[k] = rest + (high - t) * share;
            rest = (t - low) * share;
        }
        values[degree] = rest;
    }
    values
}

/// Cuts a record into lines of at most `width` columns, at commas.
fn wrapped(record: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for field in record.split_inclusive([',', ';']) {
        if lines[lines.len() - 1].len() + field.len() > width {
            lines.push(String::new());
        }
        let last = lines.len() - 1;
        lines[last].push_str(field);
    }
    lines
}

/// The file, in millimetres.
pub fn file(patches: &[Patch]) -> String {
    let mut text = format!("{:<72}S{:>7}\n", "patches", 1);
    let global = "1H,,1H;,7Hpatches,7Hpatches,7Hsagitta,7Hsagitta,32,38,6,308,15,7Hpatches,1.,2,2HMM,1,0.01,15H20260101.000000,\
                  1.E-7,1000.,0H,0H,11,0,15H20260101.000000;";
    let global = wrapped(global, 72);
    for (i, line) in global.iter().enumerate() {
        let _ = writeln!(text, "{line:<72}G{:>7}", i + 1);
    }
    let (mut directory, mut parameters) = (String::new(), String::new());
    let mut line_number = 0;
    for (i, patch) in patches.iter().enumerate() {
        let lines = wrapped(&patch.record(), 64);
        let entry = 2 * i + 1;
        let (start, count) = (line_number + 1, lines.len());
        let _ = writeln!(
            directory,
            "{:>8}{start:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}00000000D{entry:>7}",
            128, 0, 0, 0, 0, 0, 0
        );
        let _ = writeln!(
            directory,
            "{:>8}{:>8}{:>8}{count:>8}{:>8}{:>16}{:>8}{:>8}D{:>7}",
            128,
            0,
            0,
            0,
            "",
            "PATCH",
            i,
            entry + 1
        );
        for line in lines {
            line_number += 1;
            let _ = writeln!(parameters, "{line:<64} {entry:>7}P{line_number:>7}");
        }
    }
    text += &directory;
    text += &parameters;
    let count = (global.len(), 2 * patches.len(), line_number);
    let _ = writeln!(text, "S{:>7}G{:>7}D{:>7}P{:>7}{:>40}T{:>7}", 1, count.0, count.1, count.2, "", 1);
    text
}
