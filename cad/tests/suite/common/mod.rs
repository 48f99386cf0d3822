//! What the tests share.
#![allow(dead_code, unreachable_pub, unused_imports)] // each test program uses its part

#[path = "../../../../tests/suite/common/random.rs"]
mod random;

use cad::{Model, ReadOptions, Reader};
use std::path::{Path, PathBuf};

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
