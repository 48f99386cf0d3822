//! A file that appears under its name only when it is complete.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use rustix::process::{Resource, getrlimit};

use super::Error;
use super::part::{Part, Unwritten};
use super::target::{Target, folder};

/// Writes a file under a temporary name in its target's folder, and gives it its name when all went well and is on disk.
///
/// Nothing is left behind on failure, and a file that had the name stays as it was. A file that is replaced hands its mode on. A
/// link stays a link: the file that it leads to is replaced. What killed runs left of the same file is removed.
///
/// # Errors
/// [`Error::Io`], also where the name belongs to something that is not a file, or to a read-only one; whatever `content` returns.
pub(super) fn write(path: &Path, content: impl FnOnce(&mut Part) -> Result<(), Unwritten>) -> Result<(), Error> {
    let failed = |action| move |source| Error::Io { file: path.to_path_buf(), action, source };
    let target = Target::of(path).map_err(failed("write"))?;
    let mut part = Part::create(path, &target).map_err(failed("create"))?;
    content(&mut part).map_err(|unwritten| match unwritten {
        Unwritten::Io(source) => failed("write")(source),
        Unwritten::Inexpressible(reason) => Error::Inexpressible { file: path.to_path_buf(), reason },
    })?;
    part.complete(&target).map_err(failed("write"))
}

/// Writes a file that is no mesh: it appears under its name only when it is complete and on disk, and what killed runs left of it is
/// removed. A file that it replaces hands its mode on.
///
/// # Errors
/// [`Error::Io`].
pub fn write_file(path: &Path, content: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>) -> Result<(), Error> {
    write(path, |part| part.stream(|out| Ok(content(out)?)))
}

/// As [`write_file`], for content that is there.
///
/// # Errors
/// [`Error::Io`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_file(path, |out| io::Write::write_all(out, bytes))
}

/// Whether a file of about `expected` bytes can be written under this name: to be asked before long work. It is tried: the name, what
/// stands there, the folder, and the room left on the disk and by the user's limits.
///
/// # Errors
/// [`Error::Io`].
pub fn check_file(path: &Path, expected: u64) -> Result<(), Error> {
    let failed = |action| move |source| Error::Io { file: path.to_path_buf(), action, source };
    let target = Target::of(path).map_err(failed("write"))?;
    Part::create(path, &target).map_err(failed("create"))?;
    let (free, whose) = room(folder(&target.path));
    if free < expected {
        let [expected, free] = [expected, free].map(|bytes| bytes.div_ceil(1 << 10));
        let told = format!("it will have about {expected} kB or more, and {whose} leaves {free} kB");
        return Err(failed("write")(io::Error::new(io::ErrorKind::StorageFull, told)));
    }
    Ok(())
}

