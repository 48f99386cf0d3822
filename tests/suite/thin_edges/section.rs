//! Thin cambered plates and vanes, by formula: chord 1 at the root, span 1.
//!
//! ```text
//!         ___upper___
//!      .-´           `-.        camber line, and half the thickness on either side of it along its normal
//!    (´_.-´ lower `-._  `-.
//!                      `-._)    blunt: the thickness stays; sharp: it goes to 0 over the last tenth
//! ```

use glam::{DVec2, DVec3};

use crate::common::iges::Patch;

/// Poles of a side along chord and span.
const POLES: [usize; 2] = [61, 6];

/// Where a sharp edge begins to taper, and where the thick part of a vane ends.
const TAPER: f64 = 0.9;
const NOSE: f64 = 0.6;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camber {
    Arc,
    /// Convex on the upper side in front, on the lower side behind.
    Reflexed,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// Of one thickness, straight in the span.
    Plate,
    /// With a thick nose, tapered and twisted along the span.
    Vane,
}

#[derive(Clone, Copy, Debug)]
pub struct Section {
    pub form: Form,
    pub camber: Camber,
    /// Height of the camber line, share of the chord.
    pub height: f64,
    /// Thickness at the trailing edge (where a sharp one begins to taper), share of the chord.
    pub thickness: f64,
    pub sharp: bool,
}

/// All cases of the suite.
pub fn sections() -> Vec<Section> {
    let mut all = Vec::new();
    for form in [Form::Plate, Form::Vane] {
        for camber in [Camber::Arc, Camber::Reflexed] {
            for height in [0.05, 0.1, 0.15] {
                for thickness in [0.0005, 0.001, 0.002, 0.005] {
                    all.extend([false, true].map(|sharp| Section { form, camber, height, thickness, sharp }));
                }
            }
        }
    }
    all
}

impl std::fmt::Display for Section {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (form, camber) = (format!("{:?}", self.form).to_lowercase(), format!("{:?}", self.camber).to_lowercase());
        let end = if self.sharp { "sharp" } else { "blunt" };
        write!(f, "{form:<5} {camber:<8} camber {:>2.0} %, {:.2} % {end}", 100.0 * self.height, 100.0 * self.thickness)
    }
}

impl Section {
    /// Height of the camber line over the chord.
    fn line(&self, x: f64) -> f64 {
        match self.camber {
            Camber::Arc => {
                let radius = (0.25 + self.height * self.height) / (2.0 * self.height);
                (radius * radius - (x - 0.5) * (x - 0.5)).sqrt() - (radius - self.height)
            }
            // its largest value over 0..=1 is 0.0963
            Camber::Reflexed => self.height / 0.0963 * x * (1.0 - x) * (0.75 - x),
        }
    }

    fn half_thickness(&self, x: f64) -> f64 {
        let nose = (1.0 - x / NOSE).max(0.0).powi(2) * x.sqrt();
        let own = 0.5 * self.thickness + if self.form == Form::Vane { 0.07 * nose } else { 0.0 };
        if self.sharp && x > TAPER { own * (1.0 - x) / (1.0 - TAPER) } else { own }
    }

    /// A point of the section: `side` is 1 on the upper side, -1 on the lower, between inside.
    fn point(&self, x: f64, side: f64) -> DVec2 {
        let h = 1e-6;
        let (a, b) = ((x - h).max(0.0), (x + h).min(1.0));
        let along = DVec2::new(b - a, self.line(b) - self.line(a)).normalize();
        DVec2::new(x, self.line(x)) + side * self.half_thickness(x) * along.perp()
    }

    /// A point of the body: `x` along the chord, `s` along the span.
    fn place(&self, x: f64, s: f64, side: f64) -> DVec3 {
        let p = self.point(x, side);
        let (chord, twist) = if self.form == Form::Vane { (1.0 - 0.3 * s, 0.15 * s) } else { (1.0, 0.0) };
        let turned = chord * DVec2::from_angle(twist).rotate(p);
        DVec3::new(turned.x + 0.2 * s, s, turned.y)
    }

    /// Upper side, lower side (chord first, span second), strip at the nose and, where blunt, at the trailing edge.
    pub fn patches(&self) -> Vec<Patch> {
        let side = |side: f64| Patch::sampled(POLES, move |x, s| self.place(x, s, side));
        let strip = |x: f64| Patch::sampled([4, POLES[1]], move |t, s| self.place(x, s, 1.0 - 2.0 * t));
        let mut patches = vec![side(1.0), side(-1.0), strip(0.0)];
        if !self.sharp {
            patches.push(strip(1.0));
        }
        patches
    }
}
