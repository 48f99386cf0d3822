//! Seeded mutations of good CAD files: every outcome is a model or a clear error, within the time limit.
//!
//! By hand: `SAGITTA_FUZZ=5000 SAGITTA_FUZZ_SEED=7 cargo test -p sagitta-cad --release --test fuzz -- --ignored --nocapture`

use crate::common::{Random, by, reader};
use cad::{FaceId, Group, Model, ReadError, Reader};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The parent repeats the child's work on the shape once, and the machine may be busy.
const LIMIT: Duration = Duration::from_secs(20);

fn sources() -> Vec<PathBuf> {
    ["weeble/weeble.step", "torus/torus.igs", "weeble/weeble.igs"]
        .map(crate::common::path)
        .into_iter()
        .chain(["kinds.brep", "plate.brep", "assembly.step", "unsewn.igs"].map(crate::common::shape_path))
        .collect()
}

fn below(random: &mut Random, count: usize) -> usize {
    ((random.unit() * count as f64) as usize).min(count.saturating_sub(1))
}

/// Spans of `text` that a number or a reference fills.
fn numbers(text: &[u8]) -> Vec<(usize, usize)> {
    let is = |b: u8| b.is_ascii_digit() || matches!(b, b'.' | b'-' | b'E' | b'#' | b'+');
    let mut spans = Vec::new();
    let mut at = 0;
    while at < text.len() {
        let length = text[at..].iter().take_while(|&&b| is(b)).count();
        if length > 0 && text[at..at + length].iter().any(u8::is_ascii_digit) {
            spans.push((at, at + length));
        }
        at += length.max(1);
    }
    spans
}

/// One mutation: of a byte, a number, a reference, a line, or the end.
fn mutate(text: &mut Vec<u8>, random: &mut Random) {
    if text.is_empty() {
        return;
    }
    let spans = numbers(text);
    match below(random, 8) {
        0 => {
            let at = below(random, text.len());
            text[at] = (random.unit() * 256.0) as u8;
        }
        1 => text.truncate(below(random, text.len())),
        2..=4 if !spans.is_empty() => {
            let values: [&[u8]; 8] = [b"0", b"-1", b"1E999", b"nan", b"1e-300", b"99999999", b"#1", b"*"];
            let (a, b) = spans[below(random, spans.len())];
            text.splice(a..b, values[below(random, values.len())].iter().copied());
        }
        5 | 6 if !spans.is_empty() => {
            // another number or reference of the file in its place: dangling, cyclic and self references come of it
            let (a, b) = spans[below(random, spans.len())];
            let (c, d) = spans[below(random, spans.len())];
            let other = text[c..d].to_vec();
            text.splice(a..b, other);
        }
        _ => {
            let mut lines: Vec<Vec<u8>> = text.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
            let (a, b) = (below(random, lines.len()), below(random, lines.len()));
            match below(random, 3) {
                0 => drop(lines.remove(a)),
                1 => lines.swap(a, b),
                _ => lines.insert(a, lines[b].clone()),
            }
            *text = lines.join(&b'\n');
        }
    }
}

/// What came of one file; panics where that is no clear answer.
fn outcome(path: &Path, timeout: Duration) -> &'static str {
    let start = Instant::now();
    let result = Model::read(path, &by(Reader { timeout, ..reader() }));
    let took = start.elapsed();
    assert!(took < LIMIT, "{}: {took:?}", path.display());
    match result {
        Ok(model) => {
            let all: Vec<FaceId> = model.faces().iter().map(|face| face.id).collect();
            if let Ok(group) = Group::of_faces(&model, &all) {
                let _ = group.closest(model.bounds().center(), None);
            }
            let _ = model.health();
            "read"
        }
        Err(error) => {
            let name = path.file_name().unwrap().to_str().unwrap();
            assert!(error.to_string().contains(name), "{error}");
            match error {
                ReadError::Crashed { .. } => "crash in the child",
                ReadError::TimedOut { .. } => "time limit",
                ReadError::OutOfMemory { .. } => "memory limit",
                _ => "refused",
            }
        }
    }
}

fn fuzz(count: usize, seed: u64, timeout: Duration) {
    let sources: Vec<(PathBuf, Vec<u8>)> =
        sources().into_iter().map(|path| (path.clone(), std::fs::read(path).unwrap())).collect();
    let dir = tempfile::tempdir().unwrap();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for i in 0..count {
        let mut random = Random(seed.wrapping_mul(1_000_003).wrapping_add(i as u64));
        let (source, text) = &sources[i % sources.len()];
        let mut text = text.clone();
        for _ in 0..=below(&mut random, 3) {
            mutate(&mut text, &mut random);
        }
        let extension = source.extension().unwrap().to_str().unwrap();
        let path = dir.path().join(format!("mutation-{seed}-{i}.{extension}"));
        std::fs::write(&path, &text).unwrap();
        *counts.entry(outcome(&path, timeout)).or_default() += 1;
        std::fs::remove_file(&path).unwrap();
    }
    println!("{count} mutations of {} files, seed {seed}: {counts:?}", sources.len());
}

#[test]
fn some_mutations() {
    fuzz(35, 1, Duration::from_secs(2));
}

#[test]
#[ignore = "minutes; by hand"]
fn many_mutations() {
    let variable = |name: &str, default: u64| std::env::var(name).ok().and_then(|t| t.parse().ok()).unwrap_or(default);
    fuzz(variable("SAGITTA_FUZZ", 1000) as usize, variable("SAGITTA_FUZZ_SEED", 2), Duration::from_secs(5));
}
