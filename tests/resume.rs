//! A run that goes on from a checkpoint ends in the same bytes as one that was never interrupted.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// The weeble at P2, with work enough for several rounds.
fn curve(out: &Path, max_sweeps: &str, more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sagitta"));
    command.args(["curve", "fixtures/weeble/weeble.msh", "--cad", "fixtures/weeble/weeble.step", "--order", "2"]);
    command.args(["--threshold", "0.97", "--max-sweeps", max_sweeps, "--quiet", "-o"]).arg(out).args(more);
    command.output().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn both_engines_go_on_to_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    for engine in ["quasi-newton", "gradient"] {
        let [whole, first, second, state] = ["whole.msh", "first.msh", "second.msh", "state"].map(file);
        assert_eq!(curve(&whole, "45", &["--engine", engine]).status.code(), Some(0));
        // The first part gets no farther than the rounds before its last sweep: what it writes itself does not count.
        curve(&first, "25", &["--engine", engine, "--checkpoint", text(&state), "--checkpoint-every", "1"]);
        let resumed = curve(&second, "45", &["--engine", engine, "--resume", text(&state)]);
        assert_eq!(resumed.status.code(), Some(0), "{}", String::from_utf8_lossy(&resumed.stderr));
        let bytes = |path: &Path| fs::read(path).unwrap();
        assert!(bytes(&first) != bytes(&whole), "{engine}: the first part left nothing to do");
        assert!(bytes(&second) == bytes(&whole), "{engine}: other bytes than without interruption");
    }
}

#[test]
fn what_is_no_checkpoint_of_this_work_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    let [out, state, bad] = ["out.msh", "state", "bad"].map(file);
    curve(&out, "45", &["--checkpoint", text(&state), "--checkpoint-every", "1"]);
    fs::remove_file(&out).unwrap();
    let good = fs::read(&state).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 1;
    let longer = [&good[..], &[0]].concat();
    let spoilt: [(&[u8], &str); 7] = [
        (&[], "is no checkpoint"),
        (b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "is no checkpoint"),
        (&good[..30], "is damaged"),
        (&good[..good.len() / 2], "is damaged"),
        (&good[..good.len() - 1], "is damaged"),
        (&flipped, "is damaged"),
        (&longer, "is damaged"),
    ];
    for (bytes, expected) in spoilt {
        fs::write(&bad, bytes).unwrap();
        assert_refused(&curve(&out, "45", &["--resume", text(&bad)]), &bad, expected);
        assert!(!out.exists());
    }
    for more in [["--alpha", "0.5"], ["--survey-factor", "3"], ["--curve-layers", "5"]] {
        let resumed = curve(&out, "45", &[&["--resume", text(&state)][..], &more].concat());
        assert_refused(&resumed, &state, "belongs to other work");
    }
    assert_refused(&curve(&out, "45", &["--resume", text(&file("none"))]), &file("none"), "cannot be read");
}

fn assert_refused(output: &Output, file: &Path, expected: &str) {
    let told = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains(expected) && told.contains(text(file)), "{expected}: {told}");
}
