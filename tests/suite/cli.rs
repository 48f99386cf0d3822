//! The program as it is used: help, examples, what it says and writes, and that others can read it.

use std::ffi::OsString;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::common::input::{Input, Place};
use crate::common::{fixture, json, names_in, number, python, root, sagitta, script};
use sagitta::formats;
use sagitta::mesh::EntityKey;
use serde_json::Value;

/// In an order in which files that one's examples make are there for the next.
const COMMANDS: [&str; 11] =
    ["curve", "check", "convert", "picture", "report", "link", "validate", "explain", "info", "groups", "project"];

#[test]
fn help_of_every_command_has_its_examples_and_exit_codes() {
    for command in COMMANDS.map(Some).into_iter().chain([None]) {
        let help = sagitta(command.into_iter().chain(["--help"])).expect(0);
        assert_eq!(help.stderr, "");
        let examples = examples(&help.stdout);
        assert!(examples.len() >= 2, "{command:?}: {}", help.stdout);
        let own = |example: &String| command.is_none_or(|name| example.split(' ').next() == Some(name));
        assert!(examples.iter().all(own), "{command:?}: {examples:?}");
        let codes = help.stdout.split_once("Exit codes:\n").unwrap_or_else(|| panic!("{command:?}: {}", help.stdout)).1;
        for code in ["  0    done", "  2    could not run"] {
            assert!(codes.contains(code), "{command:?}: {codes}");
        }
        for line in help.stdout.lines().skip_while(|line| *line != "Examples:") {
            assert!(line.len() <= 80, "{command:?}: {line}");
        }
        let listed = command.is_some() || COMMANDS.iter().all(|name| help.stdout.contains(&format!("\n  {name} ")));
        assert!(listed, "{}", help.stdout);
    }
    let version = sagitta(["--version"]).expect(0);
    assert_eq!(version.stdout.trim(), format!("sagitta {}", env!("CARGO_PKG_VERSION")));
    // `explain` alone lists all codes.
    let without_arguments = COMMANDS.iter().filter(|command| **command != "explain").map(|command| vec![*command]);
    for wrong in [vec!["nonsense"], vec![]].into_iter().chain(without_arguments) {
        let told = sagitta(&wrong).expect(2);
        assert!(told.stdout.is_empty() && told.stderr.contains("Usage: sagitta"), "{wrong:?}: {}", told.stderr);
    }
}

#[test]
fn completions_and_manual_pages_know_every_command() {
    for shell in ["bash", "zsh", "fish"] {
        let script = sagitta(["completions", shell]).expect(0).stdout;
        assert!(COMMANDS.iter().all(|command| script.contains(command)), "{shell}");
        assert!(script.contains("require-all") && !script.contains("__read"), "{shell}");
    }
    let dir = tempfile::tempdir().unwrap();
    sagitta([OsString::from("man"), dir.path().into()]).expect(0);
    for command in COMMANDS {
        let page = std::fs::read_to_string(dir.path().join(format!("sagitta-{command}.1"))).unwrap();
        assert!(page.contains(".TH") && page.contains("Exit codes"), "{command}");
    }
    assert!(dir.path().join("sagitta.1").exists());
    let told = sagitta([OsString::from("man"), dir.path().join("absent").into()]).expect(2);
    assert!(told.stderr.contains("absent"), "{}", told.stderr);
}

/// Shell commands that call the program: lines that begin with its name, with the lines that they go on in.
fn examples(text: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut open = false;
    for line in text.lines().map(str::trim) {
        let program = ["sagitta ", "target/release/sagitta ", "./target/release/sagitta "];
        let begins = program.iter().find_map(|name| line.strip_prefix(name));
        let part = line.strip_suffix('\\').unwrap_or(line);
        match begins {
            Some(_) if !open => found.push(part.split_once(' ').unwrap().1.to_owned()),
            _ if open => found.last_mut().unwrap().push_str(&format!(" {part}")),
            _ => continue,
        }
        open = line.ends_with('\\');
    }
    found
}

/// Runs commands one after another in the repository; files that they name and that do not exist lie in `dir`. What they print.
fn run(commands: &[String], dir: &Path) -> String {
    let mut printed = String::new();
    for command in commands {
        let command = command.split('#').next().unwrap();
        let place = |word: &str| -> OsString {
            let made = [
                ".msh", ".mesh", ".su2", ".h5", ".cgns", ".vtu", ".json", ".csv", ".xml", ".step", ".html", ".png",
                ".vtm",
            ]
            .iter()
            .any(|end| word.ends_with(end))
                && !root().join(word).exists();
            if made { dir.join(Path::new(word).file_name().unwrap()).into() } else { word.into() }
        };
        let arguments: Vec<OsString> = command.split_whitespace().map(place).collect();
        let outcome = sagitta(&arguments);
        assert_eq!(outcome.code, Some(0), "sagitta {command}\n{}\n{}", outcome.stdout, outcome.stderr);
        for option in ["-o", "--report"] {
            let file = arguments.iter().position(|word| word == option).map(|at| PathBuf::from(&arguments[at + 1]));
            assert!(file.is_none_or(|file| file.starts_with(dir) && file.exists()), "{option} of {command}");
        }
        printed.push_str(&outcome.stdout);
    }
    printed
}

