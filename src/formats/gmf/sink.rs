//! Numbers to a GMF file, as text or as bytes.

use std::io::{self, Write};

use super::header::MARK;
use super::keyword::Keyword;

/// Takes keywords and numbers in file order.
pub(super) struct Sink<'a, W> {
    out: &'a mut W,
    form: Form,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Text,
    /// Little-endian, of a version from 2 to 4.
    Bytes {
        version: u32,
    },
}

impl Form {
    /// Bytes of a whole number.
    pub(super) fn int_width(self) -> u64 {
        if self == (Form::Bytes { version: 4 }) { 8 } else { 4 }
    }

    /// Bytes of a keyword's number and the position of the next.
    pub(super) fn head(self) -> u64 {
        match self {
            Form::Bytes { version: 3.. } => 12,
            _ => 8,
        }
    }
}

impl<'a, W: Write> Sink<'a, W> {
    pub(super) fn new(out: &'a mut W, form: Form) -> Sink<'a, W> {
        Sink { out, form }
    }

    /// The version, in which texts are of double precision too, and the dimension.
    pub(super) fn begin(&mut self, dimension: u32) -> io::Result<()> {
        match self.form {
            Form::Text => write!(self.out, "MeshVersionFormatted 2\n\nDimension {dimension}\n"),
            Form::Bytes { version } => {
                self.out.write_all(&MARK.to_le_bytes())?;
                self.out.write_all(&version.to_le_bytes())?;
                self.head(Keyword::Dimension, 8 + self.form.head() + 4)?;
                self.out.write_all(&dimension.to_le_bytes())
            }
        }
    }

    /// A keyword with a count, whose content ends at the byte `next`.
    pub(super) fn keyword(&mut self, keyword: Keyword, count: u64, next: u64) -> io::Result<()> {
        match self.form {
            Form::Text => write!(self.out, "\n{}\n{count}\n", keyword.names().1),
            Form::Bytes { .. } => {
                self.head(keyword, next)?;
                self.int(count as i64)
            }
        }
    }

    /// The end of the file.
    pub(super) fn end(&mut self) -> io::Result<()> {
        match self.form {
            Form::Text => self.out.write_all(b"\nEnd\n"),
            Form::Bytes { .. } => self.head(Keyword::End, 0),
        }
    }

    fn head(&mut self, keyword: Keyword, next: u64) -> io::Result<()> {
        self.out.write_all(&keyword.names().0.to_le_bytes())?;
        match self.form {
            Form::Bytes { version: 3.. } => self.out.write_all(&next.to_le_bytes()),
            _ => self.out.write_all(&(next as u32).to_le_bytes()),
        }
    }

    /// A whole number that fits the version.
    pub(super) fn int(&mut self, value: i64) -> io::Result<()> {
        match self.form {
            Form::Text => write!(self.out, "{value} "),
            Form::Bytes { version: 4 } => self.out.write_all(&value.to_le_bytes()),
            Form::Bytes { .. } => self.out.write_all(&(value as i32).to_le_bytes()),
        }
    }

    /// A real number; text gives the shortest form that reads back to the same value.
    pub(super) fn real(&mut self, value: f64) -> io::Result<()> {
        match self.form {
            Form::Text => write!(self.out, "{value:?} "),
            Form::Bytes { .. } => self.out.write_all(&value.to_le_bytes()),
        }
    }

    /// Ends a row.
    pub(super) fn end_row(&mut self) -> io::Result<()> {
        match self.form {
            Form::Text => self.out.write_all(b"\n"),
            Form::Bytes { .. } => Ok(()),
        }
    }
}
