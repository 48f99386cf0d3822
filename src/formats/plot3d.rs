//! PLOT3D.
use std::path::Path;
pub(super) fn is_name(_: &Path) -> bool {
    false
}
