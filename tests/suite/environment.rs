//! Signals, processes that are killed, programs that are replaced, and values that no machine has.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::common::{fixture, is_sweep, names_in, root, sagitta};
use sagitta::formats;

const MOMENT: Duration = Duration::from_millis(5);

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sagitta"));
    command.current_dir(root()).process_group(0).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn send(signal: &str, to: impl ToString) {
    // What has ended meanwhile hears nothing.
    let _ = Command::new("kill").args(["-s", signal, "--", &to.to_string()]).stderr(Stdio::null()).status().unwrap();
}

/// Waits until something is there.
fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < Duration::from_secs(20), "{what}");
        sleep(MOMENT);
    }
}

/// A `curve` whose reading child has stopped before it could answer, and the number of that child.
fn reading(out: &Path) -> (Child, u32) {
    loop {
        let (mesh, cad) = (fixture("wing_sharp", "msh"), fixture("wing_sharp", "step"));
        let arguments = args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", out];
        let mut parent = program().args(arguments).spawn().unwrap();
        let reader = wait_for("there is no child", || {
            let threads = fs::read_dir(format!("/proc/{}/task", parent.id())).ok()?;
            let children =
                threads.flatten().filter_map(|thread| fs::read_to_string(thread.path().join("children")).ok());
            children.collect::<String>().split_whitespace().next().map(|child| child.parse().unwrap())
        });
        send("STOP", reader);
        let state = wait_for("it does not stop", || {
            let stat = fs::read_to_string(format!("/proc/{reader}/stat")).unwrap_or_else(|_| ") X".into());
            let state = stat.rsplit_once(") ")?.1.chars().next()?;
            "TZX".contains(state).then_some(state)
        });
        if state == 'T' {
            return (parent, reader);
        }
        parent.wait().unwrap(); // the child was faster
    }
}

fn is_there(process: u32) -> bool {
    fs::read_to_string(format!("/proc/{process}/stat")).is_ok_and(|stat| !stat.contains(") Z"))
}

/// How it ended, and what it said on stderr.
fn ended(child: Child) -> (ExitStatus, String) {
    let output = child.wait_with_output().unwrap();
    (output.status, String::from_utf8(output.stderr).unwrap())
}

/// A terminal sends its interrupt to the whole group.
#[test]
fn an_interrupt_while_reading_is_an_interrupt() {
    for signal in ["INT", "TERM", "HUP"] {
        let dir = tempfile::tempdir().unwrap();
        let (parent, reader) = reading(&dir.path().join("out.msh"));
        send(signal, -i64::from(parent.id()));
        let (status, told) = ended(parent);
        assert_eq!(status.code(), Some(130), "{told}");
        assert_eq!(told, format!("sagitta: interrupted (SIG{signal}): nothing is written\n"));
        wait_for("the reader outlives its parent", || (!is_there(reader)).then_some(()));
        assert_eq!(names_in(dir.path()), [""; 0]);
    }
}

#[test]
fn a_killed_reader_is_told_as_a_killed_reader() {
    let dir = tempfile::tempdir().unwrap();
    for signal in ["KILL", "TERM"] {
        let (parent, reader) = reading(&dir.path().join("out.msh"));
        send(signal, reader);
        send("CONT", reader);
        let (status, told) = ended(parent);
        assert_eq!(status.code(), Some(2), "{told}");
        assert!(told.contains("wing_sharp.step: the reading process was killed (signal: "), "{told}");
        assert!(told.contains(signal) && !told.contains("malformed") && told.lines().count() == 1, "{told}");
    }
}

#[test]
fn a_reader_ends_with_its_parent() {
    let dir = tempfile::tempdir().unwrap();
    let (mut parent, reader) = reading(&dir.path().join("out.msh"));
    parent.kill().unwrap();
    parent.wait().unwrap();
    wait_for("the reader outlives its parent", || (!is_there(reader)).then_some(()));
}

/// Where its parent is stopped, or lost.
#[test]
fn a_reader_ends_after_its_own_time() {
    for (parent, time) in [(std::process::id(), 0), (1, 1_000_000)] {
        let cad = fixture("wing_sharp", "step");
        let mut reader = program();
        reader.args(args!["__read-cad", cad]).env("SAGITTA_READER_WATCH", format!("{parent} {time}"));
        let output = reader.output().unwrap();
        assert_eq!(output.status.signal(), Some(9), "{parent} {time}");
    }
}

