//! Colours: of values, of patches, of what stands out.

use std::array::from_fn;

/// Red, green, blue, 0 to 1, as they stand in the file (sRGB).
pub(super) type Colour = [f32; 3];

/// Paper.
pub(super) const WHITE: Colour = [1.0; 3];
/// Letters and the edges of elements.
pub(super) const INK: Colour = [0.12, 0.13, 0.16];
/// What stands out: the worst elements.
pub(super) const MARK: Colour = [0.86, 0.08, 0.24];
/// A value that must not be: 0 or less.
pub(super) const WRONG: Colour = [0.95, 0.10, 0.75];
/// No value.
pub(super) const NONE: Colour = [0.78, 0.79, 0.81];

/// The map viridis, as a polynomial of degree 6 that is within 0.013 of it: even steps of `t`, 0 to 1, are seen as even steps, also by those
/// who do not see red or green.
pub(super) fn viridis(t: f64) -> Colour {
    const C: [[f64; 3]; 7] = [
        [0.277_727_327_2, 0.005_407_344_5, 0.334_099_805_3],
        [0.105_093_043_1, 1.404_613_529_9, 1.384_590_162_6],
        [-0.330_861_828_7, 0.214_847_559_5, 0.095_095_163_0],
        [-4.634_230_499_0, -5.799_100_973_4, -19.332_440_956_3],
        [6.228_269_936_3, 14.179_933_366_8, 56.690_552_600_7],
        [4.776_384_997_7, -13.745_145_377_7, -65.353_032_633_4],
        [-5.435_455_855_9, 4.645_852_612_2, 26.312_435_249_6],
    ];
    let t = t.clamp(0.0, 1.0);
    from_fn(|k| C.iter().rev().fold(0.0, |sum, own| sum * t + own[k]).clamp(0.0, 1.0) as f32)
}

/// The colour of a patch by its place: hues a golden angle apart, of even lightness.
pub(super) fn of_patch(place: usize) -> Colour {
    let hue = (0.58 + place as f64 * 0.618_034).fract() * std::f64::consts::TAU;
    let lightness = [0.72, 0.80, 0.64][place % 3];
    let [a, b] = [0.11 * hue.cos(), 0.11 * hue.sin()];
    // From Oklab: B. Ottosson, https://bottosson.github.io/posts/oklab.
    let [l, m, s] = [
        lightness + 0.396_337_777_4 * a + 0.215_803_757_3 * b,
        lightness - 0.105_561_345_8 * a - 0.063_854_172_8 * b,
        lightness - 0.089_484_177_5 * a - 1.291_485_548 * b,
    ]
    .map(|x: f64| x.powi(3));
    let linear = [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701 * s,
    ];
    linear.map(|x| {
        let x = x.clamp(0.0, 1.0);
        if x <= 0.003_130_8 { (12.92 * x) as f32 } else { (1.055 * x.powf(1.0 / 2.4) - 0.055) as f32 }
    })
}

/// A part of the way from one colour to another.
pub(super) fn mixed(from: Colour, to: Colour, part: f32) -> Colour {
    from_fn(|k| from[k] + (to[k] - from[k]) * part)
}
