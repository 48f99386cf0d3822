//! A mesh that was only certified, in words.

use std::fmt::{self, Display};

use super::{certificate, number};
use crate::report::CheckReport;

impl Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: P{}", self.mesh, self.order)?;
        for c in &self.cells {
            let (cell, count) = (c.cell, c.count);
            writeln!(f, "  {count} {cell}: {} valid, {} invalid, {} undecided", c.valid, c.invalid, c.undecided)?;
        }
        let scaled = self.certificate.scaled_jacobian;
        writeln!(f, "  smallest scaled Jacobian between {} and {}", number(scaled.lower), number(scaled.upper))?;
        #[cfg(feature = "cad")]
        if let Some(association) = &self.association {
            writeln!(f, "{association}")?;
        }
        for note in &self.notes {
            writeln!(f, "  note: {note}")?;
        }
        certificate(&self.certificate, self.certified, f)
    }
}
