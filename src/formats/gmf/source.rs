//! Keywords and numbers of a GMF file, whether written as text or as bytes.

use std::io::BufRead;

use super::fault::GmfFault;
use super::header::{MARK, VERSIONS};
use super::keyword::Keyword;
use crate::formats::error::{Fault, Flaw};
use crate::formats::scanner::Scanner;

/// Keywords that are not known of which is told.
const UNKNOWN: usize = 10;

/// A file being read.
pub(super) struct Source<R> {
    scanner: Scanner<R>,
    length: u64,
    form: Form,
    /// Keywords that are not known, as words or numbers.
    pub(super) unknown: Vec<String>,
    /// Whether the keyword `End` was met.
    pub(super) ended: bool,
}

enum Form {
    Text {
        /// Whether the content of the keyword before is read to its end, so that another must follow.
        complete: bool,
    },
    Bytes(Layout),
}

/// How a binary file is written.
struct Layout {
    version: u32,
    /// Whether the byte order is the other one than little-endian.
    swap: bool,
    /// 4 bytes a real number rather than 8.
    short_reals: bool,
    /// Where the content of the present keyword ends.
    end: u64,
    /// Whether no keyword follows it.
    last: bool,
}

impl<R: BufRead> Source<R> {
    /// A text of a known length; its version says nothing about how it is written.
    pub(super) fn text(input: R, length: u64) -> Result<Source<R>, Flaw> {
        let form = Form::Text { complete: false };
        let mut source =
            Source { scanner: Scanner::new(input, length), length, form, unknown: Vec::new(), ended: false };
        let what = "MeshVersionFormatted";
        source.scanner.past_comments()?;
        let word = source.scanner.word(what)?.to_owned();
        let version = match word.strip_prefix(what) {
            Some("") => source.int("the version")?,
            Some(version) => version.parse().unwrap_or(0),
            None => return Err(source.flaw(Fault::Unexpected { what, found: word.chars().take(40).collect() })),
        };
        match u32::try_from(version) {
            Ok(known) if VERSIONS.contains(&known) => {
                source.form = Form::Text { complete: true };
                Ok(source)
            }
            _ => Err(source.flaw(GmfFault::Version(version))),
        }
    }

    /// A binary file of a known length.
    pub(super) fn binary(input: R, length: u64) -> Result<Source<R>, Flaw> {
        let mut scanner = Scanner::new(input, length);
        scanner.binary = true;
        let swap = u32::from_le_bytes(scanner.bytes("the byte order")?) != MARK;
        let layout = Layout { version: 0, swap, short_reals: false, end: 0, last: false };
        let mut source = Source { scanner, length, form: Form::Bytes(layout), unknown: Vec::new(), ended: false };
        let version = u32::from_le_bytes(source.raw("the version")?);
        if !VERSIONS.contains(&version) {
            return Err(source.flaw(GmfFault::Version(version.into())));
        }
        if let Form::Bytes(layout) = &mut source.form {
            (layout.version, layout.short_reals, layout.end) = (version, version == 1, 8);
        }
        Ok(source)
    }

