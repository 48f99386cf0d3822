//! The bytes of a mesh file, taken by line, word or number, with the place kept for errors.

use std::io::BufRead;

use crate::formats::error::{Fault, Flaw, Place};
use crate::formats::names;

/// Longest line that is read as text: names may be long, but not without end.
const LONGEST_LINE: usize = 1 << 16;
/// Longest word that is read as a number.
const LONGEST_WORD: usize = 1 << 10;

/// A file being read.
pub(super) struct Scanner<R> {
    input: R,
    length: u64,
    offset: u64,
    line: u64,
    word: Vec<u8>,
    /// The line of the word that was taken last; 0 before the first.
    word_line: u64,
    /// Whether places are given as byte offsets.
    pub(super) binary: bool,
}

impl<R: BufRead> Scanner<R> {
    /// A scanner of input of a known length.
    pub(super) fn new(input: R, length: u64) -> Scanner<R> {
        Scanner { input, length, offset: 0, line: 1, word: Vec::new(), word_line: 0, binary: false }
    }

    /// Where the scanner stands.
    pub(super) fn place(&self) -> Place {
        if self.binary { Place::Byte(self.offset) } else { Place::Line(self.line) }
    }

    /// The line it stands in, counted from 1.
    pub(super) fn line_number(&self) -> u64 {
        self.line
    }

    /// Bytes not yet read.
    pub(super) fn rest(&self) -> u64 {
        self.length.saturating_sub(self.offset)
    }