#[test]
fn examples_of_the_help_run() {
    let dir = tempfile::tempdir().unwrap();
    for command in COMMANDS {
        run(&examples(&sagitta([command, "--help"]).expect(0).stdout), dir.path());
    }
    run(&examples(&sagitta(["--help"]).expect(0).stdout), dir.path());
}

/// The blocks of a language in a Markdown text.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    text.split(&fence).skip(1).map(|block| block.split("```").next().unwrap()).collect()
}

#[test]
fn examples_of_the_documents_run() {
    let documents = std::fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let readme = root().join("README.md");
    for document in documents.filter(|path| path.extension().is_some_and(|end| end == "md")).chain([readme.clone()]) {
        let text = std::fs::read_to_string(&document).unwrap();
        let commands = examples(&blocks(&text, "sh").concat());
        assert!(document != readme || !commands.is_empty(), "README.md shows no command of the program");
        let dir = tempfile::tempdir().unwrap();
        let printed = run(&commands, dir.path());
        // What a document shows of the output is what is printed today, figures and padding aside.
        let wording = |text: &str| text.replace(|c: char| c.is_ascii_digit() || " -.".contains(c), "");
        let printed = wording(&printed.replace(&format!("{}/", dir.path().display()), ""));
        for line in blocks(&text, "text").concat().lines().filter(|_| document == readme) {
            assert!(printed.contains(&wording(line)), "{line:?} is not printed:\n{printed}");
        }
    }
}

#[test]
fn what_calls_the_program_is_found_in_text() {
    let text = "$ no\nsagitta info a \\\n   b\nmake demo\n  target/release/sagitta check c  \nsagittas\n";
    assert_eq!(examples(text), ["info a  b", "check c"]);
}

#[test]
fn info_tells_what_each_kind_of_file_holds() {
    let told = |file: PathBuf| sagitta(args!["info", file]).expect(0).stdout;
    for (text, words) in [
        (
            told(fixture("weeble", "msh")),
            &["order P1", "4935 nodes", "28242 tet", "surface 2: 151 faces wall", "box"][..],
        ),
        (told(fixture("weeble_hybrid", "msh")), &["1292 prism", "1957 hex", "103 pyramid", "8285 tet"]),
        (told(root().join("fixtures/samples/hexpyrtet_p3_msh41a.msh")), &["order P3", "1040 nodes", "4 pyramid"]),
        (told(fixture("cylinder_bl", "step")), &["STEP", "millimetre", "6 faces", "4 plane, 2 cylinder", "face:6"]),
        (told(fixture("cylinder_bl", "igs")), &["IGES", "0.001 m", "6 faces", "face:6"]),
        (
            told(fixture("cylinder_bl", "meshlink.xml")),
            &[
                "MeshLink",
                "\"cylinder_bl.step\": 26 references",
                "\"cylinder_bl.msh\"",
                "\"wall/face-4\": 24 faces",
                "12 strings",
            ],
        ),
    ] {
        for word in words {
            assert!(text.contains(word), "{word:?} is not in {text}");
        }
    }
    for (name, content) in [("none", None), ("noise", Some("noise"))] {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join(name);
        content.into_iter().for_each(|text| std::fs::write(&path, text).unwrap());
        let outcome = sagitta(args!["info", path]).expect(2);
        assert!(outcome.stderr.lines().count() == 1 && outcome.stderr.contains(name), "{}", outcome.stderr);
    }
}

/// `weeble_hybrid`, which has all four cells, at P2.
fn curve(output: &Path, more: &[OsString]) -> String {
    let (mesh, cad) = (fixture("weeble_hybrid", "msh"), fixture("weeble_hybrid", "step"));
    let arguments = args!["curve", mesh, "--cad", cad, "--order", "2", "-o", output];
    sagitta(arguments.into_iter().chain(more.iter().cloned())).expect(0).stdout
}

