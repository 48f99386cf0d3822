//! Files that are what they seem: neither pipes, which make their reader wait, nor devices, which have no end.

use std::fs::{File, OpenOptions};
use std::io;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

/// Opens a regular file for reading; links are followed. A pipe without a writer is not waited for.
///
/// # Errors
/// Those of the system, and where the path leads to something else than a regular file.
pub fn open(path: &Path) -> io::Result<File> {
    let nonblock = rustix::fs::OFlags::NONBLOCK.bits().cast_signed();
    // A device is not even opened: that may move a tape.
    let is_file = |metadata: std::fs::Metadata| match (metadata.is_file(), metadata.is_dir()) {
        (true, _) => Ok(()),
        (_, true) => Err(io::Error::other("it is a directory, not a regular file")),
        _ => Err(io::Error::other("it is not a regular file; save it as one first")),
    };
    is_file(std::fs::metadata(path)?)?;
    let file = OpenOptions::new().read(true).custom_flags(nonblock).open(path)?;
    is_file(file.metadata()?)?; // another one may have taken its place
    Ok(file)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::open;
    use std::os::unix::net::UnixListener;
    use std::path::Path;

    #[test]
    fn only_regular_files_are_opened() {
        let dir = tempfile::tempdir().unwrap();
        let (file, link, socket) = (dir.path().join("file"), dir.path().join("link"), dir.path().join("socket"));
        std::fs::write(&file, "content").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let _listener = UnixListener::bind(&socket).unwrap();
        assert_eq!(std::io::read_to_string(open(&link).unwrap()).unwrap(), "content");
        for other in [dir.path(), &socket, Path::new("/dev/zero"), Path::new("/dev/null")] {
            assert!(open(other).unwrap_err().to_string().contains("not a regular file"), "{}", other.display());
        }
    }
}
