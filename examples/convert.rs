//! Reads a mesh in one format and writes it in another: `cargo run --release --example convert -- IN OUT`

use sagitta::formats::{self, WriteOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let from = arguments.next().unwrap_or("fixtures/sphere_shell/sphere_shell.msh".into());
    let to = arguments.next().map_or_else(|| std::env::temp_dir().join("sphere_shell.vtu"), Into::into);
    let mesh = formats::read(from.as_ref())?;
    formats::write(&to, &mesh, &WriteOptions::default())?;
    mesh.notes().iter().for_each(|note| println!("note: {note}"));
    println!("{from} -> {}", to.display());
    Ok(())
}
