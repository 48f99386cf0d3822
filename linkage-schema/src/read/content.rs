//! Contents: lists of ids, of indices in text and base64, numbers. Nothing is ever allocated by a promised count.

use std::io::BufRead;
use std::num::NonZeroU32;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::{positive, shorten};
use crate::cursor::Cursor;
use crate::id::Id;
use crate::{Code, Encoding, Findings, Origin, Parameters, ReadError};

/// Base64 is decoded in pieces of this many characters; a multiple of 16, which make three integers.
const PIECE: usize = 16 * 1024;

/// What the attributes of a run say about its content.
pub(super) struct Shape {
    /// `MeshFace`, ...: for messages.
    pub(super) element: &'static str,
    /// Items, 1 where the file does not say; `None` where it says nonsense.
    pub(super) count: Option<u64>,
    /// Indices in an item.
    pub(super) width: usize,
    pub(super) encoding: Encoding,
    pub(super) origin: Origin,
}

impl<R: BufRead> Cursor<R> {
    /// The collected content as text.
    pub(super) fn string(&self) -> String {
        String::from_utf8_lossy(&self.text).into_owned()
    }

    /// The content of the current element as ids; leaves the element.
    pub(super) fn id_list<I: Id>(&mut self, element: &'static str) -> Result<Vec<I>, ReadError> {
        self.content()?;
        let (mut ids, mut bad) = (Vec::new(), Vec::new());
        for (offset, word) in words(&self.text) {
            match std::str::from_utf8(word).ok().and_then(positive).and_then(|n| u32::try_from(n).ok()) {
                Some(number) => ids.extend(NonZeroU32::new(number).map(I::from_number)),
                None => bad.push((offset, word.len())),
            }
        }
        bad.iter().for_each(|&(offset, length)| self.bad_index(offset, length, element));
        Ok(ids)
    }

    fn bad_index(&mut self, offset: usize, length: usize, element: &str) {
        // The place is found by counting lines, so only for findings that will be kept.
        let before = if self.findings.count(Code::BadIndex) < Findings::KEPT { self.text.get(..offset) } else { None };
        let word = self.text.get(offset..offset + length).unwrap_or_default();
        let at = self.text_at.after(before.unwrap_or_default());
        self.findings
            .push(Code::BadIndex, at.into(), || format!("{:?} in {element}", shorten(&String::from_utf8_lossy(word))));
    }

    /// The collected content as indices, as many as the count says; nothing where they cannot be trusted.
    pub(super) fn indices(&mut self, shape: &Shape) -> Box<[u32]> {
        let indices = match shape.encoding {
            Encoding::Text => self.text_indices(shape),
            Encoding::Base64 => self.base64_indices(shape),
        };
        indices.map(|indices| self.counted(indices, shape)).unwrap_or_default().into_boxed_slice()
    }

    fn text_indices(&mut self, shape: &Shape) -> Option<Vec<u32>> {
        let mut indices = Vec::new();
        let mut bad = Vec::new();
        let mut trusted = true;
        for (offset, word) in words(&self.text) {
            match index(word) {
                Some(number) => {
                    // A zero is no point, but with the other indices it tells that the file counts from 0.
                    if number == 0 {
                        bad.push((offset, word.len()));
                    }
                    indices.push(number);
                }
                None => {
                    trusted = false;
                    bad.push((offset, word.len()));
                }
            }
        }
        bad.iter().for_each(|&(offset, length)| self.bad_index(offset, length, shape.element));
        trusted.then_some(indices)
    }

    fn base64_indices(&mut self, shape: &Shape) -> Option<Vec<u32>> {
        let element = shape.element;
        let mut text = std::mem::take(&mut self.text);
        text.retain(|byte| !byte.is_ascii_whitespace());
        let decoded = decode(&text);
        self.text = text;
        let integers = match decoded {
            Ok(integers) => integers,
            Err(cause) => {
                self.findings.push(Code::BadBase64, shape.origin, || format!("content of {element}: {cause}"));
                return None;
            }
        };
        match integers.iter().position(|&n| n == 0 || i32::try_from(n).is_err()) {
            None => Some(integers),
            Some(place) => {
                let number = integers.get(place).map_or(0, |n| n.cast_signed());
                self.findings.push(Code::BadIndex, shape.origin, || {
                    format!("{number} as integer {} of the base64 content of {element}", place + 1)
                });
                let zeros_only = integers.iter().all(|&n| i32::try_from(n).is_ok());
                zeros_only.then_some(integers)
            }
        }
    }

