//! A canvas of samples with depth: triangles are drawn on it, several samples a pixel.

use std::array::from_fn;

use rayon::prelude::*;

use super::colour::{Colour, INK, WHITE, mixed};

/// Samples along each side of a pixel.
pub(super) const SAMPLES: usize = 3;

/// Rows of samples that one thread draws.
const BAND: usize = 24;

/// A triangle in the canvas' coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Triangle {
    /// Corners: samples to the right, samples down, depth away from the eye.
    pub corners: [[f32; 3]; 3],
    /// Colours at the corners, shaded.
    pub colours: [Colour; 3],
    /// How far each corner is beyond the plane that cuts; what is beyond is not drawn.
    pub beyond: [f32; 3],
    /// How dark the edge opposite each corner is drawn, 0 to 1.
    pub lines: [f32; 3],
}

/// Samples by rows.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    width: usize,
    height: usize,
    samples: Vec<Sample>,
}

#[derive(Clone, Copy, Debug)]
struct Sample {
    depth: f32,
    colour: Colour,
}

impl Canvas {
    /// An empty canvas of so many pixels.
    pub(super) fn new(width: usize, height: usize) -> Canvas {
        let [width, height] = [width, height].map(|pixels| pixels * SAMPLES);
        Canvas { width, height, samples: vec![Sample { depth: f32::INFINITY, colour: WHITE }; width * height] }
    }

    /// Draws triangles; what is nearer hides what is farther, of what is equally near the first stays.
    pub(super) fn draw(&mut self, triangles: &[Triangle]) {
        let (width, height) = (self.width, self.height);
        let mut bands: Vec<Vec<u32>> = vec![Vec::new(); height.div_ceil(BAND)];
        for (place, triangle) in triangles.iter().enumerate() {
            let ys = triangle.corners.map(|corner| corner[1]);
            let (low, high) = (ys[0].min(ys[1]).min(ys[2]), ys[0].max(ys[1]).max(ys[2]));
            if !(high >= 0.0 && low < height as f32) {
                continue;
            }
            let last = (high.min(height as f32 - 1.0) as usize) / BAND;
            (low.max(0.0) as usize / BAND..=last).for_each(|band| bands[band].push(place as u32));
        }
        self.samples.par_chunks_mut(BAND * width).zip(&bands).enumerate().for_each(|(band, (samples, own))| {
            for &place in own {
                fill(&triangles[place as usize], samples, width, band * BAND);
            }
        });
    }

    /// The pixels by rows, three bytes each.
    pub(super) fn pixels(&self) -> Vec<u8> {
        let row = |y: usize| {
            (0..self.width / SAMPLES).flat_map(move |x| {
                let mut sum = [0.0; 3];
                for sample in 0..SAMPLES * SAMPLES {
                    let at = (y * SAMPLES + sample / SAMPLES) * self.width + x * SAMPLES + sample % SAMPLES;
                    sum.iter_mut().zip(self.samples[at].colour).for_each(|(sum, own)| *sum += own);
                }
                sum.map(|x| (x / (SAMPLES * SAMPLES) as f32 * 255.0).round() as u8)
            })
        };
        (0..self.height / SAMPLES).flat_map(row).collect()
    }
}

/// Half the width of a line, in samples.
const HALF_LINE: f32 = 0.5 * SAMPLES as f32;

/// Draws a triangle on rows of samples, the first of which is row `top`.
fn fill(triangle: &Triangle, samples: &mut [Sample], width: usize, top: usize) {
    let [a, b, c] = triangle.corners;
    let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if twice.abs() <= 1e-9 || twice.is_nan() {
        return;
    }
    // Distance of each corner from the opposite edge, in samples.
    let length = |p: [f32; 3], q: [f32; 3]| (p[0] - q[0]).hypot(p[1] - q[1]);
    let heights = [length(b, c), length(c, a), length(a, b)].map(|edge| twice.abs() / edge.max(1e-9));
    let rows = samples.len() / width;
    let [low, high] = [f32::min, f32::max].map(|of: fn(f32, f32) -> f32| of(of(a[1], b[1]), c[1]) - top as f32 - 0.5);
    let [left, right] = [f32::min, f32::max].map(|of: fn(f32, f32) -> f32| of(of(a[0], b[0]), c[0]) - 0.5);
    let range = |from: f32, to: f32, end: usize| {
        from.ceil().max(0.0) as usize..(to.floor() + 1.0).clamp(0.0, end as f32) as usize
    };
    for row in range(low, high, rows) {
        let y = (top + row) as f32 + 0.5;
        for column in range(left, right, width) {
            let x = column as f32 + 0.5;
            let weight = |p: [f32; 3], q: [f32; 3]| ((q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])) / twice;
            let weights = [weight(b, c), weight(c, a), weight(a, b)];
            if weights.iter().any(|&own| own < 0.0) {
                continue;
            }
            let sum = |values: [f32; 3]| weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
            let depth = sum(triangle.corners.map(|corner| corner[2]));
            let sample = &mut samples[row * width + column];
            if depth >= sample.depth || sum(triangle.beyond) > 0.0 {
                continue;
            }
            let line = (0..3).map(|q| triangle.lines[q] * (HALF_LINE + 0.5 - weights[q] * heights[q]).clamp(0.0, 1.0));
            let colour = from_fn(|k| sum(triangle.colours.map(|colour| colour[k])));
            *sample = Sample { depth, colour: mixed(colour, INK, line.fold(0.0, f32::max)) };
        }
    }
}
