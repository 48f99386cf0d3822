//! A patch curved by the library, and what became of it.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Instant;

use cad::ReadOptions;
use glam::DVec3;
use sagitta::curve::{Curved, Job, Observer, Step, curve};
use sagitta::element::Order;
use sagitta::smooth::{Progress, Summary};

use crate::case::Case;
use crate::patch::Patch;
use crate::sampling;

/// What became of a patch.
pub struct Outcome {
    pub case: Case,
    pub patch: Patch,
    /// Elements that are not proven valid.
    pub unproven: usize,
    /// Elements found invalid by sampling.
    pub inverted: usize,
    /// Middles of wall faces that are off the CAD, and the share of the displacement that they have left.
    pub given_up: Vec<(DVec3, f64)>,
    /// Before and after smoothing.
    pub quality: [Summary; 2],
    pub sweeps: usize,
    pub seconds: f64,
}

impl Outcome {
    /// Draws a patch, curves it and holds it against the candidates; its files go to `folder`.
    pub fn of(case: Case, folder: &Path) -> Outcome {
        let patch = Patch::draw(&case);
        let [cad, mesh] = files(&case, folder);
        patch.write(&cad, &mesh);
        let reading = ReadOptions { reader: env!("CARGO_BIN_EXE_sagitta").into(), ..ReadOptions::default() };
        let job = Job { reading, ..Job::new(mesh, cad, None, Order::new(case.order).unwrap()) };
        let start = Instant::now();
        let curved = curve(&job, &mut Silent).unwrap_or_else(|error| panic!("{case}: {error}"));
        Outcome {
            case,
            patch,
            unproven: curved.certificate.failures.len(),
            inverted: sampling::inverted(&curved.mesh).len(),
            given_up: given_up(&curved),
            quality: [curved.smoothed.start, curved.smoothed.end],
            sweeps: curved.smoothed.sweeps,
            seconds: start.elapsed().as_secs_f64(),
        }
    }

    /// Whether the patch is valid, by proof and by sampling, and on its CAD.
    pub fn is_good(&self) -> bool {
        self.unproven == 0 && self.inverted == 0 && self.given_up.is_empty()
    }
}

/// CAD file and mesh file of a case.
pub fn files(case: &Case, folder: &Path) -> [PathBuf; 2] {
    ["igs", "msh"].map(|extension| folder.join(format!("{}.{extension}", case.seed)))
}

fn given_up(curved: &Curved) -> Vec<(DVec3, f64)> {
    let middle = |face: usize| {
        let corners = &curved.boundary.corners[face];
        corners.iter().map(|n| curved.straight[n.index()]).sum::<DVec3>() / corners.len() as f64
    };
    curved.given_up.iter().map(|given| (middle(given.face), given.share)).collect()
}

struct Silent;

impl Observer for Silent {
    fn step(&mut self, _: Step) {}

    fn progress(&mut self, _: &Progress) -> bool {
        true
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Patch { sagitta, aspect_ratio, layers, transition, rejected, .. } = &self.patch;
        write!(
            f,
            "{}: sagitta {sagitta:6.1} spacings, aspect ratio {aspect_ratio:7.1}, {layers:2} layers, ",
            self.case
        )?;
        write!(f, "transition {transition:.3}, {rejected} rejected; C_WCN/C_JAC (inverted) ")?;
        let [start, end] = self.quality;
        write!(f, "{:.2}/{:.2} ({}) -> ", start.c_wcn, start.c_jac, start.inverted)?;
        write!(f, "{:.2}/{:.2} ({}) ", end.c_wcn, end.c_jac, end.inverted)?;
        write!(f, "in {} sweeps, {:.1} s", self.sweeps, self.seconds)?;
        if self.unproven + self.inverted > 0 {
            write!(f, "; {} elements not proven valid, {} found invalid", self.unproven, self.inverted)?;
        }
        if let Some((place, share)) = self.given_up.first() {
            let count = self.given_up.len();
            write!(f, "; {count} wall faces taken off the CAD, the elements on them would be invalid: at {place:.2}")?;
            write!(f, " {share:.2} of the displacement is left")?;
        }
        Ok(())
    }
}
