//! What is written is whole and on the disk, or what was there before is there still; nothing that is written is anything else.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::common::{fixture, names_in, root, sagitta};
use sagitta::formats;

/// The smallest case with CAD.
const CASE: &str = "cylinder_bl";

/// All cells at P1.
const SAMPLE: &str = "fixtures/samples/hexpyrtet_p1_msh41a.msh";

fn program() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sagitta"));
    command.current_dir(root());
    command
}

/// The program under a limit of the size of its files, in bytes.
fn limited(bytes: u64, arguments: &[OsString]) -> Output {
    let mut command = Command::new("prlimit");
    command.arg(format!("--fsize={bytes}:{bytes}")).arg(env!("CARGO_BIN_EXE_sagitta")).args(arguments);
    command.current_dir(root()).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs a command that writes `file` under limits below its size, by so many bytes, and at it.
fn assert_whole_or_old(arguments: &[OsString], file: &Path, less: &[u64]) {
    let folder = file.parent().unwrap();
    sagitta(arguments).expect(0);
    let (whole, names) = (fs::read(file).unwrap(), names_in(folder));
    let size = whole.len() as u64;
    for limit in less.iter().map(|less| size.saturating_sub(*less)).chain([size / 2, size]) {
        fs::write(file, "old").unwrap();
        let output = limited(limit, arguments);
        let told = format!("{} at {limit} of {size} bytes: {}", file.display(), stderr(&output));
        let now = fs::read(file).unwrap();
        if limit >= size {
            assert_eq!(output.status.code(), Some(0), "{told}");
            assert!(now == whole, "{told}");
        } else {
            assert_eq!(output.status.code(), Some(2), "{told}");
            assert!(now == b"old", "{told}");
            assert!(stderr(&output).contains(file.file_name().unwrap().to_str().unwrap()), "{told}");
            assert_eq!(stderr(&output).lines().count(), 1, "{told}");
        }
        assert_eq!(names_in(folder), names, "{told}");
    }
}

#[test]
fn every_writer_of_meshes_leaves_a_whole_file_or_the_old_one() {
    let dir = tempfile::tempdir().unwrap();
    let written = formats::REGISTRY.iter().filter(|format| format.writer.is_some());
    let several = |ending: &&&str| **ending == "vtm"; // see `a_file_that_names_others_comes_last`
    let endings = written.flat_map(|format| format.endings).filter(|ending| !several(ending));
    let endings = endings.map(|ending| (*ending, vec![]));
    let forms = [vec!["--ascii"], vec!["--msh-version", "2.2"], vec!["--msh-version", "2.2", "--ascii"]];
    for (ending, form) in endings.chain(forms.map(|form| ("msh", form))) {
        let file = dir.path().join(format!("mesh.{ending}"));
        let mut arguments = args!["convert", SAMPLE, "-o", file].to_vec();
        arguments.extend(form.into_iter().map(OsString::from));
        assert_whole_or_old(&arguments, &file, &[1, 7, 100, 511, 513, 2000, 4096, 9999]);
    }
}

/// A VTM file names others, which are written before it.
#[test]
fn a_file_that_names_others_comes_last() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("mesh.vtm");
    let arguments = args!["convert", SAMPLE, "-o", file];
    sagitta(&arguments).expect(0);
    let blocks = names_in(&dir.path().join("mesh"));
    assert!(blocks.contains(&"cells.vtu".to_owned()) && blocks.len() > 1, "{blocks:?}");
    let cells = fs::read(dir.path().join("mesh/cells.vtu")).unwrap();
    fs::write(&file, "old").unwrap();
    let output = limited(cells.len() as u64 - 1, &arguments);
    assert_eq!(output.status.code(), Some(2), "{}", stderr(&output));
    assert!(stderr(&output).contains("mesh.vtm") && stderr(&output).contains("cells.vtu"), "{}", stderr(&output));
    assert_eq!(fs::read(&file).unwrap(), b"old");
    assert_eq!(names_in(&dir.path().join("mesh")), blocks);
}

#[test]
fn every_other_writer_does_so_too() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let points: String = (0..400).map(|n| format!("{n},1,2\n")).collect();
    fs::write(at("points.csv"), format!("x,y,z\n{points}")).unwrap();
    let (mesh, cad) = (fixture(CASE, "msh"), fixture(CASE, "step"));
    assert_whole_or_old(&args!["link", mesh, "--cad", cad, "-o", at("link.xml")], &at("link.xml"), &[1]);
    assert_whole_or_old(&args!["project", cad, at("points.csv"), "-q", "-o", at("feet.csv")], &at("feet.csv"), &[1]);
}

