//! The certificate of a mesh, in the numbers of its file.

use std::fmt;

use serde::Serialize;

use crate::certify::{Certificate, Judged, Verdict};
use crate::mesh::Mesh;

/// Elements listed as worst, and failures listed in words.
const LISTED: usize = 10;

/// The certificate of the whole mesh.
#[derive(Clone, Debug, Serialize)]
pub struct CertificateReport {
    /// Smallest J / J_c: proven lower bound, and a value that is attained.
    pub relative: [f64; 2],
    /// Smallest scaled Jacobian, likewise.
    pub scaled: [f64; 2],
    /// The elements with the smallest J / J_c, worst first, and all that are not proven valid.
    pub worst: Vec<WorstElement>,
}

/// An element to look at.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct WorstElement {
    /// Its number in the file.
    pub element: u64,
    /// Its kind.
    pub cell: &'static str,
    /// `valid`, `invalid` or `undecided`.
    pub verdict: &'static str,
    /// Bounds of its smallest J / J_c.
    pub relative: [f64; 2],
    /// Where its smallest known Jacobian is.
    pub place: [f64; 3],
}

impl CertificateReport {
    /// A certificate with the file's element numbers.
    #[must_use]
    pub fn new(mesh: &Mesh, certificate: &Certificate) -> CertificateReport {
        let tags: Vec<u64> = mesh.blocks_of(3).flat_map(|(_, block)| block.tags.iter().copied()).collect();
        let worst = |judged: &Judged| WorstElement {
            element: tags[judged.element],
            cell: judged.cell.name(),
            verdict: match judged.finding.verdict {
                Verdict::Valid => "valid",
                Verdict::Invalid { .. } => "invalid",
                Verdict::Undecided => "undecided",
            },
            relative: [judged.finding.relative.lower, judged.finding.relative.upper],
            place: judged.place.to_array(),
        };
        let weakest = certificate.worst_relative.iter().filter(|j| j.finding.verdict.is_valid()).take(LISTED);
        CertificateReport {
            relative: [certificate.relative.lower, certificate.relative.upper],
            scaled: [certificate.scaled.lower, certificate.scaled.upper],
            worst: certificate.failures.iter().chain(weakest).map(worst).collect(),
        }
    }

    /// The verdict in words.
    pub(super) fn verdict(&self, certified: bool, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [lower, upper] = self.relative;
        if certified {
            return write!(f, "certified: every element valid, J/Jc >= {lower:.4} everywhere (attained: {upper:.4})");
        }
        let failures = || self.worst.iter().filter(|w| w.verdict != "valid");
        write!(f, "NOT certified: {} elements", failures().count())?;
        for w in failures().take(LISTED) {
            let [x, y, z] = w.place;
            write!(f, "\n  {} {} {} near ({x:.6}, {y:.6}, {z:.6})", w.verdict, w.cell, w.element)?;
        }
        Ok(())
    }
}
