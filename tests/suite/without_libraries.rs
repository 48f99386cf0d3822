//! The program without its default features: neither OpenCASCADE nor HDF5, and what is left works.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Builds it in a folder of its own, so that the other builds stay as they are.
fn build() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("without_libraries");
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let build = Command::new(cargo)
        .args(["build", "--quiet", "--frozen", "--package", "sagitta", "--no-default-features", "--target-dir"])
        .arg(&target)
        .envs([("CARGO_PROFILE_DEV_DEBUG", "0"), ("CARGO_PROFILE_DEV_OPT_LEVEL", "0")])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(build.status.success(), "{}", String::from_utf8_lossy(&build.stderr));
    target.join("debug/sagitta")
}

fn run(program: &Path, arguments: &[&str]) -> Output {
    Command::new(program).args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap()
}

/// What it prints on stdout; it must end with this exit code.
fn told(program: &Path, arguments: &[&str], code: i32) -> String {
    let output = run(program, arguments);
    let [out, err] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {out}{err}");
    if code == 0 { out } else { err }
}

#[test]
fn check_and_convert_work_without_opencascade_and_hdf5() {
    let program = build();
    let libraries = Command::new("ldd").arg(&program).output().unwrap();
    let libraries = String::from_utf8_lossy(&libraries.stdout).into_owned();
    assert!(libraries.contains("libc.so"), "{libraries}");
    for library in ["libTK", "libhdf5"] {
        assert!(!libraries.contains(library), "{library}: {libraries}");
    }

    let help = told(&program, &["--help"], 0);
    for command in ["check", "convert", "explain", "info"] {
        assert!(help.contains(&format!("\n  {command}")), "{command}: {help}");
    }
    for command in ["curve", "link", "validate", "groups", "project"] {
        assert!(!help.contains(&format!("\n  {command}")), "{command}: {help}");
        told(&program, &[command], 2);
    }

    let folder = tempfile::tempdir().unwrap();
    let written = folder.path().join("weeble.vtu");
    let (mesh, written) = ("fixtures/weeble/weeble.msh", written.to_str().unwrap());
    told(&program, &["convert", mesh, "-o", written], 0);
    let [before, after] = [mesh, written].map(|mesh| told(&program, &["check", mesh], 0).replace(mesh, "MESH"));
    assert_eq!(before, after);
    assert!(before.contains("certified"), "{before}");
    assert!(told(&program, &["info", mesh], 0).contains("mesh of order P1"));
    assert!(told(&program, &["info", "fixtures/weeble/weeble.step"], 2).contains("feature cad"));
}
