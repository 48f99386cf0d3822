//! How a binary PLOT3D grid is written, by its size.

use std::fmt;
use std::str::FromStr;

use crate::formats::numbers::Layout;

/// How a binary PLOT3D grid is written; as text `lr4,several,iblank`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridLayout {
    pub(super) layout: Layout,
    /// A number of blocks stands before their sizes.
    pub(super) several: bool,
    /// Whole numbers (iblank) follow the coordinates of each block.
    pub(super) blanks: bool,
}

impl GridLayout {
    /// All ways of writing.
    pub(super) fn all() -> impl Iterator<Item = GridLayout> {
        (0..32).map(|bits: u8| GridLayout {
            layout: Layout {
                big_endian: bits & 1 != 0,
                short_reals: bits & 2 != 0,
                records: bits & 4 != 0,
                long_ints: false,
            },
            several: bits & 8 != 0,
            blanks: bits & 16 != 0,
        })
    }

    /// The ways of writing whose length for the sizes in the head is the file's length.
    pub(super) fn fitting(head: &[u8], length: u64) -> Vec<GridLayout> {
        GridLayout::all().filter(|kind| kind.length(head).is_some_and(|own| own == length)).collect()
    }
}

impl fmt::Display for GridLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let order = if self.layout.big_endian { "" } else { "l" };
        let records = if self.layout.records { "r" } else { "b" };
        let blocks = if self.several { "several" } else { "one" };
        let blanks = if self.blanks { ",iblank" } else { "" };
        write!(f, "{order}{records}{},{blocks}{blanks}", self.layout.real_width())
    }
}

/// A text that stands for no way of writing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "not as lr4,several,iblank: l for little-endian, b (C) or r (Fortran records), 4 or 8 bytes; one or several blocks"
)]
pub struct UnknownLayout;

impl FromStr for GridLayout {
    type Err = UnknownLayout;

    fn from_str(text: &str) -> Result<GridLayout, UnknownLayout> {
        GridLayout::all().find(|kind| kind.to_string() == text).ok_or(UnknownLayout)
    }
}

impl GridLayout {
    /// The length of a file that is written so, if its head can be.
    fn length(self, head: &[u8]) -> Option<u64> {
        let Layout { big_endian, records, .. } = self.layout;
        let word = |n: usize| -> Option<u64> {
            let bytes: [u8; 4] = head.get(4 * n..4 * n + 4)?.try_into().ok()?;
            Some(u64::from(if big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }))
        };
        let marker = usize::from(records);
        let mut place = 0;
        let mut count = 1;
        if self.several {
            if records && (word(0)? != 4 || word(2)? != 4) {
                return None;
            }
            count = word(marker)?;
            place = 1 + 2 * marker;
        }
        if records && word(place)? != count.checked_mul(12)? {
            return None;
        }
        let header = place as u64 + 2 * marker as u64 + count.checked_mul(3)?;
        let mut points: u64 = 0;
        for block in 0..usize::try_from(count).ok()? {
            let at = place + marker + 3 * block;
            let [i, j, k] = [word(at)?, word(at + 1)?, word(at + 2)?];
            points = points.checked_add(i.checked_mul(j)?.checked_mul(k)?)?;
        }
        let each = 3 * self.layout.real_width() + if self.blanks { 4 } else { 0 };
        let markers = if records { count.checked_mul(8)? } else { 0 };
        points.checked_mul(each)?.checked_add(4 * header)?.checked_add(markers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_way_of_writing_has_a_text_of_its_own() {
        for kind in GridLayout::all() {
            assert_eq!(kind.to_string().parse(), Ok(kind), "{kind}");
        }
        assert_eq!("lr4".parse::<GridLayout>(), Err(UnknownLayout));
    }
}
