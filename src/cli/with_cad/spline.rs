//! `sagitta spline`.

use std::path::PathBuf;

use cad::Airfoil;
use clap::Args;

use crate::cli::exit::DONE;
use crate::cli::files::Files;
use crate::cli::output::{Beside, Failure, print};
use crate::cli::signals;
use crate::formats;

/// Options of `sagitta spline`.
#[derive(Args)]
pub(in crate::cli) struct Options {
    /// Coordinates of an airfoil, two a line, in Selig's or Lednicer's order
    coordinates: PathBuf,
    /// STEP file for its curves
    #[arg(short, long, value_name = "FILE.step")]
    output: PathBuf,
}

/// Interpolates the coordinates, writes the curves, and says what they are.
pub(super) fn run(options: &Options) -> Result<u8, Failure> {
    let Options { coordinates, output } = options;
    Files::default().reads("the coordinates", Some(coordinates)).writes("--output", Some(output)).check()?;
    let named = |cause: &dyn std::fmt::Display| format!("{}: {cause}", coordinates.display());
    let bytes = std::fs::read(coordinates).map_err(|cause| named(&cause))?;
    let airfoil = Airfoil::from_text(&String::from_utf8_lossy(&bytes)).map_err(|cause| named(&cause))?;
    let place = tempfile::tempdir()?;
    let made = place.path().join("airfoil.step");
    airfoil.write_step(&made).map_err(|cause| named(&cause))?;
    signals::result_is(output, DONE);
    formats::write_bytes(output, &std::fs::read(&made)?)?;
    let (points, edge) = (airfoil.points().len(), if airfoil.is_sharp() { "sharp" } else { "blunt" });
    let mut beside = Beside::default();
    beside.tell(print(&format!(
        "{}: {points} points, {edge} trailing edge\nwritten: {}",
        coordinates.display(),
        output.display()
    )));
    Ok(beside.exit_code(DONE))
}