/// The file that a program was started from reads for it, whatever has its name now.
#[test]
fn an_upgrade_while_it_runs_does_no_harm() {
    let dir = tempfile::tempdir().unwrap();
    let own = dir.path().join("sagitta");
    fs::copy(env!("CARGO_BIN_EXE_sagitta"), &own).unwrap();
    let mut command = Command::new(&own);
    command.args(args!["project", fixture("plate", "step"), "-", "-q"]).current_dir(root());
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let is_own = || fs::read_link(format!("/proc/{}/exe", child.id())).ok().filter(|exe| *exe == own);
    wait_for("it does not begin", is_own);
    fs::remove_file(&own).unwrap();
    fs::copy("/bin/echo", &own).unwrap();
    child.stdin.take().unwrap().write_all(b"x,y,z\n0,0,0\n").unwrap();
    let (status, told) = ended(child);
    assert_eq!(status.code(), Some(0), "{told}");
}

/// The weeble, long enough to be interrupted, once its first sweep is told; and the lines of its stderr.
fn smoothing(mut command: Command, order: &str, out: &Path) -> (Child, impl Iterator<Item = String> + use<>) {
    command.args(["curve", "fixtures/weeble/weeble.msh", "--cad", "fixtures/weeble/weeble.step", "--order", order]);
    let mut child = command.args(["--threshold", "0.97", "--max-sweeps", "30", "-o"]).arg(out).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| is_sweep(&line, "P2")), "a sweep is told before it ends");
    (child, lines)
}

fn ended_after(mut child: Child, lines: impl Iterator<Item = String>) -> (ExitStatus, String) {
    let mut told: String = lines.collect::<Vec<_>>().join("\n");
    child.stdout.take().unwrap().read_to_string(&mut told).unwrap();
    (child.wait().unwrap(), told)
}

/// `timeout` sends its signal to the program and to its group: the program gets it twice.
#[test]
fn two_signals_at_once_are_one_wish() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.msh");
    let (child, lines) = smoothing(program(), "3", &out);
    send("TERM", child.id());
    send("TERM", -i64::from(child.id()));
    let (status, told) = ended_after(child, lines);
    assert_eq!(status.code(), Some(5), "{told}");
    assert!(told.contains("stopped early: interrupted"), "{told}");
    assert!(formats::read(&out).is_ok());
    assert_eq!(names_in(dir.path()), ["out.msh"]);
}

#[test]
fn a_second_wish_ends_at_once() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out.msh");
    let (child, lines) = smoothing(program(), "3", &out);
    send("INT", child.id());
    sleep(Duration::from_millis(30)); // it is heard
    send("STOP", child.id());
    sleep(Duration::from_millis(1100));
    send("INT", child.id());
    send("CONT", child.id());
    let (status, told) = ended_after(child, lines);
    assert_eq!(status.code(), Some(130), "{told}");
    assert!(told.contains("interrupted (SIGINT): nothing is written"), "{told}");
    assert_eq!(names_in(dir.path()), [""; 0]);
}

/// stdout takes nothing, so that the report cannot be printed: the file that was asked for is there by then.
fn interrupted_after_its_result(arguments: &[std::ffi::OsString], out: &Path, wishes: usize) -> (ExitStatus, String) {
    let (_reader, mut stdout) = std::io::pipe().unwrap();
    let full = rustix::pipe::fcntl_getpipe_size(&stdout).unwrap();
    stdout.write_all(&vec![b'-'; full]).unwrap();
    let child = program().args(arguments).stdout(stdout).spawn().unwrap();
    wait_for("its file does not come", || out.exists().then_some(()));
    for _ in 0..wishes {
        sleep(Duration::from_millis(1100));
        send("INT", child.id());
    }
    ended(child)
}

