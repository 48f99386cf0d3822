//! A file of 100 MB: read in under 2 s and in less than twice its size of memory. It stands alone in its process, whose peak it reads.
#![allow(clippy::unwrap_used, clippy::panic)]

use std::fmt::Write as _;
use std::time::Instant;

/// Points of the mesh, with their parameters in the file; a grid of this many a side.
const SIDE: u32 = 900;

/// The peak of the process' memory in bytes; `None` where the system does not tell.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(1024 * line.split_ascii_whitespace().nth(1)?.parse::<u64>().ok()?)
}

/// Writes one sheet of triangles on a grid, with and without parameters, until there are 100 MB.
fn write(path: &std::path::Path) {
    use std::io::Write as _;
    let mut file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let head = "<MeshLink version=\"1.0\" xmlns=\"https://cadence.com\">\n<GeometryFile filename=\"a.step\">\
                <GeometryReference gid=\"1\" ref=\"face-1\"/></GeometryFile>\n<MeshFile filename=\"a.msh\"><MeshModelReference ref=\"a\">\n";
    file.write_all(head.as_bytes()).unwrap();
    let mut text = String::new();
    for sheet in 0..3 {
        writeln!(text, "<MeshSheet name=\"s{sheet}\" gref=\"1\">").unwrap();
        if sheet == 0 {
            for n in 1..=SIDE * SIDE / 2 {
                let u = f64::from(n) / 3.0;
                writeln!(text, "<ParamVertex vref=\"{n}\" gref=\"1\" dim=\"2\">{u} {}</ParamVertex>", u / 7.0).unwrap();
            }
        }
        writeln!(text, "<MeshFace etype=\"Tri3\" count=\"{}\">", 2 * (SIDE - 1) * (SIDE - 1)).unwrap();
        for (i, j) in (0..SIDE - 1).flat_map(|j| (0..SIDE - 1).map(move |i| (i, j))) {
            let [a, b, c, d] = [0, 1, SIDE, SIDE + 1].map(|step| 1 + i + SIDE * j + step);
            writeln!(text, "{a} {b} {c}\n{b} {d} {c}").unwrap();
        }
        text.push_str("</MeshFace></MeshSheet>\n");
        file.write_all(text.as_bytes()).unwrap();
        text = String::new();
    }
    file.write_all(b"</MeshModelReference></MeshFile></MeshLink>\n").unwrap();
    file.flush().unwrap();
}

#[test]
fn a_hundred_megabytes() {
    let path = std::env::temp_dir().join(format!("sagitta-large-{}.xml", std::process::id()));
    // Written by another process, which leaves this one's peak alone.
    if let Some(path) = std::env::var_os("SAGITTA_WRITE_LARGE") {
        write(path.as_ref());
        return;
    }
    let own = std::env::current_exe().unwrap();
    let status = std::process::Command::new(own).env("SAGITTA_WRITE_LARGE", &path).arg("--quiet").status().unwrap();
    assert!(status.success());
    let size = std::fs::metadata(&path).unwrap().len();
    assert!(size > 100_000_000, "{size}");
    let (before, start) = (peak(), Instant::now());
    let reading = linkage_schema::read_path(&path);
    let (after, seconds) = (peak(), start.elapsed());
    let start = Instant::now();
    let marks = std::fs::read(&path).unwrap().into_iter().filter(|byte| byte.is_ascii_punctuation()).count();
    let bare = start.elapsed();
    std::fs::remove_file(&path).unwrap();
    assert!(reading.unwrap().findings.is_empty());
    let grown = after.zip(before).map(|(after, before)| after - before);
    println!(
        "{} MB in {:.2} s ({:.1} x the bytes alone), {} MB of memory",
        size / 1_000_000,
        seconds.as_secs_f64(),
        seconds.as_secs_f64() / bare.as_secs_f64(),
        grown.unwrap_or(0) / 1_000_000
    );
    // Beside reading the bytes and looking at each in the same run; without optimisation it is as slow as it likes.
    assert!(marks > 0 && (cfg!(debug_assertions) || seconds < 10 * bare), "{seconds:?}, {bare:?} for the bytes alone");
    assert!(grown.is_none_or(|grown| grown < 2 * size), "{grown:?} bytes of memory for {size}");
}
