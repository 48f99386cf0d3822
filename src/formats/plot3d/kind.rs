//! How a binary PLOT3D grid is written, by its size.

use crate::formats::numbers::Layout;

/// How a grid is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    pub(super) layout: Layout,
    /// A number of blocks stands before their sizes.
    pub(super) several: bool,
    /// Whole numbers (iblank) follow the coordinates of each block.
    pub(super) blanks: bool,
}

/// The way of writing whose length for the sizes in the head is the file's length.
pub(super) fn of(head: &[u8], length: u64) -> Option<Kind> {
    let all = (0..32).map(|bits: u8| Kind {
        layout: Layout {
            big_endian: bits & 1 != 0,
            short_reals: bits & 2 != 0,
            records: bits & 4 != 0,
            long_ints: false,
        },
        several: bits & 8 != 0,
        blanks: bits & 16 != 0,
    });
    all.into_iter().find(|kind| kind.length(head).is_some_and(|own| own == length))
}

impl Kind {
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
