//! Certifies a mesh of any order: `cargo run --release --example check -- MESH`

use sagitta::certify::{self, Settings};
use sagitta::formats;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or("fixtures/samples/prism_p3.cgns".into());
    let mesh = formats::read(path.as_ref())?;
    let certificate = certify::mesh(&mesh, mesh.points(), None, &Settings::default());
    let bounds = certificate.relative;
    println!("min J/Jc between {:.4} and {:.4}", bounds.lower, bounds.upper);
    let cells = mesh.cells();
    for judged in &certificate.failures {
        println!("not proven valid: {} {}", judged.cell, cells.get(judged.element).tag);
    }
    Ok(())
}
