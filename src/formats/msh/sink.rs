//! Numbers to an MSH file, as text or as bytes.

use std::io::{self, Write};
use std::ops::Range;

use rayon::prelude::*;

/// Rows that are in memory at a time, and rows that one task encodes.
const BATCH: usize = 1 << 14;
const TASK: usize = 1 << 10;

/// Takes numbers in file order.
pub(super) trait Sink: Send {
    /// Whether the numbers are written as bytes.
    const BINARY: bool;
    /// A sink into memory that encodes numbers in the same way.
    type Memory<'b>: Sink;
    /// That sink, at the start of a line.
    fn memory(bytes: &mut Vec<u8>) -> Self::Memory<'_>;
    /// Whole lines, encoded.
    fn encoded(&mut self, bytes: &[u8]) -> io::Result<()>;
    /// A C `int`.
    fn int(&mut self, value: i32) -> io::Result<()>;
    /// A C `size_t`.
    fn size(&mut self, value: u64) -> io::Result<()>;
    /// A C `double`; text gives the shortest form that reads back to the same value.
    fn real(&mut self, value: f64) -> io::Result<()>;
    /// Ends a line of text.
    fn end_line(&mut self) -> io::Result<()>;
    /// Characters as they are.
    fn text(&mut self, text: &str) -> io::Result<()>;

    /// A counted list of `int`s.
    fn ints(&mut self, values: &[i32]) -> io::Result<()> {
        self.size(values.len() as u64)?;
        values.iter().try_for_each(|&value| self.int(value))
    }

    /// Reals in a row.
    fn reals(&mut self, values: &[f64]) -> io::Result<()> {
        values.iter().try_for_each(|&value| self.real(value))
    }

    /// So many rows of whole lines: one batch is encoded, on all threads, while the one before is written.
    fn rows(
        &mut self,
        count: usize,
        row: impl Fn(&mut Self::Memory<'_>, usize) -> io::Result<()> + Sync,
    ) -> io::Result<()> {
        let encode = |rows: Range<usize>| -> io::Result<Vec<u8>> {
            let mut bytes = Vec::new();
            let mut sink = Self::memory(&mut bytes);
            rows.into_iter().try_for_each(|n| row(&mut sink, n))?;
            drop(sink);
            Ok(bytes)
        };
        if count <= TASK {
            return self.encoded(&encode(0..count)?); // a mesh from elsewhere has a block of nodes for every line of its grid
        }
        let mut ready: Vec<Vec<u8>> = Vec::new();
        for first in (0..count).step_by(BATCH) {
            let end = count.min(first + BATCH);
            let tasks = (first..end).into_par_iter().step_by(TASK).map(|begin| encode(begin..end.min(begin + TASK)));
            let write = || ready.iter().try_for_each(|bytes| self.encoded(bytes));
            let (written, next) = rayon::join(write, || tasks.collect::<io::Result<_>>());
            written?;
            ready = next?;
        }
        ready.iter().try_for_each(|bytes| self.encoded(bytes))
    }

    /// Opens a section.
    fn open(&mut self, section: &str) -> io::Result<()> {
        self.text(&format!("${section}\n"))
    }

    /// Closes a section.
    fn close(&mut self, section: &str) -> io::Result<()> {
        // Bytes need a line end before the marker; text has ended its last line.
        let before = if Self::BINARY { "\n" } else { "" };
        self.text(&format!("{before}$End{section}\n"))
    }
}

/// Numbers as words.
pub(super) struct TextSink<'a, W> {
    out: &'a mut W,
    within_line: bool,
}

impl<'a, W: Write> TextSink<'a, W> {
    pub(super) fn new(out: &'a mut W) -> TextSink<'a, W> {
        TextSink { out, within_line: false }
    }

    fn separate(&mut self) -> io::Result<()> {
        if self.within_line {
            self.out.write_all(b" ")?;
        }
        self.within_line = true;
        Ok(())
    }
}

impl<W: Write + Send> Sink for TextSink<'_, W> {
    const BINARY: bool = false;
    type Memory<'b> = TextSink<'b, Vec<u8>>;
    fn memory(bytes: &mut Vec<u8>) -> TextSink<'_, Vec<u8>> {
        TextSink::new(bytes)
    }
    fn encoded(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.out.write_all(bytes)
    }
    fn int(&mut self, value: i32) -> io::Result<()> {
        self.separate()?;
        write!(self.out, "{value}")
    }
    fn size(&mut self, value: u64) -> io::Result<()> {
        self.separate()?;
        write!(self.out, "{value}")
    }
    fn real(&mut self, value: f64) -> io::Result<()> {
        self.separate()?;
        // `Debug` turns to exponents where `Display` would write hundreds of zeros.
        write!(self.out, "{value:?}")
    }
    fn end_line(&mut self) -> io::Result<()> {
        self.within_line = false;
        self.out.write_all(b"\n")
    }
    fn text(&mut self, text: &str) -> io::Result<()> {
        self.out.write_all(text.as_bytes())
    }
}

/// Numbers as bytes, little-endian.
pub(super) struct ByteSink<'a, W>(pub(super) &'a mut W);

impl<W: Write + Send> Sink for ByteSink<'_, W> {
    const BINARY: bool = true;
    type Memory<'b> = ByteSink<'b, Vec<u8>>;
    fn memory(bytes: &mut Vec<u8>) -> ByteSink<'_, Vec<u8>> {
        ByteSink(bytes)
    }
    fn encoded(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }
    fn int(&mut self, value: i32) -> io::Result<()> {
        self.0.write_all(&value.to_le_bytes())
    }
    fn size(&mut self, value: u64) -> io::Result<()> {
        self.0.write_all(&value.to_le_bytes())
    }
    fn real(&mut self, value: f64) -> io::Result<()> {
        self.0.write_all(&value.to_le_bytes())
    }
    fn end_line(&mut self) -> io::Result<()> {
        Ok(())
    }
    fn text(&mut self, text: &str) -> io::Result<()> {
        self.0.write_all(text.as_bytes())
    }
}
