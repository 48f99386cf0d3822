//! Letters and marks on finished pixels.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont};

use super::colour::{Colour, INK, MARK, WHITE};

/// The letters of the font Hack.
fn font() -> Option<FontRef<'static>> {
    FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR).ok()
}

/// Pixels by rows, three bytes each.
#[derive(Clone, Debug)]
pub(super) struct Paper {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// All bytes.
    pub bytes: Vec<u8>,
}

impl Paper {
    /// Covers a pixel, in part.
    fn cover(&mut self, x: i64, y: i64, colour: Colour, part: f32) {
        if x < 0 || y < 0 || x >= self.width as i64 || y >= self.height as i64 {
            return;
        }
        let place = 3 * (y as usize * self.width + x as usize);
        for (byte, own) in self.bytes[place..place + 3].iter_mut().zip(colour) {
            *byte = (f32::from(*byte) * (1.0 - part) + 255.0 * own * part).round() as u8;
        }
    }

    /// Fills a box of pixels: left, upper end, width, height.
    pub(super) fn fill(&mut self, [x, y, width, height]: [i64; 4], colour: Colour) {
        for row in y..y + height {
            (x..x + width).for_each(|column| self.cover(column, row, colour, 1.0));
        }
    }

    /// A line of text, its left end and base line given; returns its width.
    pub(super) fn write(&mut self, text: &str, [x, y]: [f32; 2], size: f32, colour: Colour) -> f32 {
        let Some(font) = font() else { return 0.0 };
        let scaled = font.as_scaled(PxScale::from(size));
        let mut at = x;
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            let glyph = id.with_scale_and_position(PxScale::from(size), ab_glyph::point(at, y));
            at += scaled.h_advance(id);
            let Some(outline) = font.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|column, row, part| {
                let [x, y] = [corner.x as i64 + i64::from(column), corner.y as i64 + i64::from(row)];
                self.cover(x, y, colour, part.clamp(0.0, 1.0));
            });
        }
        at - x
    }

    /// A line from point to point.
    pub(super) fn line(&mut self, from: [f32; 2], to: [f32; 2], width: f32, colour: Colour) {
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = along[0].hypot(along[1]).max(1e-6);
        let margin = width + 1.0;
        let away = |x: f32, y: f32| {
            let t = ((x - from[0]) * along[0] + (y - from[1]) * along[1]) / (length * length);
            let t = t.clamp(0.0, 1.0);
            (x - from[0] - t * along[0]).hypot(y - from[1] - t * along[1])
        };
        self.shape(
            [from[0].min(to[0]), from[1].min(to[1]), from[0].max(to[0]), from[1].max(to[1])],
            margin,
            colour,
            |x, y| width / 2.0 + 0.5 - away(x, y),
        );
    }

    /// A ring.
    pub(super) fn ring(&mut self, [x, y]: [f32; 2], radius: f32, width: f32, colour: Colour) {
        self.shape([x, y, x, y], radius + width, colour, |px, py| {
            width / 2.0 + 0.5 - ((px - x).hypot(py - y) - radius).abs()
        });
    }

    /// Covers pixels round a box by a function of their middles, 0 to 1.
    fn shape(
        &mut self,
        [left, top, right, bottom]: [f32; 4],
        margin: f32,
        colour: Colour,
        part: impl Fn(f32, f32) -> f32,
    ) {
        let range = |from: f32, to: f32, end: usize| {
            let clamp = |x: f32| x.clamp(-1.0, end as f32) as i64;
            clamp(from - margin)..=clamp(to + margin)
        };
        for row in range(top, bottom, self.height) {
            for column in range(left, right, self.width) {
                let own = part(column as f32 + 0.5, row as f32 + 0.5);
                if own > 0.0 {
                    self.cover(column, row, colour, own.min(1.0));
                }
            }
        }
    }

    /// A number with as many digits as figures of a picture need.
    pub(super) fn figure(x: f64) -> String {
        let size = x.abs();
        if x == 0.0 {
            "0".to_owned()
        } else if (1e-3..1e5).contains(&size) {
            let digits = (3 - size.log10().floor() as i32).clamp(0, 6) as usize;
            format!("{x:.digits$}")
        } else {
            format!("{x:.2e}")
        }
    }

    /// A number beside a mark, on whatever is there.
    pub(super) fn halo(&mut self, text: &str, [x, y]: [f32; 2]) {
        for (dx, dy) in [(-1.2, 0.0), (1.2, 0.0), (0.0, -1.2), (0.0, 1.2)] {
            self.write(text, [x + dx, y + dy], 14.0, WHITE);
        }
        self.write(text, [x, y], 14.0, MARK);
    }

    /// A label in ink.
    pub(super) fn label(&mut self, text: &str, at: [f32; 2]) {
        self.write(text, at, 13.0, INK);
    }
}
