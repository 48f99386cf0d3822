//! A patch curved by the library, and what became of it.

use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use sagitta::curve::recover::Departure;
use sagitta::curve::{Curved, Job};
use sagitta::element::Order;
use sagitta::smooth::Summary;

use crate::viscous_patches::case::Case;
use crate::viscous_patches::patch::Patch;
use crate::viscous_patches::sampling;

/// What became of a patch.
pub struct Outcome {
    pub case: Case,
    pub patch: Patch,
    /// Elements that are not proven valid.
    pub unproven: usize,
    /// Elements found invalid by sampling.
    pub inverted: usize,
    /// Middles of wall faces that are off the CAD, and the share of the displacement that they have left.
    pub off_cad: Vec<(DVec3, Departure)>,
    /// Before and after smoothing.
    pub quality: [Summary; 2],
    pub sweeps: usize,
    pub seconds: f64,
}

impl Outcome {
    /// Draws a patch, curves it and holds it against what is claimed; its files go to `folder`.
    pub fn of(case: Case, folder: &Path) -> Outcome {
        let patch = Patch::draw(&case);
        let [cad, mesh] = files(&case, folder);
        patch.write(&cad, &mesh);
        let job = Job::new(mesh, cad, None, Order::new(case.order).unwrap());
        let start = Instant::now();
        let curved = job.run(&mut ()).unwrap_or_else(|error| panic!("{case}: {error}"));
        Outcome {
            case,
            patch,
            unproven: curved.certificate.failures.len(),
            inverted: sampling::inverted(&curved.mesh).len(),
            off_cad: off_cad(&curved),
            quality: [curved.smoothed.start, curved.smoothed.end],
            sweeps: curved.smoothed.sweeps,
            seconds: start.elapsed().as_secs_f64(),
        }
    }

    /// Whether the patch is valid, by proof and by sampling, and on its CAD.
    pub fn is_good(&self) -> bool {
        self.unproven == 0 && self.inverted == 0 && self.off_cad.is_empty()
    }
}

/// CAD file and mesh file of a case.
pub fn files(case: &Case, folder: &Path) -> [PathBuf; 2] {
    ["igs", "msh"].map(|extension| folder.join(format!("{}.{extension}", case.seed)))
}

fn off_cad(curved: &Curved) -> Vec<(DVec3, Departure)> {
    let middle = |face: usize| {
        let corners = &curved.boundary.corners[face];
        corners.iter().map(|n| curved.straight[n.index()]).sum::<DVec3>() / corners.len() as f64
    };
    curved.off_cad.iter().map(|off| (middle(off.face), off.departure)).collect()
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
        if let Some((place, departure)) = self.off_cad.first() {
            let count = self.off_cad.len();
            write!(f, "; {count} wall faces off the CAD, the elements on them would be invalid: at {place:.2}")?;
            write!(f, " {departure:?}")?;
        }
        Ok(())
    }
}
