//! Numbers of files whose header does not say how they are encoded: words, or bytes of some width and order.

use std::io::BufRead;

use super::error::{Fault, Flaw};
use super::scanner::Scanner;

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    /// As words.
    Text,
    /// As bytes.
    Bytes(Layout),
}

/// How numbers are written as bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Layout {
    /// Most significant byte first.
    pub(super) big_endian: bool,
    /// 8 bytes a whole number rather than 4.
    pub(super) long_ints: bool,
    /// 4 bytes a real number rather than 8.
    pub(super) short_reals: bool,
    /// In Fortran's records: their length in bytes, 4 bytes long, before and after each.
    pub(super) records: bool,
}

impl Layout {
    /// Bytes of a whole number.
    pub(super) fn int_width(self) -> u64 {
        if self.long_ints { 8 } else { 4 }
    }

    /// Bytes of a real number.
    pub(super) fn real_width(self) -> u64 {
        if self.short_reals { 4 } else { 8 }
    }
}

/// Numbers in file order. `what` names the number for errors.
pub(super) struct Numbers<R> {
    scanner: Scanner<R>,
    encoding: Encoding,
    /// Announced length of the present record, and the bytes that were left at its beginning.
    record: Option<(u64, u64)>,
    /// A word such as `3*0.5` stands for several numbers: how many are left.
    repeated: (u64, String),
}

impl<R: BufRead> Numbers<R> {
    /// The numbers of an input of a known length.
    pub(super) fn new(input: R, length: u64, encoding: Encoding) -> Numbers<R> {
        let mut scanner = Scanner::new(input, length);
        scanner.binary = encoding != Encoding::Text;
        Numbers { scanner, encoding, record: None, repeated: (0, String::new()) }
    }

    /// A fault here.
    pub(super) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        self.scanner.flaw(fault)
    }

    /// Whether numbers are bytes.
    pub(super) fn is_bytes(&self) -> bool {
        self.encoding != Encoding::Text
    }

    /// Bytes not yet read.
    pub(super) fn rest(&self) -> u64 {
        self.scanner.rest()
    }

    /// Begins a Fortran record, where there are any.
    pub(super) fn begin_record(&mut self, what: &'static str) -> Result<(), Flaw> {
        if let Encoding::Bytes(layout @ Layout { records: true, .. }) = self.encoding {
            let length = u64::from(self.marker(layout, what)?);
            self.record = Some((length, self.rest()));
        }
        Ok(())
    }

    /// Ends a Fortran record, which must be as long as it said; `whole` false passes over what is left of it.
    pub(super) fn end_record(&mut self, what: &'static str, whole: bool) -> Result<(), Flaw> {
        let (Encoding::Bytes(layout), Some((length, before))) = (self.encoding, self.record.take()) else {
            return Ok(());
        };
        let found = before - self.rest();
        if found > length || (whole && found < length) {
            return Err(self.flaw(Fault::Miscounted { what: "bytes of a record", announced: length, found }));
        }
        if found < length {
            return Ok(()); // nothing behind it is read
        }
        let end = u64::from(self.marker(layout, what)?);
        if end != length {
            return Err(self.flaw(Fault::Miscounted { what: "bytes of a record", announced: length, found: end }));
        }
        Ok(())
    }

    fn marker(&mut self, layout: Layout, what: &'static str) -> Result<u32, Flaw> {
        let bytes = self.scanner.bytes(what)?;
        Ok(if layout.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }

    /// A whole number.
    pub(super) fn int(&mut self, what: &'static str) -> Result<i64, Flaw> {
        let Encoding::Bytes(layout) = self.encoding else { return self.word(what) };
        Ok(match (layout.long_ints, layout.big_endian) {
            (true, true) => i64::from_be_bytes(self.scanner.bytes(what)?),
            (true, false) => i64::from_le_bytes(self.scanner.bytes(what)?),
            (false, true) => i32::from_be_bytes(self.scanner.bytes(what)?).into(),
            (false, false) => i32::from_le_bytes(self.scanner.bytes(what)?).into(),
        })
    }

    /// A real number.
    pub(super) fn real(&mut self, what: &'static str) -> Result<f64, Flaw> {
        let Encoding::Bytes(layout) = self.encoding else { return self.word(what) };
        Ok(match (layout.short_reals, layout.big_endian) {
            (false, true) => f64::from_be_bytes(self.scanner.bytes(what)?),
            (false, false) => f64::from_le_bytes(self.scanner.bytes(what)?),
            (true, true) => f32::from_be_bytes(self.scanner.bytes(what)?).into(),
            (true, false) => f32::from_le_bytes(self.scanner.bytes(what)?).into(),
        })
    }

    /// A word as Fortran writes numbers: `1.5D-3`, or `3*0.5` for three of them.
    fn word<T: std::str::FromStr>(&mut self, what: &'static str) -> Result<T, Flaw> {
        if self.repeated.0 == 0 {
            let word = self.scanner.word(what)?;
            if let Ok(value) = word.parse() {
                return Ok(value);
            }
            let (count, text) = word.split_once('*').unwrap_or(("1", word));
            let text = text.replace(['D', 'd'], "E");
            self.repeated = (count.parse().unwrap_or(0), text);
        }
        match self.repeated.1.parse() {
            Ok(value) if self.repeated.0 > 0 => {
                self.repeated.0 -= 1;
                Ok(value)
            }
            _ => Err(self.flaw(Fault::Number { what, found: self.repeated.1.chars().take(40).collect() })),
        }
    }

    /// The whole numbers up to the end of the present record or of the file, `most` at most; whether these are all. In text what is
    /// no whole number ends them.
    pub(super) fn whole_rest(&mut self, most: usize, values: &mut Vec<i64>) -> Result<bool, Flaw> {
        let Encoding::Bytes(layout) = self.encoding else {
            while self.more()? {
                match self.scanner.word("a number")?.parse() {
                    Ok(value) if values.len() < most => values.push(value),
                    _ => return Ok(false),
                }
            }
            return Ok(true);
        };
        let end = match self.record {
            Some((length, before)) => length.saturating_sub(before - self.rest()).min(self.rest()),
            None => self.rest(),
        };
        let count = usize::try_from(end / layout.int_width()).unwrap_or(usize::MAX);
        for _ in 0..count.min(most) {
            values.push(self.int("a number")?);
        }
        Ok(count <= most && end.is_multiple_of(layout.int_width()))
    }

    /// Whether another word follows.
    pub(super) fn more(&mut self) -> Result<bool, Flaw> {
        Ok(self.repeated.0 > 0 || self.scanner.more()?)
    }

    /// A count of records of `ints` and `reals` numbers that the rest of the file can hold, so that it may be
    /// allocated for.
    pub(super) fn checked(&self, count: i64, what: &'static str, ints: u64, reals: u64) -> Result<usize, Flaw> {
        let least = match self.encoding {
            Encoding::Text => 2 * (ints + reals),
            Encoding::Bytes(layout) => layout.int_width() * ints + layout.real_width() * reals,
        };
        let rest = self.rest();
        let Ok(count) = u64::try_from(count) else {
            return Err(self.flaw(Fault::Number { what, found: count.to_string() }));
        };
        match usize::try_from(count) {
            // The last word of a text needs no space after it; a repeated word takes less room than its numbers.
            Ok(fits) if count <= (rest + 1) / least.max(1) => Ok(fits),
            _ => Err(self.flaw(Fault::Count { what, count, rest })),
        }
    }
}
