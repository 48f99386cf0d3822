//! What stands on a terminal of 80 and of 120 columns, and in a pipe, as text: `tests/terminal/` has what is expected, times masked.

use std::ffi::OsString;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::common::root;

const WIDTHS: [usize; 2] = [80, 120];

/// Commands whose whole output is compared, by the name of the file that has it, with their exit codes.
const SHOWN: [(&str, &str, i32); 12] = [
    (
        "curve",
        "curve fixtures/cylinder_bl/cylinder_bl.msh --cad fixtures/cylinder_bl/cylinder_bl.step --order 2 -o cylinder.msh",
        0,
    ),
    ("check", "check fixtures/samples/hexpyrtet_p3_msh41a.msh", 0),
    ("room", "check fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step --order 3", 0),
    ("link", "link fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step -o weeble.xml", 0),
    ("info", "info fixtures/weeble/weeble.msh", 0),
    ("help", "curve -h", 0),
    ("no_command", "fixtures/weeble/weeble.msh", 2),
    ("cad_second", "curve fixtures/weeble/weeble.msh fixtures/weeble/weeble.step --order 3 -o weeble.msh", 2),
    ("exchanged", "curve fixtures/weeble/weeble.step --cad fixtures/weeble/weeble.msh --order 3 -o weeble.msh", 2),
    (
        "patch",
        "curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step --straight farfeild --order 3 -q -o weeble.msh",
        2,
    ),
    ("absent", "curve fixtures/weeble/weeble.mesh --cad fixtures/weeble/weeble.step --order 3 -q -o weeble.msh", 2),
    ("unused", "convert fixtures/weeble/weeble.msh -o weeble.vtu --ascii", 2),
];

/// A folder in which the fixtures have the names that they have in the repository.
fn place() -> TempDir {
    let dir = tempfile::tempdir().unwrap();
    symlink(root().join("fixtures"), dir.path().join("fixtures")).unwrap();
    dir
}

/// A program in a terminal of its own.
struct Terminal {
    dir: PathBuf,
}

impl Terminal {
    /// Runs the program in a terminal of so many columns.
    fn run(dir: &Path, columns: usize, arguments: &str) -> Terminal {
        let (terminal, columns) = (Terminal { dir: dir.to_owned() }, columns.to_string());
        // The shell hears an interrupt as well, and goes on.
        let program = env!("CARGO_BIN_EXE_sagitta");
        let script = format!("trap : INT; '{program}' {arguments}; echo $? > ending; mv ending ended; exec sleep 1000");
        let mut command = terminal.tmux(["-u", "-f", "/dev/null"]);
        command.args(["new-session", "-d", "-x", &columns, "-y", "200", "sh", "-c", &script]);
        let begun = command.current_dir(dir).output().expect("tmux is there: .ci/setup test installs it");
        assert!(begun.status.success(), "{}", String::from_utf8_lossy(&begun.stderr));
        terminal
    }

    fn tmux<const N: usize>(&self, arguments: [&str; N]) -> Command {
        let mut command = Command::new("tmux");
        command.arg("-S").arg(self.dir.join("terminal")).args(arguments).env("LC_ALL", "C.UTF-8").env_remove("TMUX");
        command
    }

    fn told<const N: usize>(&self, arguments: [&str; N]) -> String {
        let Output { stdout, stderr, status } = self.tmux(arguments).output().unwrap();
        assert!(status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&stderr));
        String::from_utf8(stdout).unwrap()
    }

    /// What stands there.
    fn screen(&self) -> String {
        let screen = self.told(["capture-pane", "-p"]);
        screen.lines().map(str::trim_end).collect::<Vec<_>>().join("\n").trim_end().to_owned()
    }

    /// What stands there once it is as it should be.
    fn screen_when(&self, what: &str, is: impl Fn(&str) -> bool) -> String {
        let start = Instant::now();
        loop {
            let screen = self.screen();
            if is(&screen) {
                return screen;
            }
            assert!(start.elapsed() < Duration::from_secs(120), "{what}:\n{screen}");
            sleep(Duration::from_millis(20));
        }
    }

    /// What stands there when the program has ended, and its exit code.
    fn end(&self) -> (String, i32) {
        let start = Instant::now();
        loop {
            let code = fs::read_to_string(self.dir.join("ended")).ok();
            let before = self.screen();
            sleep(Duration::from_millis(300)); // the terminal may have output to draw yet
            if let (Some(code), true) = (code, before == self.screen()) {
                return (before, code.trim().parse().unwrap());
            }
            assert!(start.elapsed() < Duration::from_secs(300), "it does not end:\n{before}");
        }
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let _ = self.tmux(["kill-server"]).output();
    }
}

/// Whether a line is a row of the table of progress that tells of a sweep, and of which.
fn sweep(line: &str) -> Option<&str> {
    let line = line.trim_start_matches(|c: char| !c.is_ascii());
    let sweep = line.trim().strip_prefix('P')?.split_whitespace().nth(4)?;
    line.contains(" smooth ").then_some(sweep).filter(|sweep| sweep.contains('/'))
}