#[test]
fn an_end_after_the_result_has_the_code_of_the_result() {
    let dir = tempfile::tempdir().unwrap();
    let (mesh, cad) = (fixture("plate", "msh"), fixture("plate", "step"));
    let (out, link, other) = (dir.path().join("o.msh"), dir.path().join("l.xml"), dir.path().join("o.vtu"));
    let curve = args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", out].map(Into::into);
    let link_up = args!["link", mesh, "--cad", cad, "-o", link].map(Into::into);
    let convert = args!["convert", mesh, "-o", other].map(Into::into);
    for (arguments, out, wishes) in [(&curve[..], &out, 2), (&link_up[..], &link, 1), (&convert[..], &other, 1)] {
        let (status, told) = interrupted_after_its_result(arguments, out, wishes);
        assert_eq!(status.code(), Some(6), "{arguments:?}: {told}");
        let line = format!("sagitta: interrupted (SIGINT): written before: {}; nothing else\n", out.display());
        assert!(told.ends_with(&line), "{told}");
    }
    sagitta(args!["check", out, "--linear", mesh]).expect(0);
    assert_eq!(names_in(dir.path()), ["l.xml", "o.msh", "o.vtu"]);
}

/// `nohup` has its programs ignore the end of the terminal.
#[test]
fn what_is_ignored_from_the_beginning_stays_ignored() {
    let dir = tempfile::tempdir().unwrap();
    let mut command = Command::new("sh");
    command.args(["-c", "trap '' HUP INT; exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_sagitta")]).current_dir(root());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let (child, lines) = smoothing(command, "2", &dir.path().join("out.msh"));
    send("HUP", child.id());
    send("INT", child.id());
    let (status, told) = ended_after(child, lines);
    assert_eq!(status.code(), Some(0), "{told}");
}

#[test]
fn values_that_no_machine_has_are_refused_with_their_range() {
    let (mesh, cad) = (fixture("plate", "msh"), fixture("plate", "step"));
    let dir = tempfile::tempdir().unwrap();
    let curve = args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", dir.path().join("out.msh")];
    for (option, value, range) in [
        ("--time-limit", "1e20", "up to 1e9"),
        ("--time-limit", "inf", "up to 1e9"),
        ("--cad-timeout", "1e20", "up to 1e9"),
        ("--cad-timeout", "0", "up to 1e9"),
        ("--threads", "1000000", "from 1 to "),
        ("--threads", "0", "from 1 to "),
        ("--threads", "99999999999999999999999", "from 1 to "),
        ("--cad-scale", "1e300", "from 1e-15 to 1e15"),
        ("--cad-scale", "1e-300", "from 1e-15 to 1e15"),
        ("--max-offset", "1e300", "up to 1e15"),
        ("--survey-factor", "17", "1..=16"),
        ("--alpha", "2", "between 0 and 1"),
    ] {
        let told = sagitta(curve.iter().cloned().chain(args![option, value])).expect(2).stderr;
        assert!(told.contains(option) && told.contains(range), "{option} {value}: {told}");
    }
    for arguments in [
        args!["info", cad, "--cad-timeout", "1e20"],
        args!["groups", cad, "--cad-timeout", "1e20"],
        args!["validate", "x.xml", "--cad-timeout", "1e20"],
    ] {
        let told = sagitta(arguments).expect(2).stderr;
        assert!(told.contains("up to 1e9"), "{told}");
    }
    assert_eq!(names_in(dir.path()), [""; 0]);
    // Large, and of this world.
    let large = ["--time-limit", "1e9", "--cad-timeout", "1e9", "--max-sweeps", "18446744073709551615"];
    let state = args!["--checkpoint", dir.path().join("state"), "--checkpoint-every", "18446744073709551615"];
    sagitta(curve.into_iter().chain(large.map(Into::into)).chain(state)).expect(0);
}

#[test]
fn a_number_of_threads_from_the_environment_is_bounded() {
    let dir = tempfile::tempdir().unwrap();
    let (mesh, cad, out) = (fixture("plate", "msh"), fixture("plate", "step"), dir.path().join("out.msh"));
    let mut command = program();
    command
        .args(args!["curve", mesh, "--cad", cad, "--order", "2", "-q", "-o", out])
        .env("RAYON_NUM_THREADS", "1000000");
    let start = Instant::now();
    let (status, told) = ended(command.spawn().unwrap());
    assert_eq!(status.code(), Some(0), "{told}");
    assert!(told.contains("RAYON_NUM_THREADS is 1000000: ") && told.lines().count() == 1, "{told}");
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}
