//! The small meshes of all cells, in `fixtures/samples`.

use glam::DVec3;
use sagitta::element::Order;
use sagitta::formats;
use sagitta::mesh::Mesh;
use sagitta::mesh::elevate::elevate;

use super::root;

pub fn sample(name: &str) -> Mesh {
    formats::read(&root().join("fixtures/samples").join(name)).unwrap()
}

/// A linear sample at an order, curved so that no edge is straight.
pub fn curved(name: &str, p: usize) -> Mesh {
    let mut mesh = elevate(&sample(name), Order::new(p).unwrap()).unwrap().mesh;
    for x in mesh.points_mut() {
        *x += 0.02 * DVec3::new((3.0 * x.y).sin(), (2.0 * x.z).cos(), (4.0 * x.x).sin());
    }
    mesh
}
