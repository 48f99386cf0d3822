//! The words, brackets and lists of OpenFOAM's files.

use super::fault::FoamFault;
use crate::formats::error::{Fault, Flaw, Place};

/// A file being read.
pub(super) struct Tokens<'a> {
    bytes: &'a [u8],
    at: usize,
    header: Header,
}

/// What a file says of itself.
#[derive(Clone, Debug)]
struct Header {
    class: String,
    is_binary: bool,
    /// Bytes of whole and real numbers.
    label: usize,
    scalar: usize,
}

impl<'a> Tokens<'a> {
    /// The content behind the header of a file of one of these classes.
    ///
    /// # Errors
    /// No header, or another class.
    pub(super) fn new(bytes: &'a [u8], classes: &[&'static str]) -> Result<Tokens<'a>, Flaw> {
        let header = Header { class: String::new(), is_binary: false, label: 4, scalar: 8 };
        let mut tokens = Tokens { bytes, at: 0, header };
        if tokens.word()? != "FoamFile" {
            return Err(tokens.flaw(FoamFault::Header));
        }
        tokens.expect("{")?;
        for (key, value) in tokens.entries()? {
            match key.as_str() {
                "class" => tokens.header.class = value,
                "format" => tokens.header.is_binary = value == "binary",
                "arch" => tokens.arch(&value)?,
                _ => {}
            }
        }
        if !classes.contains(&tokens.header.class.as_str()) {
            let (found, wanted) = (tokens.header.class.clone(), classes.first().copied().unwrap_or_default());
            return Err(tokens.flaw(FoamFault::Class { found, wanted }));
        }
        Ok(tokens)
    }

    /// `LSB;label=32;scalar=64`.
    fn arch(&mut self, text: &str) -> Result<(), Flaw> {
        for part in text.trim_matches('"').split(';') {
            let (key, value) = part.split_once('=').unwrap_or((part, ""));
            let width = |tokens: &Tokens, what| match value {
                "32" => Ok(4),
                "64" => Ok(8),
                _ => Err(tokens.flaw(FoamFault::Width { what, bits: value.to_owned() })),
            };
            match key.trim() {
                "MSB" => return Err(self.flaw(FoamFault::BigEndian)),
                "label" => self.header.label = width(self, "whole numbers")?,
                "scalar" => self.header.scalar = width(self, "coordinates")?,
                _ => {}
            }
        }
        Ok(())
    }

    /// A fault here: in text by line.
    pub(super) fn flaw(&self, fault: impl Into<Fault>) -> Flaw {
        let line = 1 + self.bytes[..self.at.min(self.bytes.len())].iter().filter(|&&byte| byte == b'\n').count();
        let place = if self.header.is_binary { Place::Byte(self.at as u64) } else { Place::Line(line as u64) };
        Flaw::new(place, fault)
    }

    /// Passes over white space and comments.
    fn skip(&mut self) {
        loop {
            let rest = &self.bytes[self.at..];
            let blank = rest.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            let rest = &rest[blank..];
            self.at += blank;
            let comment = if rest.starts_with(b"//") {
                rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len())
            } else if rest.starts_with(b"/*") {
                rest.windows(2).position(|pair| pair == b"*/").map_or(rest.len(), |end| end + 2)
            } else {
                return;
            };
            self.at += comment;
        }
    }

    /// The next word, or bracket or semicolon; in quotes up to the next one.
    fn word(&mut self) -> Result<String, Flaw> {
        self.skip();
        let rest = &self.bytes[self.at..];
        let is_mark = |byte: u8| matches!(byte, b'(' | b')' | b'{' | b'}' | b';');
        let length = match rest.first() {
            None => return Err(self.flaw(Fault::Truncated("the mesh"))),
            Some(b'"') => rest[1..].iter().position(|&byte| byte == b'"').map_or(rest.len(), |end| end + 2),
            Some(&byte) if is_mark(byte) => 1,
            Some(_) => rest.iter().take_while(|&&byte| !is_mark(byte) && !byte.is_ascii_whitespace()).count(),
        };
        self.at += length;
        Ok(crate::formats::names::text(&rest[..length]))
    }

    pub(super) fn expect(&mut self, what: &'static str) -> Result<(), Flaw> {
        let found = self.word()?;
        if found == what {
            return Ok(());
        }
        Err(self.flaw(Fault::Unexpected { what, found: found.chars().take(40).collect() }))
    }

    /// Keys and values up to the closing bracket; the values of lists and of dictionaries within are left out.
    pub(super) fn entries(&mut self) -> Result<Vec<(String, String)>, Flaw> {
        let mut entries = Vec::new();
        loop {
            let key = self.word()?;
            if key == "}" {
                return Ok(entries);
            }
            let (mut value, mut depth) = (String::new(), 0);
            loop {
                let word = self.word()?;
                match word.as_str() {
                    ";" if depth == 0 => break,
                    "(" | "{" => depth += 1,
                    ")" | "}" if depth == 0 => return Err(self.flaw(Fault::Unexpected { what: ";", found: word })),
                    ")" => depth -= 1,
                    "}" => {
                        depth -= 1;
                        if depth == 0 {
                            break;
                        }
                    }
                    _ if value.is_empty() => value = word,
                    _ => {}
                }
            }
            entries.push((key, value));
        }
    }

    /// A name, unless the list ends.
    pub(super) fn name(&mut self) -> Result<Option<String>, Flaw> {
        let word = self.word()?;
        Ok((word != ")").then_some(word))
    }

    fn number<T: std::str::FromStr>(&mut self, what: &'static str) -> Result<T, Flaw> {
        let word = self.word()?;
        word.parse().map_err(|_| self.flaw(Fault::Number { what, found: word.chars().take(40).collect() }))
    }

    /// The number of items of a list, each of which takes `least` bytes at least, and its opening bracket.
    pub(super) fn begin(&mut self, what: &'static str, least: usize) -> Result<usize, Flaw> {
        let count: u64 = self.number(what)?;
        let rest = (self.bytes.len() - self.at) as u64;
        let fits = usize::try_from(count).ok().filter(|_| count.saturating_mul(least as u64) <= rest);
        let count = fits.ok_or_else(|| self.flaw(Fault::Count { what, count, rest }))?;
        self.expect("(")?;
        Ok(count)
    }

    /// Bytes of a binary list.
    fn raw(&mut self, count: usize, width: usize) -> Result<&'a [u8], Flaw> {
        let end = count.checked_mul(width).and_then(|length| self.at.checked_add(length));
        let own =
            end.and_then(|end| self.bytes.get(self.at..end)).ok_or_else(|| self.flaw(Fault::Truncated("a list")))?;
        self.at += own.len();
        Ok(own)
    }

    /// A list of whole numbers.
    pub(super) fn whole(&mut self, what: &'static str) -> Result<Vec<i64>, Flaw> {
        let width = self.header.label;
        let count = self.begin(what, if self.header.is_binary { width } else { 2 })?;
        let values = if self.header.is_binary {
            let bytes = self.raw(count, width)?;
            let number = |own: &[u8]| match *own {
                [a, b, c, d] => i64::from(i32::from_le_bytes([a, b, c, d])),
                [a, b, c, d, e, f, g, h] => i64::from_le_bytes([a, b, c, d, e, f, g, h]),
                _ => 0,
            };
            bytes.chunks_exact(width).map(number).collect()
        } else {
            (0..count).map(|_| self.number(what)).collect::<Result<Vec<i64>, Flaw>>()?
        };
        self.expect(")")?;
        Ok(values)
    }

    /// A list of points.
    pub(super) fn points(&mut self) -> Result<Vec<glam::DVec3>, Flaw> {
        let (what, width) = ("points", self.header.scalar);
        let count = self.begin(what, if self.header.is_binary { 3 * width } else { 8 })?;
        let points = if self.header.is_binary {
            let bytes = self.raw(count, 3 * width)?;
            let real = |own: &[u8]| match *own {
                [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
                [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
                _ => 0.0,
            };
            let point =
                |own: &[u8]| glam::DVec3::from_array(std::array::from_fn(|axis| real(&own[axis * width..][..width])));
            bytes.chunks_exact(3 * width).map(point).collect()
        } else {
            let mut points = Vec::with_capacity(count);
            for _ in 0..count {
                self.expect("(")?;
                let [x, y, z] = [self.number(what)?, self.number(what)?, self.number(what)?];
                self.expect(")")?;
                points.push(glam::DVec3::new(x, y, z));
            }
            points
        };
        self.expect(")")?;
        Ok(points)
    }

    /// A list of faces: the corners of each.
    pub(super) fn faces(&mut self) -> Result<Vec<Vec<i64>>, Flaw> {
        if self.header.class == "faceCompactList" {
            // First corners of all faces and the end; corners.
            let (starts, corners) = (self.whole("faces")?, self.whole("corners of faces")?);
            let own = |pair: &[i64]| {
                let range = usize::try_from(pair[0]).ok().zip(usize::try_from(pair[1]).ok());
                range.and_then(|(first, end)| corners.get(first..end)).map(<[i64]>::to_vec)
            };
            let faces: Option<Vec<Vec<i64>>> = starts.windows(2).map(own).collect();
            return faces.ok_or_else(|| self.flaw(Fault::Truncated("the corners of faces")));
        }
        let count = self.begin("faces", 5)?;
        let faces = (0..count).map(|_| self.whole("corners of a face")).collect::<Result<_, Flaw>>()?;
        self.expect(")")?;
        Ok(faces)
    }
}
