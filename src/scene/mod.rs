//! What is to be seen of a mesh: its boundary faces with the elements behind them, what frames them, the measures of its elements, and the
//! sections of planes. Pictures and pages are made of it.

mod distance;
mod framing;
mod measures;
mod section;
mod surface;

pub use distance::{face_distances, samples};
pub use framing::outer;
pub use measures::Measures;
pub use section::{Axis, CutPlane, Section, section};
pub use surface::{Patch, Shown, Surface};
