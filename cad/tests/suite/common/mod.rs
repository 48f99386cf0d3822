//! What the tests share.
#![allow(dead_code, unreachable_pub, unused_imports)] // each test program uses its part

#[path = "../../../../tests/suite/common/foreign.rs"]
mod foreign;
#[path = "../../../../tests/suite/common/random.rs"]
mod random;

use cad::{Model, ReadOptions, Reader};
use std::path::{Path, PathBuf};

pub use foreign::foreign_folders;
pub use random::Random;

pub fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures").join(name)
}

/// The crate's own reading program.
pub fn reader() -> Reader {
    Reader::new(env!("CARGO_BIN_EXE_cad-reader"))
}

/// Reading by that program.
pub fn options() -> ReadOptions {
    by(reader())
}

/// Reading by some program.
pub fn by(reader: Reader) -> ReadOptions {
    ReadOptions { reader: Some(reader), ..ReadOptions::default() }
}

pub fn fixture(name: &str) -> Model {
    Model::read(&path(name), &options()).unwrap()
}

pub fn shape_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/shapes").join(name)
}

pub fn shape(name: &str) -> Model {
    Model::read(&shape_path(name), &options()).unwrap()
}

/// All CAD files of a folder and its sub-folders, in the order of their names.
pub fn cad_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(Result::ok).map(|entry| entry.path()).collect();
    paths.sort();
    for path in paths {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_lowercase();
        if path.is_dir() {
            cad_files(&path, found);
        } else if ["step", "stp", "igs", "iges", "brep", "egads"].contains(&extension.as_str()) {
            found.push(path);
        }
    }
}

/// The CAD files of the fixtures and of the tests' own shapes.
pub fn fixture_cad() -> Vec<PathBuf> {
    let mut paths = Vec::new();
    cad_files(&shape_path(""), &mut paths);
    cad_files(&path(""), &mut paths);
    paths
}
