//! Smoothing of a level, its boundary kept on the CAD.

use super::level::Level;
use super::wall::CadConstraint;
use crate::smooth::{self, Begin, Problem, Smoothed, Watch};

/// Smooths the curved coordinates; wall nodes that are off the CAD are held where they are.
pub(super) fn smooth_level(
    level: &mut Level,
    settings: &smooth::Settings,
    begin: Begin,
    watch: &mut dyn Watch,
) -> Smoothed {
    let Level { case, elevated, curved, wall, periodic } = level;
    let constraint = CadConstraint::new(*case, elevated, wall, periodic);
    let problem = Problem::new(&elevated.mesh, elevated.mesh.points());
    smooth::smooth(&problem, &constraint, settings, curved, begin, watch)
}