/// Each command with what it reads and writes: the place of a file is its name behind `<` or `>`.
const COMMANDS: [&[&str]; 5] = [
    &[
        "curve",
        "<mesh.msh",
        "--cad",
        "<cad.step",
        "--linkage",
        "<link.xml",
        "--resume",
        "<resume",
        "--order",
        "2",
        "-q",
        "-o",
        ">out.msh",
        "--report",
        ">report.json",
        "--trace",
        ">trace.csv",
        "--checkpoint",
        ">state",
    ],
    &["check", "<mesh.msh", "--linear", "<linear.msh", "--report", ">report.json"],
    &["convert", "<mesh.msh", "-o", ">out.msh"],
    &["link", "<mesh.msh", "--cad", "<cad.step", "-o", ">link.xml", "--report", ">report.json"],
    &["project", "<cad.step", "<points.csv", "-q", "-o", ">feet.csv", "--report", ">report.json"],
];

/// Runs one of them with one of its outputs called as told; it must be refused, and nothing may have changed.
fn assert_refused(command: &[&str], output: &str, called: &str, folder: &Path) {
    let before: Vec<_> = names_in(folder).into_iter().map(|name| (fs::read(folder.join(&name)).ok(), name)).collect();
    let name = |word: &&str| if *word == output { called.to_owned() } else { word.replace(['<', '>'], "") };
    let words: Vec<String> = command.iter().map(name).collect();
    let ended = program().current_dir(folder).args(&words).output().unwrap();
    assert_eq!(ended.status.code(), Some(2), "{words:?}: {}", stderr(&ended));
    assert!(stderr(&ended).contains("is the same file as"), "{words:?}: {}", stderr(&ended));
    let after: Vec<_> = names_in(folder).into_iter().map(|name| (fs::read(folder.join(&name)).ok(), name)).collect();
    assert!(after == before, "{words:?}: {}", stderr(&ended));
}

#[test]
fn no_output_is_an_input_or_another_output() {
    for command in COMMANDS {
        let words = |sign: char| command.iter().copied().filter(move |word| word.starts_with(sign));
        for output in words('>') {
            for input in words('<').filter(|input| !(output == ">state" && *input == "<resume")) {
                let dir = tempfile::tempdir().unwrap();
                let at = |name: &str| dir.path().join(name);
                words('<').for_each(|input| fs::write(at(&input[1..]), "precious").unwrap());
                // Names of meshes must end as a format does.
                let ending =
                    Path::new(&output[1..]).extension().map_or(String::new(), |end| format!(".{}", end.display()));
                let [soft, hard] = ["soft", "hard"].map(|name| format!("{name}{ending}"));
                symlink(&input[1..], at(&soft)).unwrap();
                fs::hard_link(at(&input[1..]), at(&hard)).unwrap();
                for called in [&input[1..], &format!("./{}", &input[1..]), &soft, &hard] {
                    assert_refused(command, output, called, dir.path());
                }
            }
            for other in words('>').take_while(|other| *other != output) {
                let dir = tempfile::tempdir().unwrap();
                words('<').for_each(|input| fs::write(dir.path().join(&input[1..]), "precious").unwrap());
                symlink(&other[1..], dir.path().join("soft")).unwrap();
                for called in [&other[1..], &format!("././{}", &other[1..]), "soft"] {
                    assert_refused(command, output, called, dir.path());
                }
            }
        }
    }
}

/// `sagitta ... >> mesh` and the like.
#[test]
fn no_output_is_where_stdout_or_stderr_go() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("out.msh");
    for stdout in [true, false] {
        let file = fs::File::options().create(true).append(true).open(&path).unwrap();
        let mut command = program();
        command.args(args!["convert", SAMPLE, "-o", path]).stdout(Stdio::piped()).stderr(Stdio::piped());
        if stdout {
            command.stdout(file)
        } else {
            command.stderr(file)
        };
        assert_eq!(command.output().unwrap().status.code(), Some(2));
        assert_eq!(names_in(dir.path()), ["out.msh"]);
        assert!(!fs::read_to_string(&path).unwrap().contains("MeshFormat"));
    }
}

