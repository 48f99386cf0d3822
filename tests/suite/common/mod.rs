//! What the tests of the whole program share: the program, the fixtures, the judge.

use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Arguments of any textual or path type, as one array.
macro_rules! args {
    ($($argument:expr),* $(,)?) => { [$(std::ffi::OsString::from(&$argument)),*] };
}

pub mod documents;
pub mod foreign;
pub mod iges;
pub mod impatient;
pub mod input;
pub mod linkage;
pub mod measure;
pub mod random;
pub mod sample;
pub mod sound;
pub mod ugrid;

pub use documents::json;

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// `fixtures/CASE/CASE.EXTENSION`.
pub fn fixture(case: &str, extension: &str) -> PathBuf {
    root().join(format!("fixtures/{case}/{case}.{extension}"))
}

/// What a run of the program left behind.
pub struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    /// Fails with all that was said unless the exit code is the one expected.
    #[track_caller]
    pub fn expect(self, code: i32) -> Outcome {
        assert_eq!(self.code, Some(code), "exit code; stdout:\n{}\nstderr:\n{}", self.stdout, self.stderr);
        self
    }
}

/// Runs the program in the repository's root; what it prints must be as documents and tables are to be.
#[track_caller]
pub fn sagitta<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sagitta"));
    let output = command.args(arguments).current_dir(root()).output().expect("the program starts");
    let stdout = String::from_utf8(output.stdout).expect("stdout is UTF-8");
    documents::check_stdout(&stdout);
    Outcome { code: output.status.code(), stdout, stderr: String::from_utf8(output.stderr).expect("stderr is UTF-8") }
}

/// Whether a line of progress tells of a sweep at this order: `P2 1/2  6/7 smooth  21/200 ...`.
pub fn is_sweep(line: &str, order: &str) -> bool {
    line.starts_with(&format!("{order} ")) && line.contains(" smooth ") && line.split_whitespace().count() > 6
}

/// A number in a JSON document, by JSON pointer.
#[track_caller]
pub fn number(document: &Value, pointer: &str) -> f64 {
    let value = document.pointer(pointer).and_then(Value::as_f64);
    value.unwrap_or_else(|| panic!("no number at {pointer} of {document:#}"))
}

/// Says something that the test harness must not swallow.
#[allow(clippy::explicit_write)]
pub fn warn(text: &str) {
    writeln!(std::io::stderr(), "!!! {text}").expect("stderr takes it");
}

/// The Python with the packages of `tests/judge/requirements.txt`; `None`, said aloud, where it is not named.
pub fn python(what_is_lost: &str) -> Option<PathBuf> {
    let python = std::env::var_os("SAGITTA_PYTHON").filter(|value| !value.is_empty());
    if python.is_none() {
        warn(&format!("SAGITTA_PYTHON is not set: {what_is_lost}"));
    }
    python.map(PathBuf::from)
}

/// Runs one of the scripts of `tests/judge/` and parses the last JSON document that it prints.
pub fn script<S: AsRef<OsStr>>(python: &Path, name: &str, arguments: impl IntoIterator<Item = S>) -> Value {
    let script = root().join("tests/judge").join(name);
    let output = Command::new(python).arg(script).args(arguments).output().expect("SAGITTA_PYTHON runs");
    let text = String::from_utf8_lossy(&output.stdout);
    let start = text.find('{').unwrap_or(text.len());
    serde_json::from_str(&text[start..])
        .unwrap_or_else(|e| panic!("{name}: {e}\n{text}\n{}", String::from_utf8_lossy(&output.stderr)))
}

/// Names of the files in a folder, sorted.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder can be listed");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
