//! Feet per second and thread, beside OCCT's reused global search and beside our own seed and Newton without proof, in one run.
//!
//! `cargo bench -p sagitta-cad --bench projection [-- CASE]`. Ratios within one run mean something; digits move with the machine.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

#[path = "../suite/common/iges.rs"]
mod iges;
#[path = "../suite/common/random.rs"]
mod random;

use cad::{FaceId, Foot, Group, Hint, Kind, Model, ReadOptions};
use glam::DVec3;
use iges::Patch;
use opencascade_sys as sys;
use random::Random;
use std::f64::consts::{PI, TAU};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Excess of distance over the best of all methods that counts as wrong, fraction of the diagonal.
const WRONG: f64 = 1e-9;

/// Runs of each method over each chunk of queries; the best counts, because other work of the machine only slows it down.
const RUNS: usize = 15;
const CHUNK: usize = 500;

struct Case {
    name: &'static str,
    path: PathBuf,
    kind: Option<Kind>,
    queries: usize,
    /// Queries of OCCT's search, which is slow.
    global: usize,
}

/// A tapered, swept and twisted NACA 0012 wing: `s` runs around the section from the trailing edge, `t` along the span.
fn wing(s: f64, t: f64) -> DVec3 {
    let angle = TAU * s;
    let x = 0.5 * (1.0 + angle.cos());
    let thickness = 0.6 * (0.2969 * x.sqrt() - 0.1260 * x - 0.3516 * x * x + 0.2843 * x.powi(3) - 0.1036 * x.powi(4));
    let y = if s < 0.5 { thickness } else { -thickness };
    let chord = 100.0 * (1.0 - 0.5 * t);
    let (sin, cos) = (0.1 * t).sin_cos();
    let (x, y) = (chord * (x - 0.25), chord * y);
    DVec3::new(60.0 * t + cos * x + sin * y, 300.0 * t, cos * y - sin * x)
}

fn terrain(s: f64, t: f64) -> DVec3 {
    let waves = [(3.0, 2.0, 0.06), (7.0, -5.0, 0.025), (13.0, 11.0, 0.012), (29.0, -23.0, 0.004)];
    let height: f64 = waves.iter().map(|(a, b, h)| h * (TAU * (a * s + b * t)).sin() * (PI * b * s).cos()).sum();
    DVec3::new(s, t, height) * 1000.0
}

/// The wing in 5 × 10 panels.
fn panels() -> Vec<Patch> {
    let panel = |k: usize| {
        let (i, j) = ((k % 10) as f64, (k / 10) as f64);
        Patch::sampled([8, 6], move |s, t| wing((i + s) / 10.0, (j + t) / 5.0))
    };
    (0..50).map(panel).collect()
}

fn cases(folder: &Path) -> Vec<Case> {
    let write = |name: &str, patches: &[Patch]| {
        let path = folder.join(name);
        std::fs::write(&path, iges::file(patches)).unwrap();
        path
    };
    let weeble = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/weeble/weeble.step");
    let case = |name, path, queries, global| Case { name, path, kind: None, queries, global };
    vec![
        case("NACA 43x27", write("naca.igs", &[Patch::sampled([43, 27], wing)]), 20_000, 1000),
        case("terrain 312x323", write("terrain.igs", &[Patch::sampled([312, 323], terrain)]), 20_000, 40),
        Case { kind: Some(Kind::Torus), ..case("trimmed torus", weeble, 100_000, 2000) },
        case("50 faces", write("panels.igs", &panels()), 20_000, 200),
    ]
}

/// Points around the faces, each off the surface by at most `reach` of the diagonal.
fn queries(model: &Model, faces: &[FaceId], count: usize, reach: f64) -> Vec<DVec3> {
    let mut random = Random(1);
    let mut between = |[a, b]: [f64; 2]| a + (b - a) * random.unit();
    let point = |k: usize| {
        let id = faces[k % faces.len()];
        let [u, v] = model.face(id).unwrap().parameters;
        let on = model.evaluate(id.into(), [between(u), between(v)]).unwrap().point();
        let off = DVec3::new(between([-1.0, 1.0]), between([-1.0, 1.0]), between([-1.0, 1.0]));
        on + off.normalize_or_zero() * between([0.0, 1.0]) * reach * model.diagonal()
    };
    (0..count).map(point).collect()
}

fn distances(feet: &[Option<Foot>]) -> impl Iterator<Item = f64> {
    feet.iter().map(|foot| foot.map_or(f64::INFINITY, |foot| foot.distance))
}

/// Runs a method over all points, chunk by chunk; the rate if every chunk took the best of its times.
fn rate<T>(count: usize, mut run: impl FnMut(Range<usize>) -> Vec<T>) -> (f64, Vec<T>) {
    let chunks: Vec<Range<usize>> = (0..count).step_by(CHUNK).map(|at| at..(at + CHUNK).min(count)).collect();
    let mut best = vec![f64::INFINITY; chunks.len()];
    let mut answer = Vec::new();
    for _ in 0..RUNS {
        answer.clear();
        for (chunk, best) in chunks.iter().zip(&mut best) {
            let start = Instant::now();
            let part = run(chunk.clone());
            *best = best.min(start.elapsed().as_secs_f64());
            answer.extend(part);
        }
    }
    (count as f64 / best.iter().sum::<f64>(), answer)
}

/// OCCT's global search over all faces of the case.
fn occt(oracles: &mut [sys::UniquePtr<sys::Oracle>], x: DVec3) -> f64 {
    let mut best = f64::INFINITY;
    for oracle in oracles {
        let mut found = [0.0; 3];
        if oracle.pin_mut().project(x.x, x.y, x.z, &mut found).unwrap_or(false) {
            best = best.min(found[2]);
        }
    }
    best
}