/// The names of a UGRID mesh's surfaces are in a file beside it, which no option names.
#[test]
fn what_is_read_beside_a_mesh_is_an_input() {
    let dir = tempfile::tempdir().unwrap();
    let names = dir.path().join("mesh.mapbc");
    fs::write(dir.path().join("mesh.ugrid"), "precious").unwrap();
    fs::write(&names, "precious").unwrap();
    let told = sagitta(args!["check", dir.path().join("mesh.ugrid"), "--report", names]).expect(2).stderr;
    assert!(told.contains("is the same file as"), "{told}");
    assert_eq!(fs::read_to_string(&names).unwrap(), "precious");
}

#[test]
fn nothing_in_the_folder_of_a_vtm_file_is_lost() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("out")).unwrap();
    let (mesh, link) = (dir.path().join("out/cells.vtu"), dir.path().join("link.vtu"));
    sagitta(args!["convert", SAMPLE, "-o", mesh]).expect(0);
    symlink(&mesh, &link).unwrap();
    let before = fs::read(&mesh).unwrap();
    for input in [&mesh, &link] {
        let told = sagitta(args!["convert", input, "-o", dir.path().join("out.vtm")]).expect(2).stderr;
        assert!(told.contains("writes to the folder") && told.contains("give another name"), "{told}");
        assert!(fs::read(&mesh).unwrap() == before);
    }
    sagitta(args!["convert", SAMPLE, "-o", dir.path().join("out.vtm")]).expect(0);
}

#[test]
fn the_files_of_a_case_are_inputs() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("constant/polyMesh");
    fs::create_dir_all(&folder).unwrap();
    let names = ["points", "faces", "owner", "neighbour", "boundary"];
    names.iter().for_each(|name| fs::write(folder.join(name), "precious").unwrap());
    for name in names {
        let told = sagitta(args!["check", dir.path(), "--report", folder.join(name)]).expect(2).stderr;
        assert!(told.contains("is the same file as"), "{told}");
        assert_eq!(fs::read_to_string(folder.join(name)).unwrap(), "precious");
    }
}

#[test]
fn what_cannot_be_written_is_refused_before_the_work() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::create_dir(at("folder.json")).unwrap();
    fs::write(at("fixed.json"), "old").unwrap();
    fs::set_permissions(at("fixed.json"), fs::Permissions::from_mode(0o444)).unwrap();
    assert!(Command::new("mkfifo").arg(at("pipe.json")).status().unwrap().success());
    symlink("circle.json", at("circle.json")).unwrap();
    let (mesh, cad) = (fixture(CASE, "msh"), fixture(CASE, "step"));
    for name in ["folder.json", "fixed.json", "pipe.json", "circle.json", "none/x.json"] {
        let linked = args!["link", mesh, "--cad", cad, "-o", at("out.xml"), "--report", at(name)];
        let checked = args!["check", mesh, "--report", at(name)];
        for option in ["--report", "--trace", "--checkpoint"] {
            let curved = args!["curve", mesh, "--cad", cad, "--order", "2", "-o", at("out.msh"), option, at(name)];
            for arguments in [&curved[..], &linked, &checked] {
                let told = sagitta(arguments).expect(2);
                assert!(told.stderr.lines().count() == 1 && told.stderr.contains(name), "{}", told.stderr);
            }
        }
    }
    assert_eq!(names_in(dir.path()), ["circle.json", "fixed.json", "folder.json", "pipe.json"]);
    assert_eq!(fs::read_to_string(at("fixed.json")).unwrap(), "old");
}

#[test]
fn a_mode_is_kept_and_a_link_stays_one() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    fs::create_dir(at("elsewhere")).unwrap();
    fs::write(at("elsewhere/out.msh"), "old").unwrap();
    fs::set_permissions(at("elsewhere/out.msh"), fs::Permissions::from_mode(0o640)).unwrap();
    symlink("elsewhere/out.msh", at("out.msh")).unwrap();
    sagitta(args!["convert", SAMPLE, "-o", at("out.msh")]).expect(0);
    assert!(fs::symlink_metadata(at("out.msh")).unwrap().is_symlink());
    assert_eq!(fs::metadata(at("elsewhere/out.msh")).unwrap().permissions().mode() & 0o777, 0o640);
    assert!(formats::read(&at("out.msh")).is_ok());
    assert_eq!(names_in(&at("elsewhere")), ["out.msh"]);
}

