//! Bytes of VTU arrays: as they are, or in base64.

use std::borrow::Cow;

use base64::Engine;
use base64::engine::{GeneralPurpose, GeneralPurposeConfig};

use super::fault::VtkFault;
use crate::formats::error::Fault;

/// Bytes as they are or in base64, from the front.
pub(super) struct Source<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) raw: bool,
}

impl<'a> Source<'a> {
    /// The next bytes, which stay.
    pub(super) fn peek(&self, count: usize) -> Result<Vec<u8>, Fault> {
        Ok(Source { ..*self }.take(count)?.into_owned())
    }

    /// The next bytes; in base64 a group of their own, padded to whole quadruples.
    pub(super) fn take(&mut self, count: usize) -> Result<Cow<'a, [u8]>, Fault> {
        let cut = || Fault::Truncated("an array");
        if self.raw {
            return Ok(self.bytes.split_off(..count).ok_or_else(cut)?.into());
        }
        let length = count.div_ceil(3).checked_mul(4).ok_or_else(cut)?;
        let quads = self.bytes.split_off(..length).ok_or_else(cut)?;
        let mut bytes = decode(quads)?;
        if bytes.len() < count {
            return Err(cut());
        }
        bytes.truncate(count);
        Ok(bytes.into())
    }

    /// The bytes behind a header that counts them.
    pub(super) fn counted(&mut self, width: usize, number: impl Fn(&[u8]) -> u64) -> Result<Cow<'a, [u8]>, Fault> {
        let cut = || Fault::Truncated("an array");
        let count = number(&self.peek(width)?);
        let count = usize::try_from(count).map_err(|_| cut())?;
        let whole = self.take(count.checked_add(width).ok_or_else(cut)?)?;
        Ok(match whole {
            Cow::Borrowed(bytes) => bytes[width..].into(),
            Cow::Owned(mut bytes) => bytes.split_off(width).into(),
        })
    }
}

/// Base64 of which only the beginning may be asked for: what stands behind the padding is not looked at.
fn decode(quads: &[u8]) -> Result<Vec<u8>, Fault> {
    let end = quads.chunks_exact(4).position(|quad| quad[3] == b'=').map_or(quads.len(), |n| 4 * n + 4);
    let damaged = |error: base64::DecodeError| VtkFault::Compressed(error.to_string());
    let bits = GeneralPurposeConfig::new().with_decode_allow_trailing_bits(true);
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, bits);
    Ok(engine.decode(&quads[..end]).map_err(damaged)?)
}