fn wrong(distances: impl Iterator<Item = f64>, best: &[f64], diagonal: f64) -> usize {
    distances.zip(best).filter(|(d, b)| *d > **b + WRONG * diagonal).count()
}

fn run(case: &Case) {
    let format = if case.path.extension().is_some_and(|e| e == "igs") { sys::Format::Iges } else { sys::Format::Step };
    let import = sys::read_file(case.path.to_str().unwrap(), format, 1.0, false).unwrap();
    let model = Model::read(&case.path, &ReadOptions::default()).unwrap();
    let wanted = model.faces().iter().filter(|face| case.kind.is_none_or(|kind| face.kind == kind));
    let faces: Vec<FaceId> = wanted.map(|face| face.id).collect();
    let start = Instant::now();
    let group = Group::of_faces(&model, &faces).unwrap();
    println!("{} ({} faces, group in {:.2} s)", case.name, faces.len(), start.elapsed().as_secs_f64());
    let mut oracles: Vec<_> = faces.iter().map(|id| sys::oracle(import.shape(), id.index()).unwrap()).collect();
    for (name, reach) in [("near", 0.005), ("far", 0.1)] {
        compare(case, name, &queries(&model, &faces, case.queries, reach), &group, &mut oracles, model.diagonal());
    }
}

fn compare(
    case: &Case,
    name: &str,
    xs: &[DVec3],
    group: &Group,
    oracles: &mut [sys::UniquePtr<sys::Oracle>],
    diagonal: f64,
) {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let (one, two) = (pool(1), pool(2));
    let (ours, feet) = rate(xs.len(), |r| one.install(|| group.closest_batch(&xs[r], &mut [])));
    let (pair, _) = rate(xs.len(), |r| two.install(|| group.closest_batch(&xs[r], &mut [])));
    let mut hints = vec![Hint::default(); xs.len()];
    group.closest_batch(xs, &mut hints);
    // a later sweep of the smoother: every point has moved a little, in any direction
    let mut random = Random(2);
    let mut shake = || 2.0 * random.unit() - 1.0;
    let moves = distances(&feet).map(|distance| 0.02 * distance * DVec3::new(shake(), shake(), shake()));
    let moved: Vec<DVec3> = xs.iter().zip(moves).map(|(x, by)| *x + by).collect();
    // there and back: each run has the hints of the one before
    let mut there = false;
    let (hinted, carried) = rate(xs.len(), |r| {
        there ^= r.start == 0;
        let at = if there { &moved[r.clone()] } else { &xs[r.clone()] };
        one.install(|| group.closest_batch(at, &mut hints[r]))
    });
    let afresh = two.install(|| group.closest_batch(if there { &moved } else { xs }, &mut []));
    let afresh: Vec<f64> = distances(&afresh).collect();
    let misled = wrong(distances(&carried), &afresh, diagonal);
    let (bare, quick) = rate(xs.len(), |r| xs[r].iter().map(|&x| group.closest_without_proof(x)).collect());
    let some = &xs[..case.global.min(xs.len())];
    let start = Instant::now();
    let theirs: Vec<f64> = some.iter().map(|&x| occt(oracles, x)).collect();
    let global = some.len() as f64 / start.elapsed().as_secs_f64();
    let best: Vec<f64> = distances(&feet).zip(distances(&quick)).map(|(a, b)| a.min(b)).collect();
    let best_of_all: Vec<f64> = best.iter().zip(&theirs).map(|(a, b)| a.min(*b)).collect();
    let unproven = feet.iter().flatten().filter(|foot| !foot.is_proven()).count();
    println!("  {name:4} ours {ours:9.3e}/s, {unproven} of {} not proven", xs.len());
    println!(
        "       hinted {hinted:9.3e}/s = {:.2} x, {misled} wrong; two threads {:.2} x one",
        hinted / ours,
        pair / ours
    );
    println!(
        "       seed + Newton {bare:9.3e}/s: ours is {:.2} x; OCCT global {global:9.3e}/s: ours is {:.0} x",
        ours / bare,
        ours / global
    );
    let mut all = best_of_all.clone();
    all.extend_from_slice(&best[best_of_all.len()..]);
    println!(
        "       wrong: ours {} of {}, seed + Newton {} of {}, OCCT {} of {}",
        wrong(distances(&feet), &all, diagonal),
        xs.len(),
        wrong(distances(&quick), &all, diagonal),
        xs.len(),
        wrong(theirs.iter().copied(), &best_of_all, diagonal),
        some.len()
    );
}

/// 1e5 points on the weeble's torus group, the figure of the first target.
fn weeble() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures/weeble/weeble.step");
    let model = Model::read(&path, &ReadOptions::default()).unwrap();
    let tori = model.faces().iter().filter(|face| face.kind == Kind::Torus);
    let faces: Vec<FaceId> = tori.map(|face| face.id).collect();
    let group = Group::of_faces(&model, &faces).unwrap();
    let xs = queries(&model, &faces, 100_000, 0.005);
    let start = Instant::now();
    let feet = group.closest_batch(&xs, &mut []);
    let unproven = feet.iter().flatten().filter(|foot| !foot.is_proven()).count();
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "weeble's torus group: 1e5 points in {seconds:.3} s on {} threads, {unproven} not proven",
        rayon::current_num_threads()
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let wanted: Vec<&String> = arguments[1..].iter().filter(|a| !a.starts_with("--")).collect();
    let folder = tempfile::tempdir().unwrap();
    for case in cases(folder.path()) {
        if wanted.is_empty() || wanted.iter().any(|word| case.name.contains(word.as_str())) {
            run(&case);
        }
    }
    if wanted.is_empty() {
        weeble();
    }
}
