//! Layers over the wall: their heights, which grow geometrically, and their points.

use glam::DVec3;

use crate::common::random::Random;
use crate::viscous_patches::wall::Grid;

/// Height of all layers together, in edge lengths.
const HEIGHT: f64 = 1.0;
/// Least and largest number of layers.
const LAYERS: [usize; 2] = [8, 16];
/// Largest growth from one layer to the next.
const GROWTH: f64 = 1.8;

/// Distances of the layers from the wall, the wall's 0 first: the first spacing is `spacing`.
pub fn heights(spacing: f64, random: &mut Random) -> Vec<f64> {
    let most = |n: usize| spacing * (GROWTH.powi(n as i32) - 1.0) / (GROWTH - 1.0);
    let [least, largest] = LAYERS;
    let least = (least..largest).find(|&n| most(n) >= HEIGHT).unwrap_or(largest);
    let layers = least + random.below(largest + 1 - least);
    let sum = |growth: f64| (0..layers).map(|k| spacing * growth.powi(k as i32)).sum::<f64>();
    let (mut low, mut high) = (0.1, 3.0);
    while high - low > 1e-12 {
        let growth = 0.5 * (low + high);
        *if sum(growth) < HEIGHT { &mut low } else { &mut high } = growth;
    }
    let mut heights = vec![0.0];
    for k in 0..layers {
        heights.push(heights[k] + spacing * low.powi(k as i32));
    }
    heights
}

/// Points of all layers, the wall first: columns along the wall's normals, which turn upwards with the height.
pub fn extrude(grid: &Grid, wall: &[DVec3], heights: &[f64]) -> Vec<DVec3> {
    let normals = grid.normals(wall);
    let point = |height: f64, column: usize| {
        let direction = normals[column].lerp(DVec3::Z, height / HEIGHT).normalize();
        wall[column] + height * direction
    };
    heights
        .iter()
        .flat_map(|&height| (0..wall.len()).map(move |column| (height, column)))
        .map(|(h, c)| point(h, c))
        .collect()
}
