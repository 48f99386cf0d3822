//! Damaged files of every format: whatever is in them, an answer without panic, and memory in proportion to the file.
//! A file that takes for ever runs into the time limit of all tests (`.config/nextest.toml`).
//!
//! `SAGITTA_FUZZ=N` sets the number of mutations of each format, `SAGITTA_FUZZ_ONLY=CGNS` takes one format; CGNS takes a process
//! each, and so fewer by default.
//! This test stands alone in its process: it reads the process' peak of address space.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::common::random::Random;
use crate::common::sound::sound;
use sagitta::formats::{self, ReadOptions};

/// Mutations of each format; of CGNS.
const MUTATIONS: [u64; 2] = [2_000, 100];
/// Peak address space that all reads together may add; the largest sample has 200 kB.
const ALLOWANCE_KB: u64 = 64 << 10;

/// The longest that reading one file may take, on a machine that has other work too.
const SLOWEST: Duration = Duration::from_secs(20);

/// Damages a file in one or two places.
fn damage(content: &mut Vec<u8>, dice: &mut Random) {
    for _ in 0..=dice.below(2) {
        let at = dice.below(content.len().max(1)).min(content.len().saturating_sub(1));
        // Half of the damage goes to the head, where the counts stand.
        let at = if dice.below(2) == 0 { at % 600 } else { at };
        let end = (at + 1 + dice.below(16)).min(content.len());
        match dice.below(9) {
            0 => content.truncate(at),
            // A line is lost, or is there twice.
            kind @ (7 | 8) => {
                let start = content[..at].iter().rposition(|&byte| byte == b'\n').map_or(0, |n| n + 1);
                let end = content[at..].iter().position(|&byte| byte == b'\n').map_or(content.len(), |n| at + n + 1);
                let line: Vec<u8> = content[start..end].to_vec();
                content.splice(start..end, if kind == 7 { Vec::new() } else { [&line[..], &line].concat() });
            }
            1 if at < content.len() => content[at] ^= 1 << dice.below(8),
            2 if at < end => drop(content.drain(at..end)),
            3 if at < end => content[at..end].fill(0xff),
            4 if at < end => {
                let piece = content[at..end].to_vec();
                content.splice(at..at, piece);
            }
            5 if at < end => {
                let numbers: [&[u8]; 6] = [b"-1", b"99999999999999", b"nan", b"1e400", b"18446744073709551615", b"0"];
                content.splice(at..end, numbers[dice.below(6)].iter().copied());
            }
            _ if at + 8 <= content.len() => {
                let numbers = [u64::MAX, 1 << 40, 1 << 31, f64::NAN.to_bits(), 0, 1 << 62];
                content[at..at + 8].copy_from_slice(&numbers[dice.below(6)].to_le_bytes());
            }
            _ => {}
        }
    }
}

/// The largest address space this process has had, in kB; `None` where the system does not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmPeak:"))?;
    line.split_ascii_whitespace().nth(1)?.parse().ok()
}

/// Samples of a format: their names' endings.
struct Format {
    name: &'static str,
    endings: &'static [&'static str],
    mutations: u64,
}

fn samples(format: &Format) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = if format.name == "Nektar++" { "fixtures/nektar" } else { "fixtures/samples" };
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut files: Vec<PathBuf> = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| format.endings.iter().any(|ending| file.to_str().unwrap().ends_with(ending)));
    files.sort();
    let mut samples: Vec<_> = files.into_iter().map(|file| (file.clone(), std::fs::read(file).unwrap())).collect();
    if format.name == "PLOT3D" {
        samples.extend(grids());
    }
    if format.name == "HOPR" {
        samples.extend(hopr());
    }
    assert!(samples.len() >= 2, "{}", format.name);
    samples
}