    /// A fault here.
    pub(super) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        Flaw::new(self.place(), fault)
    }

    fn peek(&mut self) -> Result<Option<u8>, Flaw> {
        let (offset, line, binary) = (self.offset, self.line, self.binary);
        let place = if binary { Place::Byte(offset) } else { Place::Line(line) };
        let buffer = self.input.fill_buf().map_err(|e| Flaw::new(place, e))?;
        Ok(buffer.first().copied())
    }

    fn step(&mut self, byte: u8) {
        self.input.consume(1);
        self.offset += 1;
        self.line += u64::from(byte == b'\n');
    }

    /// The next line that is not empty, trimmed; `None` at the end of the file.
    pub(super) fn line(&mut self, what: &'static str) -> Result<Option<String>, Flaw> {
        self.word.clear();
        while let Some(byte) = self.peek()? {
            if byte == b'\n' && !self.word.is_empty() {
                break; // the line end stays for the next call, so that the place is this line's
            }
            self.step(byte);
            if !(self.word.is_empty() && byte.is_ascii_whitespace()) {
                self.word.push(byte);
            }
            if self.word.len() > LONGEST_LINE {
                let found = String::from_utf8_lossy(&self.word[..40]).into_owned();
                return Err(self.flaw(Fault::Unexpected { what, found }));
            }
        }
        if self.word.is_empty() {
            return Ok(None);
        }
        Ok(Some(names::text(&self.word).trim_end().to_owned()))
    }

    /// The next line that is not empty, where the file may not end.
    pub(super) fn full_line(&mut self, what: &'static str) -> Result<String, Flaw> {
        match self.line(what)? {
            Some(line) => Ok(line),
            None => Err(self.flaw(Fault::Truncated(what))),
        }
    }

    /// Goes past the end of the present line: binary data begin there.
    pub(super) fn end_line(&mut self, what: &'static str) -> Result<(), Flaw> {
        match self.peek()? {
            Some(b'\n') => {
                self.step(b'\n');
                Ok(())
            }
            Some(other) => {
                let found = char::from(other).to_string();
                Err(self.flaw(Fault::Unexpected { what, found }))
            }
            None => Err(self.flaw(Fault::Truncated(what))),
        }
    }

    /// The next word: characters up to white space.
    pub(super) fn word(&mut self, what: &'static str) -> Result<&str, Flaw> {
        self.word.clear();
        while let Some(byte) = self.peek()? {
            let space = byte.is_ascii_whitespace();
            if (space && !self.word.is_empty()) || self.word.len() > LONGEST_WORD {
                break;
            }
            self.step(byte);
            if !space {
                self.word.push(byte);
            }
        }
        self.word_line = self.line;
        if self.word.is_empty() {
            return Err(self.flaw(Fault::Truncated(what)));
        }
        let place = self.place();
        std::str::from_utf8(&self.word).map_err(|_| Flaw::new(place, Fault::NotUtf8(what)))
    }

    /// Goes to the next word, which must be the first of its line; the line.
    pub(super) fn begin_row(&mut self, what: &'static str) -> Result<u64, Flaw> {
        let follows = self.more()?;
        if follows && self.word_line == self.line {
            return Err(self.flaw(Fault::Row(what)));
        }
        Ok(self.line)
    }

    /// Refuses a row of numbers that has taken more than the line it began in, or that leaves some of it.
    pub(super) fn end_row(&mut self, begun: u64, what: &'static str) -> Result<(), Flaw> {
        if self.word_line != begun {
            return Err(Flaw::new(Place::Line(begun), Fault::Row(what)));
        }
        while let Some(byte) = self.peek()? {
            match byte {
                b'\n' => break,
                _ if byte.is_ascii_whitespace() => self.step(byte),
                _ => return Err(self.flaw(Fault::Row(what))),
            }
        }
        Ok(())
    }

    /// Whether a word follows; white space before it is passed over.
    pub(super) fn more(&mut self) -> Result<bool, Flaw> {
        while let Some(byte) = self.peek()? {
            if !byte.is_ascii_whitespace() {
                return Ok(true);
            }
            self.step(byte);
        }
        Ok(false)
    }

    /// Whether a word follows outside of comments, which begin with `#` and end with their line, in whatever encoding; they are passed
    /// over.
    pub(super) fn past_comments(&mut self) -> Result<bool, Flaw> {
        while self.more()? {
            if self.peek()? != Some(b'#') {
                return Ok(true);
            }
            self.rest_of_line()?;
        }
        Ok(false)
    }

    /// The next word, parsed.
    pub(super) fn number<T: std::str::FromStr>(&mut self, what: &'static str) -> Result<T, Flaw> {
        if let Ok(value) = self.word(what)?.parse() {
            return Ok(value);
        }
        let found: String = String::from_utf8_lossy(&self.word).chars().take(40).collect();
        Err(self.flaw(Fault::Number { what, found }))
    }

    /// The next `N` bytes.
    pub(super) fn bytes<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], Flaw> {
        let mut bytes = [0; N];
        self.fill(&mut bytes, what)?;
        Ok(bytes)
    }

    /// The next bytes, as many as there is room for.
    pub(super) fn fill(&mut self, bytes: &mut [u8], what: &'static str) -> Result<(), Flaw> {
        match self.input.read_exact(bytes) {
            Ok(()) => {
                self.offset += bytes.len() as u64;
                Ok(())
            }
            Err(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => Err(self.flaw(Fault::Truncated(what))),
            Err(e) => Err(self.flaw(e)),
        }
    }

    /// Goes past what is left of the present line.
    pub(super) fn rest_of_line(&mut self) -> Result<(), Flaw> {
        while let Some(byte) = self.peek()? {
            if byte == b'\n' {
                break;
            }
            self.step(byte);
        }
        Ok(())
    }

    /// Goes past the next empty line.
    pub(super) fn skip_paragraph(&mut self) -> Result<(), Flaw> {
        let mut ends = 0;
        while let Some(byte) = self.peek()? {
            self.step(byte);
            match byte {
                b'\n' => ends += 1,
                b' ' | b'\t' | b'\r' => {}
                _ => ends = 0,
            }
            if ends == 2 {
                break;
            }
        }
        Ok(())
    }

    /// Whether these characters follow, after white space; as far as the input is buffered.
    pub(super) fn next_is(&mut self, text: &[u8]) -> Result<bool, Flaw> {
        let buffer = self.input.fill_buf().map_err(|e| Flaw::new(Place::Byte(self.offset), e))?;
        Ok(buffer.trim_ascii_start().starts_with(text))
    }

    /// Goes past the end marker of a section whose content nobody wants.
    pub(super) fn skip_section(&mut self, section: &str) -> Result<(), Flaw> {
        let start = self.place();
        let marker = format!("$End{section}").into_bytes();
        let mut matched = 0;
        while matched < marker.len() {
            let Some(byte) = self.peek()? else {
                return Err(Flaw::new(start, Fault::Truncated("a section that is not read")));
            };
            self.step(byte);
            // The marker's first character occurs nowhere else in it, so a mismatch restarts at once.
            matched = if byte == marker[matched] { matched + 1 } else { usize::from(byte == marker[0]) };
        }
        Ok(())
    }
}
