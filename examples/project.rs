//! Closest points on a set of CAD faces, and whether they are proven to be the closest: `cargo run --release --example project`

use cad::{FaceId, Group, Model, ReadOptions};
use glam::DVec3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cad = Model::read("fixtures/torus/torus.step".as_ref(), &ReadOptions::default())?;
    let group = Group::of_faces(&cad, &[FaceId::new(0)])?;
    for x in [DVec3::new(1.2, 0.3, 0.4), DVec3::new(0.9, -0.2, 0.0)] {
        if let Some(foot) = group.closest(x, None) {
            println!("{x} -> {} at distance {:.6}, proven: {}", foot.point, foot.distance, foot.is_proven());
        }
    }
    Ok(())
}
