//! How binary files begin: a mark of the byte order, the version, the keyword `Dimension`.

use super::keyword;

/// The number in which the byte order shows.
pub(super) const MARK: u32 = 1;

/// The versions that are read.
pub(super) const VERSIONS: std::ops::RangeInclusive<u32> = 1..=4;

/// Whether a file begins as a binary one, in either byte order.
pub(super) fn is_binary(head: &[u8]) -> bool {
    let word = |n: usize| -> Option<[u8; 4]> { head.get(4 * n..4 * n + 4)?.try_into().ok() };
    let begins = |number: fn([u8; 4]) -> u32| {
        let version = word(1).map_or(0, number);
        // The position of the next keyword is known; behind it stands the dimension.
        let (next, dimension) = if version < 3 { (20, 4) } else { (24, 5) };
        let next_at = if version >= 3 && word(0).map(u32::from_be_bytes) == Some(MARK) { 4 } else { 3 };
        word(0).map(number) == Some(MARK)
            && VERSIONS.contains(&version)
            && word(2).map(number) == Some(keyword::DIMENSION)
            && word(next_at).map(number) == Some(next)
            && matches!(word(dimension).map(number), Some(2 | 3))
    };
    begins(u32::from_le_bytes) || begins(u32::from_be_bytes)
}
