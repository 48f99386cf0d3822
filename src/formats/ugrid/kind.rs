//! How a UGRID file's numbers are written.

use std::path::Path;

use crate::element::Cell;
use crate::formats::numbers::{Encoding, Layout};

/// The faces, then the volume cells, in file order.
pub(super) const FACES: [Cell; 2] = [Cell::Triangle, Cell::Quad];
pub(super) const CELLS: [Cell; 4] = [Cell::Tet, Cell::Pyramid, Cell::Prism, Cell::Hex];

/// Bytes of the head that tell the kind: a record's length and seven long counts.
const HEAD: usize = 4 + 7 * 8;

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// How the numbers are written: as the name says, if the sizes agree; else as the sizes tell.
///
/// # Errors
/// What to tell the user.
pub(super) fn encoding(path: &Path, head: &[u8], length: u64) -> Result<Encoding, String> {
    let stem = path.file_stem().map(Path::new);
    let word = stem.and_then(extension).unwrap_or_default();
    let long = extension(path).as_deref() == Some("ugrid64");
    let named = named(&word, long);
    let holds = |encoding: &Encoding| match encoding {
        Encoding::Text => true,
        Encoding::Bytes(layout) => size(*layout, head).is_some_and(|size| size <= length),
    };
    if let Some(named) = named {
        if holds(&named) {
            return Ok(named);
        }
        let other = fitting(head, length);
        let other = if other.is_empty() { "a file that is cut off".to_owned() } else { words(&other) };
        return Err(format!(
            "its name says {word}, but its counts do not fit its {length} bytes: it looks like {other}"
        ));
    }
    if text(head) {
        return Ok(Encoding::Text);
    }
    match fitting(head, length)[..] {
        [only] => Ok(Encoding::Bytes(only)),
        [] => Err(
            "the counts of a UGRID file do not fit its length in any byte order or width: it is cut off or damaged; \
             name it by its kind, as case.lb8.ugrid"
                .to_owned(),
        ),
        ref several => Err(format!(
            "the counts of a UGRID file fit its length as {}; name it by its kind, as case.lb8.ugrid",
            words(several)
        )),
    }
}

/// The words that name layouts, as a choice.
fn words(layouts: &[Layout]) -> String {
    let words: Vec<String> = layouts.iter().map(|&layout| word_of(layout)).collect();
    words.join(" or ")
}

fn named(word: &str, long: bool) -> Option<Encoding> {
    let (word, long) = word.strip_suffix('l').map_or((word, long), |short| (short, true));
    let (big_endian, rest) = word.strip_prefix('l').map_or((true, word), |rest| (false, rest));
    let (records, short_reals) = match rest {
        "b8" => (false, false),
        "b4" => (false, true),
        "r8" => (true, false),
        "r4" => (true, true),
        _ => return None,
    };
    Some(Encoding::Bytes(Layout { big_endian, long_ints: long, short_reals, records }))
}

/// The word that names a layout.
fn word_of(layout: Layout) -> String {
    let flag = |on: bool, text: &'static str| if on { text } else { "" };
    let kind = if layout.records { "r" } else { "b" };
    format!("{}{kind}{}{}", flag(!layout.big_endian, "l"), layout.real_width(), flag(layout.long_ints, "l"))
}

fn text(head: &[u8]) -> bool {
    let head = &head[..head.len().min(HEAD)];
    head.iter().all(|byte| byte.is_ascii_digit() || byte.is_ascii_whitespace() || b"+-.eEdD".contains(byte))
}

/// The layouts whose size is the file's; else those whose size is less, as writers may add to the end.
fn fitting(head: &[u8], length: u64) -> Vec<Layout> {
    let all = (0..16).map(|bits: u8| Layout {
        big_endian: bits & 1 != 0,
        short_reals: bits & 2 != 0,
        long_ints: bits & 4 != 0,
        records: bits & 8 != 0,
    });
    let sizes: Vec<(Layout, u64)> = all.filter_map(|layout| Some((layout, size(layout, head)?))).collect();
    let of = |fits: fn(u64, u64) -> bool| -> Vec<Layout> {
        sizes.iter().filter(|(_, size)| fits(*size, length)).map(|&(layout, _)| layout).collect()
    };
    let exact = of(|size, length| size == length);
    if exact.is_empty() { of(|size, length| size < length) } else { exact }
}

/// The length of a file with the counts that the head gives in this layout; `None` where they are none.
fn size(layout: Layout, head: &[u8]) -> Option<u64> {
    let width = layout.int_width();
    let start = if layout.records { 4 } else { 0 };
    if layout.records {
        let marker: [u8; 4] = head.get(..4)?.try_into().ok()?;
        let marker = if layout.big_endian { u32::from_be_bytes(marker) } else { u32::from_le_bytes(marker) };
        if u64::from(marker) != 7 * width {
            return None;
        }
    }
    let mut counts = [0; 7];
    for (n, count) in counts.iter_mut().enumerate() {
        let bytes = head.get(start + n * width as usize..)?.get(..width as usize)?;
        let mut wide = [0; 8];
        if layout.big_endian {
            wide[8 - bytes.len()..].copy_from_slice(bytes);
            *count = u64::from_be_bytes(wide);
        } else {
            wide[..bytes.len()].copy_from_slice(bytes);
            *count = u64::from_le_bytes(wide);
        }
    }
    let [points, triangles, quads, cells @ ..] = counts;
    let corners = |cell: Cell| cell.corner_count() as u64;
    let mut ints = triangles.checked_mul(corners(Cell::Triangle) + 1)?;
    ints = ints.checked_add(quads.checked_mul(corners(Cell::Quad) + 1)?)?;
    for (cell, count) in CELLS.into_iter().zip(cells) {
        ints = ints.checked_add(count.checked_mul(corners(cell))?)?;
    }
    let ints = ints.checked_add(7)?.checked_mul(width)?;
    let reals = points.checked_mul(3 * layout.real_width())?;
    ints.checked_add(reals)?.checked_add(if layout.records { 16 } else { 0 })
}