/// HOPR files of two orders.
fn hopr() -> Vec<(PathBuf, Vec<u8>)> {
    let folder = tempfile::tempdir().unwrap();
    let own = |name: &str| {
        let mesh =
            formats::read(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples").join(name)).unwrap();
        let path = folder.path().join("mesh.h5");
        formats::write(&path, &mesh, &formats::WriteOptions::default()).unwrap();
        (PathBuf::from("mesh.h5"), std::fs::read(path).unwrap())
    };
    ["hexpyrtet_p1_msh41b.msh", "cylprism_p2_msh41b.msh"].map(own).to_vec()
}

/// PLOT3D grids of 3 x 3 x 3 points: as text, and in Fortran's records.
fn grids() -> [(PathBuf, Vec<u8>); 2] {
    let axis = |axis: u32| (0..27_u32).map(move |n| f64::from(n / 3_u32.pow(axis) % 3));
    let values: Vec<f64> = (0..3).flat_map(axis).collect();
    let text: Vec<String> = values.iter().map(f64::to_string).collect();
    let text = format!("1\n3 3 3\n{}\n", text.join(" "));
    let record = |bytes: Vec<u8>| {
        let length = (bytes.len() as u32).to_le_bytes().to_vec();
        [length.clone(), bytes, length].concat()
    };
    let sizes = record([3_i32; 3].iter().flat_map(|n| n.to_le_bytes()).collect());
    let block = record(values.iter().flat_map(|x| x.to_le_bytes()).collect());
    [(PathBuf::from("text.x"), text.into_bytes()), (PathBuf::from("records.x"), [sizes, block].concat())]
}

fn fuzz(format: &Format, seed: u64) {
    let samples = samples(format);
    let dir = tempfile::tempdir().unwrap();
    let options = ReadOptions { reader: Some(env!("CARGO_BIN_EXE_sagitta").into()), ..ReadOptions::default() };
    let mut dice = Random(seed);
    let (mut read, mut refused, mut slowest) = (0, 0, Duration::ZERO);
    for n in 0..format.mutations {
        let (file, whole) = &samples[dice.below(samples.len())];
        let mut content = whole.clone();
        damage(&mut content, &mut dice);
        let path = dir.path().join(file.file_name().unwrap());
        std::fs::write(&path, &content).unwrap();
        let start = Instant::now();
        let read_or_not = std::panic::catch_unwind(|| formats::read_with(&path, &options));
        slowest = slowest.max(start.elapsed());
        match read_or_not {
            Ok(Ok(mesh)) => {
                read += 1;
                sound(&mesh);
            }
            Ok(Err(error)) => {
                refused += 1;
                assert!(error.to_string().contains(file.file_name().unwrap().to_str().unwrap()), "{error}");
            }
            Err(_) => {
                let kept =
                    std::env::temp_dir().join(format!("sagitta-fuzz-{n}-{}", file.file_name().unwrap().display()));
                std::fs::copy(&path, &kept).unwrap();
                panic!("seed {seed}, mutation {n} of {}: panic; kept as {}", file.display(), kept.display());
            }
        }
    }
    println!("{}: {read} read, {refused} refused, the slowest in {:.2} s", format.name, slowest.as_secs_f64());
    assert!(slowest < SLOWEST, "{}: {slowest:?}", format.name);
    assert!(read > format.mutations / 50 && refused > format.mutations / 50, "{}", format.name);
}

#[test]
fn damaged_files_are_answered() {
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse().ok());
    let seed = number("SAGITTA_SEED").unwrap_or(20_261_122);
    println!("seed {seed} (SAGITTA_SEED)");
    let [most, few] = MUTATIONS.map(|count| number("SAGITTA_FUZZ").unwrap_or(count));
    // Threads take address space once, whatever they read.
    rayon::broadcast(|_| drop(vec![0_u8; 1 << 10]));
    let before = peak();
    let only = std::env::var("SAGITTA_FUZZ_ONLY").ok();
    for (name, endings, mutations) in [
        ("MSH", &[".msh"][..], most),
        ("UGRID", &[".ugrid"], most),
        ("SU2", &[".su2"], most),
        ("VTU", &[".vtu"], most),
        ("legacy VTK", &[".vtk"], most),
        ("PLOT3D", &[".x"], most),
        ("GMF", &[".mesh", ".meshb"], most),
        ("MFEM", &[".mfem"], most),
        ("Nektar++", &[".xml"], most),
        ("CGNS", &["_p3.cgns", "bc.cgns", "offset.cgns", "hexa27.cgns", "zones.cgns"], few),
        ("HOPR", &[".h5"], few),
    ] {
        if only.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        fuzz(&Format { name, endings, mutations }, seed);
        // The child that reads CGNS has a limit of its own; the threads that listen to it take address space.
        if let (Some(before), Some(after), true) = (before, peak(), !["CGNS", "HOPR"].contains(&name)) {
            println!("peak memory grew by {} kB", after - before);
            assert!(after - before < ALLOWANCE_KB, "{name}: peak memory grew by {} kB", after - before);
        }
    }
}