/// Text without what is another at every run: times, memory, threads, rounding errors, and how many sweeps are told.
fn masked(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines() {
        let rounding = |word: &str| word.contains("e-1") && word.len() > 6 && word.parse::<f64>().is_ok();
        let words: Vec<String> =
            line.split(' ').map(|word| if rounding(word) { "~".repeat(8) } else { word.into() }).collect();
        let line = words.join(" ");
        match line.as_str() {
            _ if lines.last().is_some_and(|last| last.starts_with("seconds ")) => lines.push("(seconds)".to_owned()),
            _ if line.starts_with("together ") => lines.push("(together)".to_owned()),
            _ if sweep(&line).is_some_and(|sweep| !sweep.starts_with("1/")) => {}
            _ if line.contains("/7 ") && line.len() > 57 => lines.push(format!("{}(times)", &line[..57])),
            _ => lines.push(line),
        }
    }
    lines.join("\n") + "\n"
}

fn expected(name: &str, columns: &str) -> PathBuf {
    root().join(format!("tests/terminal/{name}_{columns}.txt"))
}

/// What each of [`SHOWN`] shows in every width and in a pipe, by the file that has what is expected.
fn shown() -> impl Iterator<Item = (PathBuf, String)> {
    SHOWN.into_iter().flat_map(|(name, arguments, code)| {
        let screens = WIDTHS.map(|columns| {
            let dir = place();
            let (screen, ended) = Terminal::run(dir.path(), columns, arguments).end();
            assert_eq!(ended, code, "{name}: {screen}");
            (expected(name, &columns.to_string()), masked(&screen))
        });
        let dir = place();
        let mut command = Command::new(env!("CARGO_BIN_EXE_sagitta"));
        let piped = command.args(arguments.split(' ')).current_dir(dir.path()).output().unwrap();
        assert_eq!(piped.status.code(), Some(code), "{name}");
        let [out, told] = [piped.stdout, piped.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        let piped = masked(&format!("-- stderr\n{told}-- stdout\n{out}"));
        screens.into_iter().chain([(expected(name, "piped"), piped)])
    })
}

#[test]
fn what_is_shown_is_what_is_expected() {
    for (path, text) in shown() {
        let name = path.display();
        let known = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(text == known, "{name} has\n{known}\nand it is\n{text}\n(`terminal::write` writes all of them)");
    }
}

#[test]
#[ignore = "writes what is expected"]
fn write() {
    for (path, text) in shown() {
        fs::write(path, text).unwrap();
    }
}

/// Tables fit into 80 columns: what is printed in a pipe has no longer lines but sentences and lists of names.
#[test]
fn tables_fit_into_80_columns() {
    for name in ["curve", "check", "room", "link"] {
        let text = fs::read_to_string(expected(name, "piped")).unwrap();
        let long = text.lines().find(|line| line.len() > 80 && !line.starts_with("note: "));
        assert_eq!(long, None, "{name}");
    }
}

#[test]
fn progress_is_redrawn_in_place_and_an_interrupt_is_acknowledged_at_once() {
    for columns in WIDTHS {
        let dir = place();
        let arguments = "curve fixtures/weeble/weeble.msh --cad fixtures/weeble/weeble.step --order 3 --threshold 0.97 -o weeble.msh";
        let terminal = Terminal::run(dir.path(), columns, arguments);
        let late = |screen: &str| {
            let sweep = screen.lines().find_map(sweep).and_then(|sweep| sweep.split('/').next()?.parse::<usize>().ok());
            sweep.is_some_and(|sweep| sweep > 1)
        };
        let screen = terminal.screen_when("no second sweep is told", late);
        let lines: Vec<&str> = screen.lines().collect();
        assert_eq!(lines.len(), 2, "{screen}");
        let heads: Vec<&str> = lines[0].split_whitespace().collect();
        let columns_of_table = ["order", "step", "sweep", "active", "inverted", "worst", "elapsed", "estimate"];
        assert_eq!(heads, columns_of_table, "{screen}");
        let ends = |line: &str| line.trim_end().chars().count();
        assert_eq!([ends(lines[0]), ends(lines[1])], [78, 78], "the last column is under its head:\n{screen}");
        terminal.told(["send-keys", "C-c"]);
        let told =
            terminal.screen_when("the interrupt is not acknowledged", |screen| screen.contains("interrupt again"));
        assert!(told.contains("interrupted (SIGINT): ends smoothing, certifies and writes the mesh"), "{told}");
        let (screen, code) = terminal.end();
        assert_eq!(code, 5, "{screen}");
        assert!(screen.contains("stopped early: interrupted") && screen.contains("written: weeble.msh"), "{screen}");
        // The terminal itself writes ^C, which leaves the heads above the acknowledgement.
        let after = screen.split_once("interrupt again").unwrap().1;
        assert!(!after.contains("estimate") && !after.contains("/7 "), "the live lines are taken away:\n{screen}");
        assert!(dir.path().join(OsString::from("weeble.msh")).exists());
    }
}
