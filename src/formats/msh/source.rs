//! Numbers from an MSH file, whether written as text or as bytes.

use std::io::BufRead;

use crate::formats::error::{Fault, Flaw};
use crate::formats::scanner::Scanner;

/// How many numbers of each kind one record holds at least.
#[derive(Clone, Copy, Default)]
pub(super) struct Record {
    pub(super) ints: u64,
    pub(super) sizes: u64,
    pub(super) reals: u64,
}

impl Record {
    pub(super) const INT: Record = Record { ints: 1, sizes: 0, reals: 0 };
    pub(super) const REAL: Record = Record { ints: 0, sizes: 0, reals: 1 };
}

/// Numbers in file order. `what` names the number for errors.
pub(super) trait Source {
    /// A C `int`.
    fn int(&mut self, what: &'static str) -> Result<i32, Flaw>;
    /// A C `size_t`.
    fn size(&mut self, what: &'static str) -> Result<u64, Flaw>;
    /// A C `double`.
    fn real(&mut self, what: &'static str) -> Result<f64, Flaw>;
    /// A fault at the present place.
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw;
    /// Bytes not yet read, and the least bytes that a record takes.
    fn room(&self, record: Record) -> (u64, u64);

    /// Goes to the beginning of a record that has a line of its own where numbers are words; what [`Source::end_row`] wants.
    fn begin_row(&mut self, what: &'static str) -> Result<u64, Flaw>;
    /// Refuses a record that was not the whole of its line.
    fn end_row(&mut self, begun: u64, what: &'static str) -> Result<(), Flaw>;

    /// Refuses a count of records that the rest of the file cannot hold, so that it may be allocated for.
    fn checked(&self, count: u64, what: &'static str, record: Record) -> Result<usize, Flaw> {
        let (rest, least) = self.room(record);
        match usize::try_from(count) {
            // The last word of a text needs no space after it.
            Ok(fits) if count <= (rest + 1) / least.max(1) => Ok(fits),
            _ => Err(self.flaw(Fault::Count { what, count, rest })),
        }
    }

    /// A count of records that the rest of the file can hold.
    fn count(&mut self, what: &'static str, record: Record) -> Result<usize, Flaw> {
        let count = self.size(what)?;
        self.checked(count, what, record)
    }

    /// `N` reals.
    fn reals<const N: usize>(&mut self, what: &'static str) -> Result<[f64; N], Flaw> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.real(what)?;
        }
        Ok(values)
    }

    /// A counted list of `int`s.
    fn ints(&mut self, what: &'static str) -> Result<Vec<i32>, Flaw> {
        let count = self.count(what, Record::INT)?;
        (0..count).map(|_| self.int(what)).collect()
    }
}

/// Numbers written as words.
pub(super) struct Text<'a, R>(pub(super) &'a mut Scanner<R>);

impl<R: BufRead> Source for Text<'_, R> {
    fn int(&mut self, what: &'static str) -> Result<i32, Flaw> {
        self.0.number(what)
    }
    fn size(&mut self, what: &'static str) -> Result<u64, Flaw> {
        self.0.number(what)
    }
    fn real(&mut self, what: &'static str) -> Result<f64, Flaw> {
        self.0.number(what)
    }
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        self.0.flaw(fault)
    }
    fn begin_row(&mut self, what: &'static str) -> Result<u64, Flaw> {
        self.0.begin_row(what)
    }
    fn end_row(&mut self, begun: u64, what: &'static str) -> Result<(), Flaw> {
        self.0.end_row(begun, what)
    }
    fn room(&self, record: Record) -> (u64, u64) {
        (self.0.rest(), 2 * (record.ints + record.sizes + record.reals))
    }
}

/// Numbers written as bytes; `swap` where the other byte order was used than little-endian.
pub(super) struct Bytes<'a, R> {
    pub(super) scanner: &'a mut Scanner<R>,
    pub(super) swap: bool,
}

impl<R: BufRead> Bytes<'_, R> {
    fn take<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], Flaw> {
        let mut bytes = self.scanner.bytes::<N>(what)?;
        if self.swap {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl<R: BufRead> Source for Bytes<'_, R> {
    fn int(&mut self, what: &'static str) -> Result<i32, Flaw> {
        self.take(what).map(i32::from_le_bytes)
    }
    fn size(&mut self, what: &'static str) -> Result<u64, Flaw> {
        self.take(what).map(u64::from_le_bytes)
    }
    fn real(&mut self, what: &'static str) -> Result<f64, Flaw> {
        self.take(what).map(f64::from_le_bytes)
    }
    fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        self.scanner.flaw(fault)
    }
    fn begin_row(&mut self, _: &'static str) -> Result<u64, Flaw> {
        Ok(0)
    }
    fn end_row(&mut self, _: u64, _: &'static str) -> Result<(), Flaw> {
        Ok(())
    }
    fn room(&self, record: Record) -> (u64, u64) {
        (self.scanner.rest(), 4 * record.ints + 8 * (record.sizes + record.reals))
    }
}
