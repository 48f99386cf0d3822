//! CGNS files in the old ADF form: rewritten as HDF5 by the program `adf2hdf`, where it is installed.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use cad::child::{ChildError, Limits, run};
use tempfile::TempDir;

use crate::formats::error::Error;

/// The program that rewrites them, of CGNS' own tools.
const PROGRAM: &str = "adf2hdf";

/// Seconds that it may take, beside one for every ten megabytes.
const SECONDS: u64 = 60;

/// Bytes that it may print.
const OUTPUT: u64 = 1 << 20;

/// Whether a file begins as one in the ADF form.
pub(super) fn is(head: &[u8]) -> bool {
    head.get(4..).is_some_and(|rest| rest.starts_with(b"ADF Database Version"))
}

/// The file as HDF5, which is removed when this is dropped.
pub(super) struct Rewritten {
    _folder: TempDir,
    output: PathBuf,
}

impl Rewritten {
    pub(super) fn path(&self) -> &Path {
        &self.output
    }
}

/// The file of `length` bytes as HDF5, under a temporary name; the program may take `memory` bytes.
///
/// # Errors
/// [`Error::Format`] where the program is missing or fails; [`Error::Io`].
pub(super) fn rewritten(path: &Path, length: u64, memory: u64) -> Result<Rewritten, Error> {
    let refused = |cause: &str| {
        let reason = format!(
            "a CGNS file in the old ADF form, and {cause}; rewrite it as HDF5: {PROGRAM} IN.cgns OUT.cgns (Debian package \
             cgns-convert)"
        );
        Error::Format { file: path.to_path_buf(), reason }
    };
    let failed = |source| Error::Io { file: path.to_path_buf(), action: "rewrite", source };
    // The program is a script that takes names with spaces for several: it gets names of our own.
    let folder = tempfile::tempdir().map_err(failed)?;
    let (link, output) = (folder.path().join("adf.cgns"), folder.path().join("hdf5.cgns"));
    std::os::unix::fs::symlink(std::path::absolute(path).map_err(failed)?, &link).map_err(failed)?;
    let input = link.to_str().ok_or_else(|| refused("the folder of temporary files has no name in UTF-8"))?;
    let limits = Limits { timeout: Duration::from_secs(SECONDS + length / 10_000_000), memory, output: OUTPUT };
    match run(Path::new(PROGRAM), input, &output, &[], limits) {
        Ok(outcome) if outcome.status.success() && output.is_file() => Ok(Rewritten { _folder: folder, output }),
        Ok(_) | Err(ChildError::TooMuch) => Err(refused(&format!("{PROGRAM} cannot read it"))),
        Err(ChildError::TimedOut { .. }) => Err(refused(&format!("{PROGRAM} takes too long"))),
        Err(ChildError::Run(source)) if source.kind() == io::ErrorKind::NotFound => {
            Err(refused(&format!("{PROGRAM}, which rewrites it, is not installed")))
        }
        Err(ChildError::Run(source)) => Err(failed(source)),
    }
}
