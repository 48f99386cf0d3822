//! Compressed arrays: blocks behind a header that tells their sizes.

use std::io::{Cursor, Read, Write};

use super::fault::VtkFault;
use crate::formats::error::Fault;

/// Which compressor a file names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compressor {
    Zlib,
    Lz4,
    Lzma,
}

impl Compressor {
    /// The compressor of a class of VTK's.
    pub(super) fn of(name: &str) -> Option<Compressor> {
        Some(match name {
            "vtkZLibDataCompressor" => Compressor::Zlib,
            "vtkLZ4DataCompressor" => Compressor::Lz4,
            "vtkLZMADataCompressor" => Compressor::Lzma,
            _ => return None,
        })
    }

    /// Appends the content of a block, which is `size` bytes long.
    pub(super) fn expand(self, block: &[u8], size: u64, content: &mut Vec<u8>) -> Result<(), Fault> {
        let damaged = |cause: String| VtkFault::Compressed(cause);
        let before = content.len();
        match self {
            Compressor::Zlib => {
                let decoder = flate2::read::ZlibDecoder::new(block);
                decoder.take(size + 1).read_to_end(content).map_err(|e| damaged(e.to_string()))?;
            }
            Compressor::Lz4 => {
                // No block expands to more than 255 times itself.
                let most = (block.len() as u64).saturating_mul(255).saturating_add(64);
                let size = usize::try_from(size.min(most)).unwrap_or(usize::MAX);
                let expanded = lz4_flex::block::decompress(block, size).map_err(|e| damaged(e.to_string()))?;
                content.extend_from_slice(&expanded);
            }
            Compressor::Lzma => {
                let mut out = Bounded { content, left: size };
                lzma_rs::xz_decompress(&mut Cursor::new(block), &mut out).map_err(|e| damaged(format!("{e:?}")))?;
            }
        }
        let found = (content.len() - before) as u64;
        if found == size { Ok(()) } else { Err(Fault::Miscounted { what: "bytes of a block", announced: size, found }) }
    }
}

/// Takes no more than it should.
struct Bounded<'a> {
    content: &'a mut Vec<u8>,
    left: u64,
}

impl Write for Bounded<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if bytes.len() as u64 > self.left {
            return Err(std::io::Error::other("more than its header says"));
        }
        self.left -= bytes.len() as u64;
        self.content.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}
