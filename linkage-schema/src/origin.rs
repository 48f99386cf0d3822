//! Where in a file something stands.

use std::fmt;
use std::num::NonZeroU32;

/// A line and a column of a text file, both counted from 1; the column counts bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Position {
    /// The line.
    pub line: NonZeroU32,
    /// The byte in the line.
    pub column: NonZeroU32,
}

impl Position {
    /// The first byte of a file.
    pub const START: Self = Self { line: NonZeroU32::MIN, column: NonZeroU32::MIN };

    /// Counts from 1; zeros become 1, and what passes `u32::MAX` stays there.
    pub fn new(line: u64, column: u64) -> Self {
        let clamp =
            |n: u64| u32::try_from(n).ok().map_or(NonZeroU32::MAX, |n| NonZeroU32::new(n).unwrap_or(NonZeroU32::MIN));
        Self { line: clamp(line), column: clamp(column) }
    }

    /// The place behind `text`, which begins here.
    pub(crate) fn after(self, text: &[u8]) -> Self {
        let (line, column) = (u64::from(self.line.get()), u64::from(self.column.get()));
        match text.iter().rposition(|&byte| byte == b'\n') {
            None => Self::new(line, column + text.len() as u64),
            Some(last) => {
                let lines = text.iter().filter(|&&byte| byte == b'\n').count() as u64;
                Self::new(line + lines, (text.len() - last) as u64)
            }
        }
    }
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Where an element of a document was read; nothing for one made by a program.
///
/// **Two origins are always equal.** So `==` on documents and their parts compares what they say, not where it stands.
/// Compare [`Origin::position`] where the place matters.
#[derive(Clone, Copy, Default)]
pub struct Origin(Option<Position>);

impl Origin {
    /// An element that was made, not read.
    pub const MADE: Self = Self(None);

    /// The place, if the element was read from a file.
    pub fn position(self) -> Option<Position> {
        self.0
    }
}

impl From<Position> for Origin {
    fn from(position: Position) -> Self {
        Self(Some(position))
    }
}

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl Eq for Origin {}

impl fmt::Debug for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(position) => write!(f, "@{position}"),
            None => f.write_str("@-"),
        }
    }
}
