//! Which format a CAD file is in, by its first bytes.

use crate::model::SourceFormat;
use crate::regular;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// Bytes that are looked at.
const HEAD: u64 = 4096;

/// The format of a file by its content; `None` for anything unknown.
///
/// # Errors
/// The file cannot be opened or read.
pub(crate) fn detect(path: &Path) -> io::Result<Option<SourceFormat>> {
    let mut head = Vec::new();
    regular::open(path)?.take(HEAD).read_to_end(&mut head)?;
    Ok(of_head(&head))
}

/// What a file that is no CAD that is read seems to be, and what to do; by its first bytes.
///
/// # Errors
/// The file cannot be opened or read.
pub(crate) fn foreign(path: &Path) -> io::Result<Option<&'static str>> {
    let mut head = Vec::new();
    regular::open(path)?.take(HEAD).read_to_end(&mut head)?;
    let holds = |word: &[u8]| head.windows(word.len()).any(|window| window == word);
    let begins = |words: &[&[u8]]| words.iter().any(|word| head.trim_ascii_start().starts_with(word));
    let stl = path.extension().is_some_and(|own| own.eq_ignore_ascii_case("stl"));
    Ok(if stl || (begins(&[b"solid"]) && holds(b"facet")) {
        Some("an STL file holds triangles only; export the CAD itself as STEP")
    } else if begins(&[b"$MeshFormat", b"<VTKFile", b"# vtk DataFile", b"MeshVersionFormatted", b"NDIME"]) {
        Some("it is a mesh; give the CAD that it was made from")
    } else if begins(&[b"**ABCDEFGHIJKLMNOPQRSTUVWXYZ"]) {
        Some("a Parasolid file; export STEP from the program that made it")
    } else if holds(b"ACIS") || begins(&[b"700 0 ", b"400 0 "]) {
        Some("an ACIS file; export STEP from the program that made it")
    } else if begins(&[b"3D Geometry File Format"]) {
        Some("a Rhino file; export STEP from the program that made it")
    } else if begins(&[b"\xd0\xcf\x11\xe0", b"V5_CFV2"]) {
        Some("a file of a CAD program; export STEP from it")
    } else if head.starts_with(&[0x1f, 0x8b]) || head.starts_with(b"PK\x03\x04") {
        Some("a compressed file; unpack it first")
    } else {
        None
    })
}

fn of_head(head: &[u8]) -> Option<SourceFormat> {
    let holds = |word: &[u8]| head.windows(word.len()).any(|window| window == word);
    let start = head.trim_ascii_start();
    if start.starts_with(b"\xef\xbb\xbfISO-10303-21") || start.starts_with(b"ISO-10303-21") || holds(b"ISO-10303-21;") {
        Some(SourceFormat::Step)
    } else if start.starts_with(b"DBRep_DrawableShape")
        || holds(b"CASCADE Topology V")
        || holds(b"Open CASCADE Topology V")
    {
        Some(SourceFormat::Brep)
    } else if is_iges(head) {
        Some(SourceFormat::Iges)
    } else {
        None
    }
}

/// Fixed lines of 80 columns with `S      1` (start section) in the last eight of the first; some writers begin with other letters (`C`: compressed).
fn is_iges(head: &[u8]) -> bool {
    head.split(|&b| b == b'\n').take(1).any(|line| {
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        line.len() == 80
            && matches!(line[72], b'S' | b'C')
            && line[73..].iter().all(|b| b.is_ascii_digit() || *b == b' ')
    })
}

/// Bytes at the end of a file among which an IGES file's last line must be.
const TAIL: i64 = 4096;

/// Whether an IGES file has its terminate section (`T` in column 73 of the last line): OCCT reads what is there of a file that
/// was cut short, and says nothing.
///
/// # Errors
/// The file cannot be opened or read.
pub(crate) fn iges_is_whole(path: &Path) -> io::Result<bool> {
    let mut file = regular::open(path)?;
    let length = file.metadata()?.len() as i64;
    file.seek(SeekFrom::End(-length.min(TAIL)))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    let last = tail.trim_ascii_end().rsplit(|&b| b == b'\n').next().unwrap_or_default();
    Ok(last.len() > 72 && last[72] == b'T')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_decides() {
        assert_eq!(of_head(b"ISO-10303-21;\nHEADER;"), Some(SourceFormat::Step));
        assert_eq!(of_head(b"DBRep_DrawableShape\n\nCASCADE Topology V1"), Some(SourceFormat::Brep));
        let iges = format!("{:72}S      1\n", "Start");
        assert_eq!(of_head(iges.as_bytes()), Some(SourceFormat::Iges));
        for other in [b"".as_slice(), b"solid stl", &[0; 200]] {
            assert_eq!(of_head(other), None);
        }
    }
}
