//! Which format a mesh file is in: by its content, and by its name where the content has no mark of its own.

use super::detect::{Head, Refusal, Verdict};
use super::foreign;
use super::format::Format;
use super::registry::{REGISTRY, readable};

/// The format of a file; else what to tell the user. Marks in the content come before names.
pub(super) fn detect(head: &Head) -> Result<&'static Format, Refusal> {
    if head.bytes.is_empty() {
        return Err(Refusal::other("the file is empty"));
    }
    let mut by_name = None;
    for &format in REGISTRY {
        match (format.detect)(head) {
            Verdict::ByContent => return Ok(format),
            Verdict::Refused(refusal) => return Err(refusal),
            Verdict::ByName => by_name = by_name.or(Some(format)),
            Verdict::No => {}
        }
    }
    if let Some(refusal) = foreign::refusal(head) {
        return Err(refusal);
    }
    by_name.ok_or_else(|| Refusal::other(format!("not a mesh file of a known format; {} are read", readable("and"))))
}
