//! Curves a mesh in memory: the weeble of the fixtures at P3. `cargo run --release --example curve_in_memory`

use cad::{Model, ReadOptions};
use sagitta::curve::{Settings, curve};
use sagitta::element::Order;
use sagitta::formats;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mesh = formats::read("fixtures/weeble/weeble.msh".as_ref())?;
    let cad = Model::read("fixtures/weeble/weeble.step".as_ref(), &ReadOptions::default())?;
    let curved = curve(mesh, &cad, None, &Settings::new(Order::new(3)?), &mut ())?;
    assert!(curved.is_certified() && curved.off_cad.is_empty());
    println!("{} nodes, J/Jc proven >= {:.3}", curved.mesh.points().len(), curved.certificate.relative.lower);
    Ok(())
}
