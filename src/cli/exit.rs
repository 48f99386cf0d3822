//! Exit codes.

/// Done, everything certified and on the CAD.
pub(super) const DONE: u8 = 0;
/// A linkage file has findings.
pub(super) const FINDINGS: u8 = 1;
/// Wrong use or bad input: nothing was written.
pub(super) const COULD_NOT_RUN: u8 = 2;
/// Certified, but some boundary faces are off the CAD.
pub(super) const OFF_CAD: u8 = 3;
/// Not every element is proven valid, or not every face on the CAD where that is required.
pub(super) const NOT_CERTIFIED: u8 = 4;
/// Ended before it was done; certified. Faces may be off the CAD.
pub(super) const STOPPED: u8 = 5;
/// Done as with [`DONE`], but a file beside the result, or standard output, could not be written.
pub(super) const SIDE_FILE: u8 = 6;
/// Interrupted before there was anything to keep, or twice: ended at once, without a result.
pub(super) const INTERRUPTED: u8 = 130;

/// What a code means, for the help.
pub(super) fn meaning(code: u8) -> &'static str {
    match code {
        DONE => "done; what is proven or checked holds",
        FINDINGS => "the linkage file has errors or warnings (validate)",
        COULD_NOT_RUN => "could not run: wrong options or bad input; nothing is written",
        OFF_CAD => "certified, but some boundary faces are off the CAD (curve)",
        NOT_CERTIFIED => "not all is proven (project: closest points), or --require-all is not met",
        STOPPED => "stopped early: limit or interrupt; certified, faces as with 3 (curve)",
        SIDE_FILE => "as 0, but a file beside the result, or stdout, was not written (told)",
        _ => "interrupted while reading, or twice: ended at once, without a result",
    }
}