/// Bytes that a file in a folder may have, and what says so.
fn room(folder: &Path) -> (u64, &'static str) {
    let limit = getrlimit(Resource::Fsize).current.unwrap_or(u64::MAX);
    // Some file systems tell nothing.
    let disk = rustix::fs::statvfs(folder).ok().filter(|disk| disk.f_blocks > 0);
    let free = disk.map_or(u64::MAX, |disk| disk.f_bavail.saturating_mul(disk.f_frsize));
    if limit < free { (limit, "the limit of file sizes (ulimit -f)") } else { (free, "the disk") }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::fs::{self, File, Permissions};
    use std::io::Write;
    use std::os::unix::fs::{PermissionsExt, symlink};

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mesh.msh");
        fs::write(&path, "old").unwrap();
        let failed = write(&path, |part| {
            part.stream(|out| Ok(out.write_all(b"half")?))?;
            Err(Unwritten::Inexpressible("because".into()))
        });
        assert!(failed.is_err_and(|e| e.to_string().ends_with("mesh.msh: cannot be written: because")));
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
        write(&path, |part| part.stream(|out| Ok(out.write_all(b"new")?))).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_is_no_file_is_not_replaced() {
        let dir = tempfile::tempdir().unwrap();
        assert!(write(dir.path(), |_| Ok(())).is_err());
        assert!(write(&dir.path().join("none/mesh.msh"), |_| Ok(())).is_err());
    }

    #[test]
    fn a_replaced_file_hands_its_mode_on_and_a_new_one_has_the_users() {
        let dir = tempfile::tempdir().unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        let (plain, path) = (dir.path().join("plain"), dir.path().join("mesh.msh"));
        File::create(&plain).unwrap();
        write(&path, |_| Ok(())).unwrap();
        assert_eq!(mode(&path), mode(&plain));
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        write(&path, |_| Ok(())).unwrap();
        assert_eq!(mode(&path), 0o640);
    }

    #[test]
    fn a_link_stays_a_link() {
        let dir = tempfile::tempdir().unwrap();
        let (path, link) = (dir.path().join("mesh.msh"), dir.path().join("link.msh"));
        fs::write(&path, "old").unwrap();
        symlink(&path, &link).unwrap();
        write(&link, |part| part.stream(|out| Ok(out.write_all(b"new")?))).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn many_writers_of_one_name_leave_one_whole_file() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mesh.msh");
        std::thread::scope(|scope| {
            for text in ["first", "other"] {
                let path = &path;
                scope.spawn(move || {
                    for _ in 0..20 {
                        write(path, |part| part.stream(|out| Ok(out.write_all(text.as_bytes())?))).unwrap();
                    }
                });
            }
        });
        assert!(["first", "other"].contains(&fs::read_to_string(&path).unwrap().as_str()));
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_link_to_nothing_stays_a_link() {
        let dir = tempfile::tempdir().unwrap();
        let (path, link) = (dir.path().join("mesh.msh"), dir.path().join("link.msh"));
        symlink("mesh.msh", &link).unwrap();
        write_bytes(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&path).unwrap(), b"new");
        let circle = dir.path().join("circle");
        symlink("circle", &circle).unwrap();
        assert!(write_bytes(&circle, b"new").is_err());
    }

    #[test]
    fn a_read_only_file_is_not_replaced() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("mesh.msh");
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o444)).unwrap();
        for refused in [write_bytes(&path, b"new"), check_file(&path, 0)] {
            assert!(refused.is_err_and(|e| e.to_string().contains("read-only")));
        }
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    /// Left is what nobody has locked; a link under such a name is neither followed nor removed.
    #[test]
    fn what_killed_runs_left_is_removed_and_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let at = |name: &str| dir.path().join(name);
        let path = at("mesh.msh");
        for name in [".mesh.msh.sagitta-left.part", ".mesh.msh.sagitta-held.part", ".other.msh.sagitta-left.part"] {
            fs::write(at(name), "half").unwrap();
        }
        symlink(at("victim"), at(".mesh.msh.sagitta-link.part")).unwrap();
        fs::write(at("victim"), "precious").unwrap();
        let held = File::open(at(".mesh.msh.sagitta-held.part")).unwrap();
        held.lock().unwrap();
        check_file(&path, 0).unwrap();
        assert!(!at(".mesh.msh.sagitta-left.part").exists());
        held.unlock().unwrap();
        write_bytes(&path, b"new").unwrap();
        let mut names: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        let others = [".mesh.msh.sagitta-link.part", ".other.msh.sagitta-left.part", "mesh.msh", "victim"];
        assert_eq!(names, others);
        assert_eq!(fs::read(at("victim")).unwrap(), b"precious");
    }

    #[test]
    fn long_names_have_temporary_ones_too() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("n".repeat(255));
        write_bytes(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn a_file_larger_than_the_disk_is_refused_before() {
        let dir = tempfile::tempdir().unwrap();
        let refused = check_file(&dir.path().join("mesh.msh"), u64::MAX);
        assert!(refused.is_err_and(|e| e.to_string().contains("leaves")));
    }
}
