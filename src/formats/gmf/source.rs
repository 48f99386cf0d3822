//! The keywords and numbers of a file, whether it is text or binary.

use super::fault::GmfFault;
use super::keyword::Keyword;
use crate::formats::error::{Fault, Flaw, Place};
use crate::formats::scanner::Scanner;

/// A file being read.
pub(super) enum Source<'a> {
    Text(Scanner<&'a [u8]>),
    Binary(Bytes<'a>),
}

/// A binary file: its content, where the reader stands, and how numbers are written.
pub(super) struct Bytes<'a> {
    content: &'a [u8],
    at: usize,
    big_endian: bool,
    version: i64,
    /// Where the next keyword is.
    next: usize,
}

impl<'a> Source<'a> {
    /// Reads the version.
    ///
    /// # Errors
    /// [`GmfFault::Version`].
    pub(super) fn new(content: &'a [u8]) -> Result<Source<'a>, Flaw> {
        let what = "the version";
        if content.first().is_some_and(|&byte| byte <= 1) {
            let mut bytes = Bytes { content, at: 0, big_endian: content[0] == 0, version: 1, next: 8 };
            bytes.at = 4; // the number 1
            bytes.version = bytes.small_int(what)?;
            return match bytes.version {
                1..=4 => Ok(Source::Binary(bytes)),
                other => Err(bytes.flaw(GmfFault::Version(other))),
            };
        }
        let mut source = Source::Text(Scanner::new(content, content.len() as u64));
        let word = source.word(what)?;
        let version = match word.strip_prefix("MeshVersionFormatted") {
            Some("") => source.int(what)?,
            Some(rest) => rest.parse().unwrap_or(0),
            None => return Err(source.flaw(Fault::Unexpected { what: "MeshVersionFormatted", found: word })),
        };
        if (1..=4).contains(&version) { Ok(source) } else { Err(source.flaw(GmfFault::Version(version))) }
    }

    /// A fault here.
    pub(super) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        match self {
            Source::Text(scanner) => scanner.flaw(fault),
            Source::Binary(bytes) => bytes.flaw(fault),
        }
    }

    /// The next keyword, or the name of one that is not read, whose lines are passed over; `None` at the end of the file.
    pub(super) fn keyword(&mut self) -> Result<Option<Result<Keyword, String>>, Flaw> {
        match self {
            Source::Binary(bytes) => bytes.keyword(),
            Source::Text(_) => loop {
                let Some(word) = self.next_word()? else { return Ok(None) };
                // Numbers belong to a keyword that is not read.
                if word.starts_with(|first: char| first.is_ascii_alphabetic()) {
                    return Ok(Some(Keyword::of_name(&word).ok_or(word)));
                }
            },
        }
    }

    /// The number of lines of a keyword, of so many whole and real numbers each: no more than the file has room for.
    pub(super) fn count(&mut self, what: &'static str, ints: u64, reals: u64) -> Result<usize, Flaw> {
        let (count, rest, least) = match self {
            Source::Text(scanner) => (scanner.number(what)?, scanner.rest(), 2 * (ints + reals)),
            Source::Binary(bytes) => {
                let count = bytes.long_int(what, bytes.version > 3)?;
                (count, bytes.rest(), bytes.int_width() * ints + bytes.real_width() * reals)
            }
        };
        let fits = u64::try_from(count).ok().filter(|count| count.saturating_mul(least) <= rest.saturating_add(1));
        let checked = fits.and_then(|count| usize::try_from(count).ok());
        checked.ok_or_else(|| self.flaw(Fault::Count { what, count: count.max(0) as u64, rest }))
    }

    /// The dimension of the vertices.
    pub(super) fn dimension(&mut self) -> Result<i64, Flaw> {
        let what = "the dimension";
        match self {
            Source::Text(scanner) => scanner.number(what),
            Source::Binary(bytes) => bytes.small_int(what),
        }
    }

    /// A whole number.
    pub(super) fn int(&mut self, what: &'static str) -> Result<i64, Flaw> {
        match self {
            Source::Text(scanner) => scanner.number(what),
            Source::Binary(bytes) => bytes.long_int(what, bytes.version > 3),
        }
    }

    /// A real number.
    pub(super) fn real(&mut self, what: &'static str) -> Result<f64, Flaw> {
        match self {
            Source::Text(scanner) => scanner.number(what),
            Source::Binary(bytes) => bytes.real(what),
        }
    }

    /// The next word that is no comment, where the file may not end.
    fn word(&mut self, what: &'static str) -> Result<String, Flaw> {
        self.next_word()?.ok_or_else(|| self.flaw(Fault::Truncated(what)))
    }

    fn next_word(&mut self) -> Result<Option<String>, Flaw> {
        let Source::Text(scanner) = self else { return Ok(None) };
        while scanner.more()? {
            let word = scanner.word("a keyword")?.to_owned();
            if !word.starts_with('#') {
                return Ok(Some(word));
            }
            scanner.rest_of_line()?;
        }
        Ok(None)
    }
}

impl Bytes<'_> {
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        Flaw::new(Place::Byte(self.at as u64), fault)
    }

    fn rest(&self) -> u64 {
        (self.content.len() - self.at) as u64
    }

    fn int_width(&self) -> u64 {
        if self.version > 3 { 8 } else { 4 }
    }

    fn real_width(&self) -> u64 {
        if self.version > 1 { 8 } else { 4 }
    }

    fn keyword(&mut self) -> Result<Option<Result<Keyword, String>>, Flaw> {
        if self.next == 0 || self.next >= self.content.len() {
            return Ok(None);
        }
        self.at = self.next;
        let code = self.small_int("a keyword")?;
        let next = self.long_int("the place of the next keyword", self.version > 2)?;
        let place = usize::try_from(next).ok().filter(|&next| next == 0 || next >= self.at);
        let Some(place) = place.filter(|&next| next <= self.content.len()) else {
            return Err(self.flaw(GmfFault::Next(next as u64)));
        };
        self.next = place;
        Ok(Some(Keyword::of_code(code).ok_or_else(|| format!("number {code}"))))
    }

    fn take<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], Flaw> {
        let Some(&bytes) = self.content[self.at..].first_chunk::<N>() else {
            return Err(self.flaw(Fault::Truncated(what)));
        };
        self.at += N;
        Ok(bytes)
    }

    fn small_int(&mut self, what: &'static str) -> Result<i64, Flaw> {
        let bytes = self.take(what)?;
        Ok(i64::from(if self.big_endian { i32::from_be_bytes(bytes) } else { i32::from_le_bytes(bytes) }))
    }

    /// A whole number of 8 bytes where it is `long`, else of 4.
    fn long_int(&mut self, what: &'static str, long: bool) -> Result<i64, Flaw> {
        if !long {
            return self.small_int(what);
        }
        let bytes = self.take(what)?;
        Ok(if self.big_endian { i64::from_be_bytes(bytes) } else { i64::from_le_bytes(bytes) })
    }

    fn real(&mut self, what: &'static str) -> Result<f64, Flaw> {
        if self.version > 1 {
            let bytes = self.take(what)?;
            return Ok(if self.big_endian { f64::from_be_bytes(bytes) } else { f64::from_le_bytes(bytes) });
        }
        let bytes = self.take(what)?;
        Ok(f64::from(if self.big_endian { f32::from_be_bytes(bytes) } else { f32::from_le_bytes(bytes) }))
    }
}
