//! The certificate of a mesh, as reports have it.

use schemars::JsonSchema;
use serde::Serialize;

use super::Bounds;
use crate::certify::{self, Certificate, Judged};
use crate::mesh::Mesh;

/// Elements listed as worst.
const LISTED: usize = 10;

/// The certificate of the whole mesh.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct CertificateReport {
    /// The smallest J / J_c of all elements whose J_c is positive.
    pub j_over_jc: Bounds,
    /// The smallest scaled Jacobian: smallest over largest determinant of an element.
    pub scaled_jacobian: Bounds,
    /// All elements that are not proven valid, and the ten valid ones with the smallest J / J_c, worst first.
    pub worst: Vec<ElementReport>,
}

/// An element to look at.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct ElementReport {
    /// Its number in the file.
    pub element: u64,
    /// `tet`, `pyramid`, `prism` or `hex`.
    pub cell: &'static str,
    /// What is proven of it.
    pub verdict: Verdict,
    /// Its smallest J / J_c.
    pub j_over_jc: Bounds,
    /// Where its smallest known Jacobian is.
    pub position: [f64; 3],
}

/// What is proven of an element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Its Jacobian is positive everywhere.
    Valid,
    /// Its Jacobian is not positive somewhere.
    Invalid,
    /// Neither.
    Undecided,
}

impl CertificateReport {
    /// A certificate with the file's element numbers.
    #[must_use]
    pub fn new(mesh: &Mesh, certificate: &Certificate) -> CertificateReport {
        let cells = mesh.cells();
        let element = |judged: &Judged| ElementReport::new(cells.get(judged.element).tag, judged);
        let weakest = certificate.worst_relative.iter().filter(|j| j.finding.verdict.is_valid()).take(LISTED);
        CertificateReport {
            j_over_jc: certificate.relative.into(),
            scaled_jacobian: certificate.scaled.into(),
            worst: certificate.failures.iter().chain(weakest).map(element).collect(),
        }
    }

    /// The elements that are not proven valid.
    pub fn failures(&self) -> impl Iterator<Item = &ElementReport> {
        self.worst.iter().filter(|element| element.verdict != Verdict::Valid)
    }
}

impl ElementReport {
    fn new(number: u64, judged: &Judged) -> ElementReport {
        ElementReport {
            element: number,
            cell: judged.cell.name(),
            verdict: judged.finding.verdict.into(),
            j_over_jc: judged.finding.relative.into(),
            position: judged.place.to_array(),
        }
    }
}

impl From<certify::Verdict> for Verdict {
    fn from(verdict: certify::Verdict) -> Verdict {
        match verdict {
            certify::Verdict::Valid => Verdict::Valid,
            certify::Verdict::Invalid { .. } => Verdict::Invalid,
            certify::Verdict::Undecided => Verdict::Undecided,
        }
    }
}

impl Verdict {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Valid => "valid",
            Verdict::Invalid => "invalid",
            Verdict::Undecided => "undecided",
        }
    }
}
