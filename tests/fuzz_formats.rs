//! Damaged files: whatever is in them, an answer without panic, and memory in proportion to the file.
//!
//! This test stands alone in its process: it reads the process' peak of address space.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "common/random.rs"]
mod random;

use std::path::Path;

use random::Random;
use sagitta::formats::msh;

const MUTATIONS: u64 = 6_000;
/// Peak address space that all reads together may add; the largest sample has 140 kB.
const ALLOWANCE_KB: u64 = 64 << 10;

/// Damages a file in one or two places.
fn damage(content: &mut Vec<u8>, dice: &mut Random) {
    for _ in 0..=dice.below(2) {
        let at = dice.below(content.len().max(1)).min(content.len().saturating_sub(1));
        // Half of the damage goes to the head, where the counts stand.
        let at = if dice.below(2) == 0 { at % 600 } else { at };
        let end = (at + 1 + dice.below(16)).min(content.len());
        match dice.below(7) {
            0 => content.truncate(at),
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

#[test]
fn damaged_files_are_answered() {
    let seed = random::seed(20_261_122);
    let dir = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/samples");
    let mut files: Vec<_> = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "msh"));
    files.sort();
    let samples: Vec<Vec<u8>> = files.iter().map(|file| std::fs::read(file).unwrap()).collect();
    let mut dice = Random(seed);
    let before = peak();
    let (mut read, mut refused) = (0, 0);
    for n in 0..MUTATIONS {
        let sample = dice.below(samples.len());
        let mut content = samples[sample].clone();
        damage(&mut content, &mut dice);
        match std::panic::catch_unwind(|| msh::read(&content[..], content.len() as u64)) {
            Ok(Ok(mesh)) => {
                read += 1;
                assert!(mesh.blocks.iter().all(|b| b.nodes.iter().all(|n| n.index() < mesh.points.len())));
            }
            Ok(Err(flaw)) => {
                refused += 1;
                assert!(!flaw.fault.to_string().is_empty());
            }
            Err(_) => panic!("seed {seed}, mutation {n} of {}: panic", files[sample].display()),
        }
    }
    println!("{read} read, {refused} refused");
    assert!(read > MUTATIONS / 50 && refused > MUTATIONS / 5);
    if let (Some(before), Some(after)) = (before, peak()) {
        assert!(after - before < ALLOWANCE_KB, "peak memory grew by {} kB", after - before);
    }
}