#[test]
fn other_programs_read_every_kind_of_output() {
    let dir = tempfile::tempdir().unwrap();
    let kinds: [(&str, &[&str]); 6] = [
        ("binary41.msh", &[]),
        ("ascii41.msh", &["--ascii"]),
        ("binary22.msh", &["--msh-version", "2.2"]),
        ("ascii22.msh", &["--msh-version", "2.2", "--ascii"]),
        ("all.vtu", &[]),
        ("volume.vtu", &["--volume-only"]),
    ];
    let report = dir.path().join("report.json");
    let files = kinds.map(|(name, options)| {
        let path = dir.path().join(name);
        let options = options.iter().map(OsString::from).chain(args!["--report", report]);
        curve(&path, &options.collect::<Vec<_>>());
        path
    });
    let head = |file: &PathBuf| String::from_utf8_lossy(&std::fs::read(file).unwrap()[..40]).into_owned();
    for (file, start) in files.iter().zip(["4.1 1 8", "4.1 0 8", "2.2 1 8", "2.2 0 8"]) {
        assert!(head(file).starts_with(&format!("$MeshFormat\n{start}")), "{}", head(file));
    }
    let first = formats::read(&files[0]).unwrap();
    for file in &files[1..4] {
        let other = formats::read(file).unwrap();
        assert_eq!((other.points(), other.node_tags()), (first.points(), first.node_tags()), "{}", file.display());
    }
    let count = |dimension: usize| {
        let own = first.blocks().iter().filter(|block| block.cell.dimension() == dimension);
        own.map(|block| block.tags.len()).sum::<usize>()
    };
    let cells = [0, 1, 2, 3].map(count);
    assert_eq!(cells[3], 1292 + 1957 + 103 + 8285);

    let Some(python) = python("the output is NOT read by Gmsh, meshio and VTK") else { return };
    let found = script(&python, "reread.py", &files);
    let of = |file: &PathBuf, reader: &str| found[file.to_str().unwrap()][reader].clone();
    let sum = |elements: &Value| -> u64 {
        let counts = elements.as_object().unwrap_or_else(|| panic!("{found:#}"));
        counts.values().map(|count| count.as_u64().unwrap()).sum()
    };
    let reference = of(&files[0], "gmsh");
    assert!(number(&reference, "/smallest_determinant") > 0.0, "{reference}");
    for file in &files[..4] {
        let gmsh = of(file, "gmsh");
        assert_eq!(sum(&gmsh["elements"]) as usize, cells.iter().sum::<usize>(), "{}: {gmsh}", file.display());
        assert_eq!(gmsh["nodes"], first.points().len(), "{}", file.display());
        assert!((number(&gmsh, "/volume") - number(&reference, "/volume")).abs() < 1e-9, "{gmsh}");
    }
    // VTK has no curved pyramids: each is shown as a hexahedron with 27 points of its own.
    let vtk_points = first.points().len() + 103 * 27;
    let proven = number(&json(&report), "/certificate/j_over_jc/lower");
    for (file, dimensions) in [(&files[4], 0..=3), (&files[5], 3..=3)] {
        let vtk = of(file, "pyvista");
        assert_eq!(sum(&vtk["elements"]) as usize, cells[dimensions].iter().sum::<usize>(), "{vtk}");
        assert_eq!(vtk["nodes"], vtk_points, "{vtk}");
        // VTK's volumes of curved cells are those of their linear pieces.
        assert!((number(&vtk, "/volume") / number(&reference, "/volume") - 1.0).abs() < 0.02, "{vtk} {reference}");
        assert_eq!(number(&vtk["arrays"], "/certified_min_J_over_Jc/0"), proven, "one proven minimum");
        for (array, least) in [("certified_min_J_over_Jc", 0.4), ("C_WCN", 0.7)] {
            let smallest = number(&vtk["arrays"], &format!("/{array}/0"));
            assert!(smallest >= least && smallest <= 1.0, "{array}: {smallest}");
        }
    }
    // meshio refuses VTU 2.2, and MSH 4.1 with entities that are in no physical group, also Gmsh's own.
    for file in &files[2..4] {
        let meshio = of(file, "meshio");
        assert_eq!(meshio["nodes"], first.points().len(), "{}: {meshio}", file.display());
        assert_eq!(meshio["elements"]["tetra10"], 8285, "{}: {meshio}", file.display());
    }
}