    /// A fault here.
    pub(super) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        self.scanner.flaw(fault)
    }

    /// The next keyword that is known; `None` at the end.
    pub(super) fn keyword(&mut self) -> Result<Option<Keyword>, Flaw> {
        let keyword = match self.form {
            Form::Text { .. } => self.word()?,
            Form::Bytes(_) => self.code()?,
        };
        self.ended |= keyword == Some(Keyword::End);
        Ok(keyword.filter(|&keyword| keyword != Keyword::End))
    }

    fn word(&mut self) -> Result<Option<Keyword>, Flaw> {
        while self.scanner.past_comments()? {
            let word = self.scanner.word("a keyword")?;
            let first = word.chars().next().unwrap_or_default();
            // A word of what is not read is mostly a number.
            let keyword = if first.is_alphabetic() { Keyword::of_word(word) } else { None };
            let found: String = word.chars().take(40).collect();
            let Form::Text { complete } = &mut self.form else { return Ok(None) };
            if keyword.is_none() && *complete && !first.is_alphabetic() {
                let what =
                    "a keyword (more numbers than announced, or elements with more nodes than their keyword says?)";
                return Err(self.flaw(Fault::Unexpected { what, found }));
            }
            *complete = keyword.is_some();
            if keyword.is_none() && first.is_alphabetic() {
                self.tell_unknown(found);
            }
            if keyword.is_some() {
                return Ok(keyword);
            }
        }
        Ok(None)
    }

    fn code(&mut self) -> Result<Option<Keyword>, Flaw> {
        loop {
            self.skip()?;
            let Form::Bytes(Layout { version, last, .. }) = self.form else { return Ok(None) };
            if last || self.scanner.rest() == 0 {
                return Ok(None);
            }
            let what = "a keyword's head";
            let code = i32::from_le_bytes(self.raw(what)?);
            let long = version >= 3;
            let next =
                if long { u64::from_le_bytes(self.raw(what)?) } else { u32::from_le_bytes(self.raw(what)?).into() };
            if next != 0 && (next < self.position() || next > self.length) {
                return Err(self.flaw(GmfFault::Position { code, next }));
            }
            let end = if next == 0 { self.length } else { next };
            if let Form::Bytes(layout) = &mut self.form {
                (layout.end, layout.last) = (end, next == 0);
            }
            if let Some(keyword) = Keyword::of_code(code) {
                return Ok(Some(keyword));
            }
            self.tell_unknown(code.to_string());
        }
    }

    /// Keeps a keyword that is not known, each once and not many of them.
    fn tell_unknown(&mut self, keyword: String) {
        if self.unknown.len() < UNKNOWN && !self.unknown.contains(&keyword) {
            self.unknown.push(keyword);
        }
    }

    /// Refuses what is left of a keyword's content: it must end where its rows do.
    pub(super) fn end_keyword(&self) -> Result<(), Flaw> {
        match self.form {
            Form::Bytes(Layout { end, .. }) if self.position() < end => {
                Err(self.flaw(Fault::Leftover(end - self.position())))
            }
            _ => Ok(()),
        }
    }

    /// Leaves the rest of a keyword's content unread.
    pub(super) fn pass_over(&mut self) {
        if let Form::Text { complete } = &mut self.form {
            *complete = false;
        }
    }

    /// Goes to the end of the present keyword's content.
    fn skip(&mut self) -> Result<(), Flaw> {
        let Form::Bytes(Layout { end, .. }) = self.form else { return Ok(()) };
        let mut piece = [0; 1 << 12];
        while self.position() < end {
            let length = (end - self.position()).min(piece.len() as u64) as usize;
            self.scanner.fill(&mut piece[..length], "what is not read")?;
        }
        Ok(())
    }

    fn position(&self) -> u64 {
        self.length - self.scanner.rest()
    }

    fn raw<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], Flaw> {
        let mut bytes = self.scanner.bytes(what)?;
        if matches!(self.form, Form::Bytes(Layout { swap: true, .. })) {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// The number behind `Dimension`, which has 4 bytes in all versions.
    pub(super) fn dimension(&mut self) -> Result<i64, Flaw> {
        match self.form {
            Form::Text { .. } => self.int("the dimension"),
            Form::Bytes(_) => Ok(i32::from_le_bytes(self.raw("the dimension")?).into()),
        }
    }

    /// A whole number.
    pub(super) fn int(&mut self, what: &'static str) -> Result<i64, Flaw> {
        match self.form {
            Form::Text { .. } => self.parsed(what),
            Form::Bytes(Layout { version: 4, .. }) => Ok(i64::from_le_bytes(self.raw(what)?)),
            Form::Bytes(_) => Ok(i32::from_le_bytes(self.raw(what)?).into()),
        }
    }

    /// A real number.
    pub(super) fn real(&mut self, what: &'static str) -> Result<f64, Flaw> {
        match self.form {
            Form::Text { .. } => self.parsed(what),
            Form::Bytes(Layout { short_reals: true, .. }) => Ok(f32::from_le_bytes(self.raw(what)?).into()),
            Form::Bytes(_) => Ok(f64::from_le_bytes(self.raw(what)?)),
        }
    }

    /// A word as a number; Fortran's `D` may stand for `E`.
    fn parsed<T: std::str::FromStr>(&mut self, what: &'static str) -> Result<T, Flaw> {
        self.scanner.past_comments()?;
        let word = self.scanner.word(what)?;
        // Fortran's exponents too.
        if let Ok(value) = word.parse().or_else(|_| word.replace(['D', 'd'], "E").parse()) {
            return Ok(value);
        }
        let found = word.chars().take(40).collect();
        Err(self.flaw(Fault::Number { what, found }))
    }

    /// Says how many bits reals have in a binary file, whatever its version.
    pub(super) fn set_precision(&mut self, bits: i64) -> Result<(), Flaw> {
        match (&mut self.form, bits) {
            (Form::Bytes(layout), 32 | 64) => layout.short_reals = bits == 32,
            (Form::Text { .. }, _) => {}
            _ => return Err(self.flaw(GmfFault::Precision(bits))),
        }
        Ok(())
    }

    /// A count of rows of `ints` and `reals` numbers that the file can hold, so that it may be allocated for.
    pub(super) fn count(&mut self, what: &'static str, ints: u64, reals: u64) -> Result<usize, Flaw> {
        let count = self.int(what)?;
        let (rest, least) = match &self.form {
            // The last word of a text needs no space after it.
            Form::Text { .. } => (self.scanner.rest() + 1, 2 * (ints + reals)),
            Form::Bytes(Layout { version, short_reals, end, .. }) => {
                let (int, real) = (if *version == 4 { 8 } else { 4 }, if *short_reals { 4 } else { 8 });
                (end.saturating_sub(self.position()), int * ints + real * reals)
            }
        };
        let Ok(count) = u64::try_from(count) else {
            return Err(self.flaw(Fault::Number { what, found: count.to_string() }));
        };
        match usize::try_from(count) {
            Ok(fits) if count <= rest / least.max(1) => Ok(fits),
            _ => Err(self.flaw(Fault::Count { what, count, rest })),
        }
    }
}
