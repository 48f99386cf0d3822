//! How commands read mesh files.

use std::path::Path;
use std::sync::OnceLock;

use clap::Args;
use glam::DVec3;

use super::help::INPUT;
use super::output::Failure;
use crate::formats::{self, Error, GridLayout, ReadOptions};
use crate::mesh::{self, Mesh, linear_positions};

/// Options of reading that all commands have.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(super) struct Reading {
    /// Memory that reading a file may take, as 500M or 8G; default half of the machine's
    #[arg(long, value_name = "SIZE", value_parser = size, global = true, help_heading = INPUT, hide_short_help = true)]
    memory_limit: Option<u64>,
    /// How a binary PLOT3D grid is written, where its length does not tell: lr4,several or b8,one,iblank, ...
    #[arg(long, value_name = "LAYOUT", global = true, help_heading = INPUT, hide_short_help = true)]
    plot3d_layout: Option<GridLayout>,
}

/// The least memory that reading may be given, in bytes.
const LEAST: u64 = 64 << 20;

/// A number of bytes.
fn size(text: &str) -> Result<u64, String> {
    let wrong = || "not a size of at least 64M, as 500M or 8G".to_owned();
    let (number, shift) = match text.strip_suffix(['G', 'g']) {
        Some(number) => (number, 30),
        None => (text.strip_suffix(['M', 'm']).ok_or_else(wrong)?, 20),
    };
    let bytes = number.parse::<u64>().ok().and_then(|number| number.checked_mul(1 << shift));
    bytes.filter(|&bytes| bytes >= LEAST).ok_or_else(wrong)
}

/// What the user has chosen; set once, before any file is read.
static CHOSEN: OnceLock<Reading> = OnceLock::new();

impl Reading {
    /// Makes this the choice for all reading.
    pub(super) fn choose(self) {
        let _ = CHOSEN.set(self); // nothing else sets it
    }

    fn chosen() -> Reading {
        CHOSEN.get().copied().unwrap_or_default()
    }
}

/// The memory that reading a file may take, in bytes: what the user says, or the given default, but no more than half the machine's.
#[cfg(feature = "cad")]
pub(super) fn memory(default: u64) -> u64 {
    Reading::chosen().memory_limit.unwrap_or_else(|| default.min(cad::memory::half_of_machine()))
}

/// CGNS is parsed by this program in a process of its own, which may crash.
pub(super) fn reading() -> ReadOptions {
    let Reading { memory_limit, plot3d_layout } = Reading::chosen();
    ReadOptions { reader: Some(cad::child::this_program()), memory_limit, grid_layout: plot3d_layout }
}

/// Reads a mesh.
pub(super) fn mesh(path: &Path) -> Result<Mesh, Error> {
    formats::read_with(path, &reading())
}

/// A linear mesh that is not the one that the curved mesh was made from.
#[derive(Debug, thiserror::Error)]
#[error("{linear}: not the linear mesh of {curved}: {why}")]
struct NotItsLinear {
    linear: String,
    curved: String,
    why: mesh::NotItsLinear,
}

/// Where the corners of a mesh, which was read from `path`, stand in the linear mesh that it was made from, where that is given.
pub(super) fn linear_corners(path: &Path, own: &Mesh, linear: Option<&Path>) -> Result<Option<Vec<DVec3>>, Failure> {
    let Some(linear) = linear else { return Ok(None) };
    let matched = linear_positions(own, &mesh(linear)?).map_err(|why| NotItsLinear {
        linear: linear.display().to_string(),
        curved: path.display().to_string(),
        why,
    })?;
    Ok(Some(matched))
}

#[cfg(test)]
mod tests {
    use super::size;

    #[test]
    fn sizes_have_a_unit_and_a_least() {
        assert_eq!([size("64M"), size("8G"), size("1g")], [Ok(64 << 20), Ok(8 << 30), Ok(1 << 30)]);
        for wrong in ["", "8", "63M", "-1G", "1.5G", "99999999999999999999G", "18446744073709551615G"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }
}
