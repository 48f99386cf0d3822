//! Numbers to an MSH file, as text or as bytes.

use std::io::{self, Write};

/// Takes numbers in file order.
pub(super) trait Sink {
    /// Whether the numbers are written as bytes.
    const BINARY: bool;
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

impl<W: Write> Sink for TextSink<'_, W> {
    const BINARY: bool = false;
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

impl<W: Write> Sink for ByteSink<'_, W> {
    const BINARY: bool = true;
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