#[test]
fn report_and_check_tell_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let [output, report, checked] = ["out.msh", "report.json", "check.json"].map(|name| dir.path().join(name));
    let text = curve(&output, &args!["--report", report]);
    assert_eq!(names_in(dir.path()), ["out.msh", "report.json"]);
    let linear = fixture("weeble_hybrid", "msh");
    sagitta(args!["check", output, "--linear", linear, "--report", checked]).expect(0);
    let [report, checked] = [report, checked].map(|path| json(&path));
    assert_eq!(report["schema"], "sagitta-report-2");
    assert_eq!(report["schema"], sagitta::report::curve::SCHEMA);
    assert_eq!(checked["schema"], "sagitta-check-2");
    for key in ["order", "certified", "certificate"] {
        assert_eq!(report[key], checked[key], "{key}");
    }
    let counts = |document: &Value| {
        let cells = document["cells"].as_array().unwrap().iter();
        let keys = ["cell", "count", "valid", "invalid", "undecided"];
        cells.map(|cell| keys.map(|key| cell[key].clone())).collect::<Vec<_>>()
    };
    assert_eq!(counts(&report), counts(&checked));
    assert_eq!(counts(&report).len(), 4);
    let steps: Vec<&str> = report["seconds"].as_array().unwrap().iter().map(|s| s["step"].as_str().unwrap()).collect();
    assert_eq!(steps, ["read", "associate", "elevate", "project", "perturb", "smooth", "certify"]);
    assert!(number(&report, "/peak_memory") > 1e6 && number(&report, "/threads") >= 1.0);
    // The table for people has the same figures.
    for cell in report["cells"].as_array().unwrap() {
        for key in ["/c_wcn_min", "/c_jac_min", "/j_over_jc_min"] {
            let figure = format!("{:.4}", number(cell, key));
            assert!(text.contains(&figure), "{key} {figure} is not in:\n{text}");
        }
    }
    assert!(text.contains(&format!("written: {}", output.display())), "{text}");
}

/// `sagitta curve ... 2>&1 | head -1`: who reads goes away after a line, and the mesh is written all the same.
#[test]
fn a_reader_that_goes_away_does_not_stop_the_work() {
    let dir = tempfile::tempdir().unwrap();
    let (mesh, cad, output) = (fixture("cylinder_bl", "msh"), fixture("cylinder_bl", "step"), dir.path().join("o.msh"));
    let report = dir.path().join("o.json");
    let arguments = args!["curve", mesh, "--cad", cad, "--order", "2", "-o", output, "--report", report];
    let mut child = Command::new(env!("CARGO_BIN_EXE_sagitta"))
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut first = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut first).unwrap();
    assert!(first.starts_with("order "), "{first}");
    assert_eq!(child.wait().unwrap().code(), Some(0), "nothing went wrong");
    assert!(formats::read(&output).is_ok());
    json(&report);
}

/// Results that cannot be printed for another reason are an error that names what is wrong.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stdout_is_an_error() {
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_sagitta")).args(["explain", "ML503"]).stdout(full).output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.starts_with("sagitta: standard output: ") && told.lines().count() == 1, "{told}");
}

#[test]
fn progress_goes_to_stderr_in_plain_lines() {
    let dir = tempfile::tempdir().unwrap();
    let (mesh, cad, output) = (fixture("cylinder_bl", "msh"), fixture("cylinder_bl", "step"), dir.path().join("o.msh"));
    let outcome = sagitta(args!["curve", mesh, "--cad", cad, "--order", "2", "-o", output]).expect(0);
    for (n, step) in ["read", "associate", "elevate", "project", "perturb", "smooth", "certify"].iter().enumerate() {
        assert!(outcome.stderr.contains(&format!("{}/7 {step}", n + 1)), "{}", outcome.stderr);
    }
    assert!(!outcome.stderr.contains('\x1b') && !outcome.stderr.contains('\r'), "{}", outcome.stderr);
    assert!(!outcome.stdout.contains("/7 "), "{}", outcome.stdout);
}

/// A mesh whose far field is on no CAD face, and of which one layer of cells may be curved: the displacement of the wall does
/// not fit into it, and the cells can only be made valid by taking faces off the CAD.
#[test]
fn figures_are_those_of_the_mesh_that_is_written() {
    let place = Place::new();
    let mesh = place.mesh("without_cad.msh", |parts| {
        parts.blocks.iter_mut().filter(|b| b.entity == EntityKey::new(2, 2)).for_each(|b| b.entity.tag = 102);
    });
    let report = place.dir.path().join("out/report.json");
    let mut arguments = Input::mesh(&mesh)
        .with(&["--curve-layers", "1", "--max-sweeps", "0", "--straight", "102"])
        .arguments(&place.output());
    arguments.extend(args!["--report", report]);
    let outcome = sagitta(&arguments).expect(3);
    let report = json(&report);
    assert_ne!(report["off_cad"], serde_json::json!([]));
    assert_eq!(report["faces_without_cad"], 24);
    assert!(outcome.stdout.contains("24 boundary faces are not associated with the CAD"), "{}", outcome.stdout);
    assert!(outcome.stdout.contains("off the CAD: "), "{}", outcome.stdout);
    sagitta(args!["check", place.output(), "--linear", mesh]).expect(0);
    for cell in report["cells"].as_array().unwrap() {
        let [sampled, proven] = ["/c_jac_min", "/j_over_jc_min"].map(|key| number(cell, key));
        assert!(sampled >= 1.0 || sampled >= proven, "C_JAC sampled {sampled}, J/Jc proven {proven}: {cell}");
        assert!(number(cell, "/c_wcn_min") > 0.0, "no element is inverted any more: {cell}");
    }
}
