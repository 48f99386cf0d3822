//! What the fuzz targets have in common: bytes become a file of some name, which is read or refused.

#[path = "../../tests/suite/common/sound.rs"]
mod sound;

use std::path::PathBuf;
use std::sync::LazyLock;

use sagitta::formats::{self, Error, ReadOptions};
use sagitta::mesh::Mesh;
use sound::sound;

/// A folder of this process alone; in memory, where the system has such a place.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let memory = PathBuf::from("/dev/shm");
    let parent = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let folder = parent.join(format!("sagitta-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the input");
    folder
});

/// Reads bytes as a file whose name ends in `ending`.
///
/// # Panics
/// Where what was read cannot be a mesh, or a refusal does not name the file.
pub fn read(bytes: &[u8], ending: &str) -> Option<Mesh> {
    let path = FOLDER.join(format!("input.{ending}"));
    std::fs::write(&path, bytes).expect("the input is written");
    match formats::read_with(&path, &ReadOptions::default()) {
        Ok(mesh) => {
            sound(&mesh);
            Some(mesh)
        }
        Err(error) => {
            assert!(error.to_string().contains("input."), "the file is not named: {error}");
            assert!(!matches!(error, Error::Io { .. }), "{error}");
            None
        }
    }
}
