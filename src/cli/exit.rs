//! Exit codes.

/// Done, everything certified and on the CAD.
pub(super) const DONE: u8 = 0;
/// A linkage file has findings.
pub(super) const FINDINGS: u8 = 1;
/// Wrong use or bad input: nothing was written.
pub(super) const COULD_NOT_RUN: u8 = 2;
/// Certified, but some boundary faces are not on the CAD as they should be.
pub(super) const GIVEN_UP: u8 = 3;
/// Not every element is proven valid.
pub(super) const NOT_CERTIFIED: u8 = 4;
/// Ended before it was done; certified.
pub(super) const STOPPED: u8 = 5;
/// Interrupted twice: ended at once, nothing was written.
pub(super) const INTERRUPTED: u8 = 130;
