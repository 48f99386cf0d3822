//! A mesh that was only certified, in words.

use std::fmt::{self, Display};

use super::{certificate, number};
use crate::report::CheckReport;

impl Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        certificate(&self.certificate, self.certified, f)?;
        write!(f, "{}: P{}", self.mesh, self.order)?;
        for c in &self.cells {
            let (cell, count) = (c.cell, c.count);
            write!(f, "\n  {count} {cell}: {} valid, {} invalid, {} undecided", c.valid, c.invalid, c.undecided)?;
        }
        let scaled = self.certificate.scaled_jacobian;
        write!(f, "\n  smallest scaled Jacobian between {} and {}", number(scaled.lower), number(scaled.upper))?;
        #[cfg(feature = "cad")]
        if let Some(association) = &self.association {
            write!(f, "\n{association}")?;
        }
        self.notes.iter().try_for_each(|note| write!(f, "\n  note: {note}"))
    }
}