    /// Compares with the count; what is beyond is cut off, what is missing is an error.
    fn counted(&mut self, mut indices: Vec<u32>, shape: &Shape) -> Vec<u32> {
        let width = shape.width.max(1);
        let Some(kept) = self.check_count(indices.len(), width, shape) else { return Vec::new() };
        indices.truncate(kept * width);
        indices
    }

    /// How many items of `width` words to keep of `found` words.
    pub(super) fn check_count(&mut self, found: usize, width: usize, shape: &Shape) -> Option<usize> {
        let (element, count) = (shape.element, shape.count?);
        let wanted = count.saturating_mul(width as u64);
        if wanted > found as u64 {
            self.findings.push(Code::CountTooLarge, shape.origin, || {
                format!("{element} announces {count} x {width} indices and has {found}")
            });
            return None;
        }
        if wanted < found as u64 {
            self.findings.push(Code::ExtraContent, shape.origin, || {
                format!("{element} announces {count} x {width} indices and has {found}")
            });
        }
        usize::try_from(count).ok()
    }

    /// The collected content as parameters.
    pub(super) fn parameters(&mut self, dimension: u64, origin: Origin) -> Option<Parameters> {
        if !(1..=2).contains(&dimension) {
            self.findings.push(Code::BadDimension, origin, || format!("ParamVertex has dim {dimension}"));
            return None;
        }
        let text = std::str::from_utf8(&self.text).unwrap_or_default();
        let mut numbers = text.split_ascii_whitespace().map(|word| word.parse::<f64>().ok().filter(|x| x.is_finite()));
        let (first, second) = (numbers.next().flatten(), numbers.next().flatten());
        let parameters = match (dimension, first, second) {
            (1, Some(t), _) => Some(Parameters::Curve(t)),
            (2, Some(u), Some(v)) => Some(Parameters::Surface(u, v)),
            _ => None,
        };
        let words = text.split_ascii_whitespace().count() as u64;
        if parameters.is_none() {
            self.findings.push(Code::BadNumber, origin, || {
                format!("ParamVertex of dim {dimension} holds {:?}", shorten(text.trim()))
            });
        } else if words > dimension {
            self.findings
                .push(Code::ExtraContent, origin, || format!("ParamVertex of dim {dimension} holds {words} numbers"));
        }
        parameters
    }
}

/// The words of a text between blanks, with their offsets.
fn words(text: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = text.get(at..)?;
        let begin = at + rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let word = text.get(begin..)?;
        let length = word.iter().position(u8::is_ascii_whitespace).unwrap_or(word.len());
        at = begin + length;
        Some((begin, word.get(..length)?))
    })
}

/// A point index: decimal; 0 is for the caller to refuse.
fn index(word: &[u8]) -> Option<u32> {
    let mut number = 0_u64;
    for &byte in word {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        number = number * 10 + u64::from(digit);
        if number > u64::from(u32::MAX) {
            return None;
        }
    }
    u32::try_from(number).ok()
}

/// Base64 without blanks to little-endian integers.
fn decode(text: &[u8]) -> Result<Vec<u32>, String> {
    let mut integers = Vec::new();
    let mut bytes = [0_u8; PIECE / 4 * 3];
    for (number, piece) in text.chunks(PIECE).enumerate() {
        let length = STANDARD
            .decode_slice(piece, &mut bytes)
            .map_err(|error| format!("{error} (piece of {PIECE} characters number {})", number + 1))?;
        let (whole, rest) = bytes.get(..length).unwrap_or_default().as_chunks::<4>();
        if !rest.is_empty() {
            return Err(format!("{} bytes beyond the last whole integer", rest.len()));
        }
        integers.extend(whole.iter().map(|word| u32::from_le_bytes(*word)));
    }
    Ok(integers)
}
