//! Checkpoint files: a state of the smoothing, and of what work it is.
//!
//! ```text
//! "sagitta checkpoint 5\n"                 21 bytes
//! fingerprint of the work                  u64, little-endian
//! volume elements, nodes                   2 x u64
//! state                                    smooth::Checkpoint
//! CRC-32 of all of the above               u32
//! ```

use std::fs::File;
use std::hash::Hasher;
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use flate2::{Crc, CrcReader, CrcWriter};
use rustc_hash::FxHasher;

use super::level::Level;
use crate::formats;
use crate::smooth::Checkpoint;

const MAGIC: &[u8; 21] = b"sagitta checkpoint 5\n";

/// What a checkpoint belongs to: the same mesh, CAD and settings give the same number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Work {
    fingerprint: u64,
    elements: usize,
    nodes: usize,
}

/// Why a checkpoint file is not gone on from.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// Not readable.
    #[error("{file}: cannot be read: {source}", file = file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Something else, or of another version.
    #[error("{file}: is not a checkpoint of this version of sagitta", file = file.display())]
    Foreign {
        /// The file.
        file: PathBuf,
    },
    /// Cut off or changed.
    #[error("{file}: is damaged (cut off, or its checksum is wrong); start without --resume", file = file.display())]
    Damaged {
        /// The file.
        file: PathBuf,
    },
    /// Of another mesh, CAD, order or other settings.
    #[error(
        "{file}: belongs to another run: give the mesh, the CAD, the linkage and the options it was made with (--max-sweeps, \
         --time-limit and --threads may differ)",
        file = file.display()
    )]
    OtherWork {
        /// The file.
        file: PathBuf,
    },
}

impl Work {
    /// The work of smoothing a level.
    pub(super) fn of(level: &Level) -> Work {
        let (straight, settings) = (level.straight(), level.case.settings.fingerprint());
        let mut hasher = FxHasher::default();
        hasher.write(env!("CARGO_PKG_VERSION").as_bytes());
        hasher.write(settings.as_bytes());
        let boundary = (0..level.wall.len()).map(|n| level.wall.displacement(n));
        for x in straight.iter().copied().chain(boundary).flat_map(|x| x.to_array()) {
            hasher.write_u64(x.to_bits());
        }
        Work { fingerprint: hasher.finish(), elements: level.mesh().cells().len(), nodes: straight.len() }
    }
}

/// Writes a checkpoint; the file appears under its name only when it is complete.
///
/// # Errors
/// [`formats::Error::Io`].
pub fn write(path: &Path, work: &Work, checkpoint: &Checkpoint) -> Result<(), formats::Error> {
    formats::write_file(path, |out| {
        let mut sum = CrcWriter::new(out);
        sum.write_all(MAGIC)?;
        for number in [work.fingerprint, work.elements as u64, work.nodes as u64] {
            sum.write_all(&number.to_le_bytes())?;
        }
        checkpoint.write(&mut sum)?;
        let crc = sum.crc().sum();
        sum.into_inner().write_all(&crc.to_le_bytes())
    })
}

/// A checkpoint file of which the head was read.
pub struct Found {
    file: PathBuf,
    input: CrcReader<BufReader<File>>,
    head: [u64; 3],
}

impl Found {
    /// Opens a checkpoint file.
    ///
    /// # Errors
    /// [`CheckpointError`].
    pub fn open(path: &Path) -> Result<Found, CheckpointError> {
        let failed = |source| failed(path, source);
        let mut input = CrcReader::new(BufReader::new(cad::regular::open(path).map_err(failed)?));
        let mut magic = Vec::new();
        input.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(failed)?;
        if magic != MAGIC {
            return Err(CheckpointError::Foreign { file: path.to_owned() });
        }
        let mut head = [0; 3];
        for number in &mut head {
            let mut bytes = [0; 8];
            input.read_exact(&mut bytes).map_err(failed)?;
            *number = u64::from_le_bytes(bytes);
        }
        Ok(Found { file: path.to_owned(), input, head })
    }

    /// Nodes of the mesh that it belongs to: they tell its order.
    #[must_use]
    pub fn nodes(&self) -> usize {
        usize::try_from(self.head[2]).unwrap_or(usize::MAX)
    }

    /// Reads the rest, if it belongs to `work`.
    ///
    /// # Errors
    /// [`CheckpointError`].
    pub fn read(self, work: &Work) -> Result<Checkpoint<'static>, CheckpointError> {
        let Found { file, mut input, head } = self;
        if head != [work.fingerprint, work.elements as u64, work.nodes as u64] {
            return Err(CheckpointError::OtherWork { file });
        }
        let failed = |source| failed(&file, source);
        let checkpoint = Checkpoint::read(&mut input, work.elements, work.nodes).map_err(failed)?;
        let found = Crc::sum(input.crc());
        let mut stored = [0; 4];
        input.read_exact(&mut stored).map_err(failed)?;
        let more = input.read(&mut [0]).map_err(failed)?;
        if u32::from_le_bytes(stored) != found || more > 0 {
            return Err(CheckpointError::Damaged { file });
        }
        Ok(checkpoint)
    }
}

fn failed(path: &Path, source: io::Error) -> CheckpointError {
    match source.kind() {
        io::ErrorKind::UnexpectedEof | io::ErrorKind::InvalidData => CheckpointError::Damaged { file: path.to_owned() },
        _ => CheckpointError::Io { file: path.to_owned(), source },
    }
}
