//! The words and brackets of Fluent's files.

use super::fault::FluentFault;
use crate::formats::error::{Fault, Flaw, Place};

/// A file being read.
pub(super) struct Lexer<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Lexer<'a> {
        Lexer { bytes, at: 0 }
    }

    /// A fault in the line where the lexer stands.
    pub(super) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        let line = 1 + self.bytes[..self.at].iter().filter(|&&byte| byte == b'\n').count();
        Flaw::new(Place::Line(line as u64), fault)
    }

    /// Bytes that follow.
    pub(super) fn rest(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// The next byte that is no white space.
    pub(super) fn peek(&mut self) -> Option<u8> {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.bytes.get(self.at).copied()
    }

    /// Takes a bracket, where it is the next.
    pub(super) fn takes(&mut self, bracket: u8) -> bool {
        let is = self.peek() == Some(bracket);
        self.at += usize::from(is);
        is
    }

    pub(super) fn expect(&mut self, bracket: u8, what: &'static str) -> Result<(), Flaw> {
        if self.takes(bracket) {
            return Ok(());
        }
        match self.peek() {
            None => Err(self.flaw(Fault::Truncated("a section"))),
            Some(found) => Err(self.flaw(Fault::Unexpected { what, found: char::from(found).to_string() })),
        }
    }

    /// The next word.
    pub(super) fn word(&mut self, what: &'static str) -> Result<&'a str, Flaw> {
        if self.peek().is_none() {
            return Err(self.flaw(Fault::Truncated(what)));
        }
        let rest = &self.bytes[self.at..];
        let length =
            rest.iter().take_while(|&&byte| !byte.is_ascii_whitespace() && !matches!(byte, b'(' | b')')).count();
        let word = std::str::from_utf8(&rest[..length]).map_err(|_| self.flaw(Fault::NotUtf8(what)))?;
        if word.is_empty() {
            let found = char::from(rest[0]).to_string();
            return Err(self.flaw(Fault::Unexpected { what, found }));
        }
        self.at += length;
        Ok(word)
    }

    /// A whole number, of hexadecimal digits.
    pub(super) fn hex(&mut self, what: &'static str) -> Result<i64, Flaw> {
        let word = self.word(what)?;
        i64::from_str_radix(word, 16)
            .map_err(|_| self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }))
    }

    pub(super) fn real(&mut self, what: &'static str) -> Result<f64, Flaw> {
        let word = self.word(what)?;
        word.parse().map_err(|_| self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }))
    }

    /// Passes over what is left of a section of so many open brackets; brackets in quotes are none.
    pub(super) fn skip(&mut self, mut open: usize) -> Result<(), Flaw> {
        let mut quoted = false;
        while open > 0 {
            let Some(&byte) = self.bytes.get(self.at) else { return Err(self.flaw(Fault::Truncated("a section"))) };
            self.at += 1;
            match byte {
                b'"' => quoted = !quoted,
                b'(' if !quoted => open += 1,
                b')' if !quoted => open -= 1,
                b'\\' if quoted => self.at = (self.at + 1).min(self.bytes.len()),
                _ => {}
            }
        }
        Ok(())
    }

    /// The head of a section: its numbers in brackets.
    pub(super) fn head(&mut self) -> Result<Vec<i64>, Flaw> {
        self.expect(b'(', "(")?;
        let mut numbers = Vec::new();
        while !self.takes(b')') {
            numbers.push(self.hex("the head of a section")?);
        }
        Ok(numbers)
    }

    /// First and last of a section's items, which follow each in `least` bytes or more.
    pub(super) fn range(&self, section: i64, head: &[i64], least: usize) -> Result<(usize, usize), Flaw> {
        let [first, last] = [1, 2].map(|n| head.get(n).copied().unwrap_or(0));
        let range = usize::try_from(first).ok().zip(usize::try_from(last).ok()).filter(|&(a, b)| 0 < a && a <= b + 1);
        let (a, b) = range.ok_or_else(|| self.flaw(FluentFault::Range { section, first, last }))?;
        let (count, rest) = ((b + 1 - a) as u64, self.rest() as u64);
        // Those before the first stand in the file, too.
        let before = (a as u64 - 1).saturating_mul(least as u64);
        if count.saturating_mul(least as u64) > rest || before > self.bytes.len() as u64 {
            return Err(self.flaw(Fault::Count { what: "items of a section", count, rest }));
        }
        Ok((a, b))
    }
}
