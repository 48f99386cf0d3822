//! Damaged mesh files: what is there is held against every count, and what belongs to nothing is no mesh. Refusals have the place.

mod cgns;
mod elements;
mod foreign;
mod gmf;
mod msh;
mod names;
mod su2;
mod ugrid;
mod vtk;
mod vtu;

use std::path::PathBuf;

use sagitta::formats;
use sagitta::mesh::Mesh;
use tempfile::TempDir;

use crate::common::root;

/// A folder for damaged files.
struct Place(TempDir);

impl Place {
    fn new() -> Place {
        Place(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    fn read(&self, name: &str, content: impl AsRef<[u8]>) -> Result<Mesh, String> {
        formats::read(&self.write(name, content)).map_err(|error| error.to_string())
    }

    /// What is noted while a file is read that must be.
    #[track_caller]
    fn notes(&self, name: &str, content: impl AsRef<[u8]>) -> String {
        self.read(name, content).unwrap().notes().join("; ")
    }

    /// Reads a sample that must be refused with all these words.
    #[track_caller]
    fn refuses(&self, name: &str, content: impl AsRef<[u8]>, needles: &[&str]) {
        let told = self.read(name, content).map_or_else(|told| told, |_| "read".to_owned());
        assert!(told.contains(name) && needles.iter().all(|needle| told.contains(needle)), "{needles:?}: {told}");
    }
}

fn sample(name: &str) -> PathBuf {
    root().join("fixtures/samples").join(name)
}

fn text(name: &str) -> String {
    std::fs::read_to_string(sample(name)).unwrap()
}

/// The text with one piece replaced, which must be there.
#[track_caller]
fn with(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from:?}");
    text.replacen(from, to, 1)
}

/// The number of the line that begins so, counted from 1.
fn line_of(text: &str, begins: &str) -> String {
    let place = text.lines().position(|line| line.starts_with(begins)).unwrap();
    format!("line {}", place + 1)
}
