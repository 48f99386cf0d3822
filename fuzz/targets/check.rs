#![no_main]
//! What `info` and `check` do with a mesh that was read, and what a writer does.
use sagitta::certify::{self, Settings};
use sagitta::mesh::Skin;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some(mesh) = sagitta_fuzz::read(bytes, "msh") else { return };
    let _ = Skin::of(&mesh).notes(&mesh);
    let certificate = certify::mesh(&mesh, mesh.points(), None, &Settings::default());
    assert!(!(certificate.holds() && certificate.relative.lower.is_nan()));
});
