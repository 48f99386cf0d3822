//! What the tests share.
#![allow(dead_code, unreachable_pub)] // each test program uses its part

use cad::{Model, ReadOptions, Reader};
use glam::DVec3;
use std::path::{Path, PathBuf};

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

/// Deterministic numbers in 0..1 (splitmix64).
pub struct Random(pub u64);

impl Random {
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn in_box(&mut self, min: DVec3, max: DVec3) -> DVec3 {
        min + (max - min) * DVec3::new(self.unit(), self.unit(), self.unit())
    }
}

pub fn shape_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/shapes").join(name)
}

pub fn shape(name: &str) -> Model {
    Model::read(&shape_path(name), &options()).unwrap()
}
