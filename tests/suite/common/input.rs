//! Input for `curve`, spoilt or not, and the rules of refusing it.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use sagitta::formats::{self, WriteOptions};
use sagitta::mesh::{Mesh, Parts};
use tempfile::TempDir;

use super::{fixture, names_in, sagitta};

/// The fixture that is spoilt: the smallest one, of hexahedra.
pub const CASE: &str = "cylinder_bl";

/// A folder for made-up input and one for output.
pub struct Place {
    pub dir: TempDir,
}

impl Place {
    pub fn new() -> Place {
        let dir = tempfile::tempdir().unwrap();
        ["in", "out"].iter().for_each(|name| std::fs::create_dir(dir.path().join(name)).unwrap());
        Place { dir }
    }

    pub fn output(&self) -> PathBuf {
        self.dir.path().join("out/curved.msh")
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.dir.path().join("in").join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    /// The case's mesh, changed.
    pub fn mesh(&self, name: &str, change: impl FnOnce(&mut Parts)) -> PathBuf {
        let mut parts = formats::read(&fixture(CASE, "msh")).unwrap().into_parts();
        change(&mut parts);
        let mesh = Mesh::new(parts).unwrap();
        let path = self.dir.path().join("in").join(name);
        formats::write(&path, &mesh, &WriteOptions::default()).unwrap();
        path
    }

    /// The case's linkage file with one piece of text replaced.
    pub fn linkage(&self, name: &str, from: &str, to: &str) -> PathBuf {
        let text = std::fs::read_to_string(fixture(CASE, "meshlink.xml")).unwrap();
        assert!(text.contains(from), "{from}");
        self.write(name, text.replacen(from, to, 1))
    }

    /// Runs `curve`, which must refuse in one line that has all the needles; returns the line.
    #[track_caller]
    pub fn refuses(&self, input: Input, needles: &[&str]) -> String {
        let before = names_in(&self.dir.path().join("in"));
        let outcome = sagitta(input.arguments(&self.output()));
        let told = outcome.stderr.trim_end().to_owned();
        assert_eq!(outcome.code, Some(2), "{told}\n{}", outcome.stdout);
        assert_eq!(told.lines().count(), 1, "one line: {told}");
        assert!(told.starts_with("sagitta: "), "{told}");
        assert_eq!(outcome.stdout, "", "{told}");
        for needle in needles {
            assert!(told.contains(needle), "{needle:?} is not in: {told}");
        }
        assert_eq!(names_in(&self.dir.path().join("out")), [""; 0], "nothing is left behind: {told}");
        assert_eq!(names_in(&self.dir.path().join("in")), before, "nothing is left beside the input: {told}");
        told
    }
}

/// What `curve` is given.
pub struct Input {
    pub mesh: PathBuf,
    pub cad: PathBuf,
    pub linkage: Option<PathBuf>,
    pub more: Vec<OsString>,
}

impl Default for Input {
    fn default() -> Input {
        Input { mesh: fixture(CASE, "msh"), cad: fixture(CASE, "step"), linkage: None, more: Vec::new() }
    }
}

impl Input {
    pub fn mesh(mesh: impl Into<PathBuf>) -> Input {
        Input { mesh: mesh.into(), ..Input::default() }
    }

    pub fn cad(cad: impl Into<PathBuf>) -> Input {
        Input { cad: cad.into(), ..Input::default() }
    }

    pub fn linkage(linkage: impl Into<PathBuf>) -> Input {
        Input { linkage: Some(linkage.into()), ..Input::default() }
    }

    pub fn with(mut self, more: &[&str]) -> Input {
        self.more.extend(more.iter().map(OsString::from));
        self
    }

    pub fn arguments(&self, output: &Path) -> Vec<OsString> {
        let mut all = args!["curve", self.mesh, "--cad", self.cad, "--order", "2", "-q", "-o", output].to_vec();
        all.extend(self.linkage.iter().flat_map(|path| args!["--linkage", path]));
        all.extend(self.more.iter().cloned());
        all
    }
}