/// `curve` with files beside the mesh in a folder of their own.
fn curve(out: &Path, beside: &Path) -> Command {
    let (mesh, cad) = (fixture("weeble", "msh"), fixture("weeble", "step"));
    let mut command = program();
    command.args(args!["curve", mesh, "--cad", cad, "--order", "2", "--checkpoint-every", "1", "-o", out]);
    for (option, name) in [("--report", "r.json"), ("--trace", "t.csv"), ("--checkpoint", "state")] {
        command.arg(option).arg(beside.join(name));
    }
    command
}

#[test]
fn files_beside_the_mesh_never_cost_the_mesh() {
    let dir = tempfile::tempdir().unwrap();
    let (out, beside) = (dir.path().join("out.msh"), dir.path().join("beside"));
    fs::create_dir(&beside).unwrap();
    let mut child = curve(&out, &beside).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map(Result::unwrap);
    assert!(lines.any(|line| line.contains("1/7 read")));
    fs::remove_dir(&beside).unwrap();
    let told: Vec<String> = lines.filter(|line| line.starts_with("sagitta: ")).collect();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(6), "{told:?}");
    assert_eq!(told.len(), 3, "{told:?}");
    for name in ["r.json", "t.csv", "state"] {
        assert!(told.iter().any(|line| line.contains(name)), "{told:?}");
    }
    assert!(String::from_utf8(output.stdout).unwrap().contains("written: "));
    assert!(formats::read(&out).is_ok());
}

/// Standard streams that are closed, or that nothing can be written to.
#[test]
fn streams_that_take_nothing_never_cost_the_mesh() {
    let full = || fs::File::options().write(true).open("/dev/full").unwrap();
    let dir = tempfile::tempdir().unwrap();
    let (out, link) = (dir.path().join("out.msh"), dir.path().join("link.xml"));
    let (mesh, cad) = (fixture(CASE, "msh"), fixture(CASE, "step"));
    let commands = [
        (&out, args!["curve", mesh, "--cad", cad, "--order", "2", "-o", out].to_vec()),
        (&link, args!["link", mesh, "--cad", cad, "-o", link].to_vec()),
        (&out, args!["convert", mesh, "-o", out].to_vec()),
    ];
    for (file, arguments) in &commands {
        let ended = |command: &mut Command, code: i32| {
            let status = command.status().unwrap();
            assert_eq!(status.code(), Some(code), "{command:?}");
            assert!(fs::metadata(file).is_ok_and(|file| file.len() > 0), "{command:?}");
            assert_eq!(names_in(dir.path()).len(), 1, "{command:?}");
            fs::remove_file(file).unwrap();
        };
        ended(program().args(arguments).stdout(full()).stderr(full()), 6);
        ended(program().args(arguments).stdout(Stdio::null()).stderr(full()), 0);
        let closed = args!["-c", "exec \"$0\" \"$@\" <&- >&- 2>&-", env!("CARGO_BIN_EXE_sagitta")];
        ended(Command::new("sh").args(closed).args(arguments).current_dir(root()), 0);
        let gone = args!["-c", "\"$0\" \"$@\" 2>&1 | true; exit ${PIPESTATUS[0]}", env!("CARGO_BIN_EXE_sagitta")];
        ended(Command::new("bash").args(gone).args(arguments).current_dir(root()), 0);
    }
    let result = |arguments: &[&OsStr]| program().args(arguments).stdout(full()).status().unwrap().code();
    let sample = OsStr::new(SAMPLE);
    assert_eq!(result(&[OsStr::new("info"), sample]), Some(2), "what it prints is all that it gives");
    assert_eq!(result(&[OsStr::new("check"), sample]), Some(6), "the exit code tells that it is certified");
}

/// What killed runs left is gone after the next one.
#[test]
fn the_next_run_clears_away_what_a_killed_one_left() {
    let dir = tempfile::tempdir().unwrap();
    let out: PathBuf = dir.path().join("out.msh");
    let left = |dir: &Path| names_in(dir).iter().any(|name| name.ends_with(".part"));
    // A write that the limit of the CPU's time would not reach, stopped where it has begun.
    let mut killed = false;
    for delay in (0..400).cycle().take(4000) {
        let mut child = program().args(args!["convert", "fixtures/weeble/weeble.msh", "-o", out]).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_micros(25_000 + 250 * delay));
        child.kill().unwrap();
        child.wait().unwrap();
        killed = left(dir.path());
        if killed {
            break;
        }
    }
    assert!(killed, "no run was killed while it wrote");
    sagitta(args!["convert", SAMPLE, "-o", out]).expect(0);
    assert_eq!(names_in(dir.path()), ["out.msh"]);
}
